#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Real sensor frames, skipped by name where the recordings are missing. Stairs are bars, never a ladder."""

import csv
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import real_frames  # noqa: E402
import terrain_agreement  # noqa: E402

CONFIRMED = 2
SAFE_GROUND, WALL = 1, 2
# Below the lowest of the last twenty frames (measured with scripts/replay).
LEAST_AGREEING = {"far front": {"safe ground": 0.9, "wall": 0.4, "obstacle": 0.95},
                  "chosen": {"wall": 0.75, "obstacle": 0.95},
                  "corner": {"wall": 0.8, "obstacle": 0.95}}


def bar_heights_m(topology, ladder):
    """Above the lowest safe ground."""
    floor_m = min(offset / nz for offset, nz, plane_class in
                  zip(topology.plane_offset_m, topology.plane_normal_z, topology.plane_class) if plane_class == SAFE_GROUND)
    return [0.5 * (a + b) - floor_m for a, b in zip(ladder.rung_z0_m, ladder.rung_z1_m)]


class RealFrames(unittest.TestCase):
    def understand(self, name):
        try:
            with tempfile.TemporaryDirectory() as folder:
                return real_frames.understand(name, folder)
        except real_frames.Missing as missing:
            self.skipTest(str(missing))

    def test_stairs_are_bars_and_no_ladder(self):
        """At least four of the six treads measured by hand are among few bars, each within 2 cm; nothing is called a ladder."""
        frames = self.understand("stairs/capture0005.pcd")
        # One camera of four heads: its first frame waits for the others, then goes out together with the second, and the newest wins.
        self.assertEqual(len(frames), real_frames.FRAMES - 1)
        self.assertTrue(all(ladder.ladder_state != CONFIRMED for _, _, ladder in frames))
        _, topology, ladder = frames[-1]
        self.assertIn(SAFE_GROUND, topology.plane_class)
        self.assertIn(WALL, topology.plane_class)
        bars_m = bar_heights_m(topology, ladder)
        with open(real_frames.recording("stairs/capture0005_treads.csv"), encoding="utf-8") as file:
            rows = csv.reader(line for line in file if not line.startswith("#"))
            treads_m = [float(row[3]) for row in rows if row]
        self.assertGreaterEqual(sum(any(abs(tread - bar) <= 0.02 for bar in bars_m) for tread in treads_m), 4)
        self.assertLessEqual(len(bars_m), 18)  # the fronts of the lowest boards are 0.17 m high and hold two or three bars each

    def test_stairs_from_the_side_are_no_ladder(self):
        """The same stairs in another frame confirm nothing either."""
        self.assertTrue(all(ladder.ladder_state != CONFIRMED for _, _, ladder in self.understand("stairs/capture0002.pcd")))

    def test_terrain_classes_agree_with_its_planes(self):
        """From each view the classes agree with surfaces set by hand, counted in nodes and in points. The foot of the far front is
        held to be an obstacle, and so are glimpses of the floor between blocks (docs/EQUATIONS.md, #12)."""
        for view, least in LEAST_AGREEING.items():
            try:
                with tempfile.TemporaryDirectory() as folder:
                    found = terrain_agreement.agreement(view, folder)
            except real_frames.Missing as missing:
                self.skipTest(str(missing))
            for kind, counts in found.items():
                with self.subTest(view=view, of=kind):
                    self.assertGreater(terrain_agreement.share(counts), 0.83)
                    for name, share in least.items():
                        number, agreeing = counts[name]
                        self.assertGreater(number, 50)
                        self.assertGreater(agreeing / number, share, name)


if __name__ == "__main__":
    unittest.main()
