#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Real sensor frames, skipped by name where the recordings are missing. Stairs are bars, never a ladder."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import real_frames  # noqa: E402
import stairs_bars  # noqa: E402
import terrain_agreement  # noqa: E402

WALL = 2
# Below the lowest of the last twenty frames (measured with scripts/replay).
LEAST_AGREEING = {"far front": {"safe ground": 0.9, "wall": 0.4, "obstacle": 0.95},
                  "chosen": {"wall": 0.75, "obstacle": 0.95},
                  "corner": {"wall": 0.8, "obstacle": 0.95}}


class RealFrames(unittest.TestCase):
    def understand(self, name):
        try:
            with tempfile.TemporaryDirectory() as folder:
                return real_frames.understand(name, folder)
        except real_frames.Missing as missing:
            self.skipTest(str(missing))

    def test_stairs_are_bars_and_no_ladder(self):
        """At least four of the six treads measured by hand are among few bars, each within 1.5 cm; nothing is called a ladder."""
        frames = self.understand("stairs/capture0005.pcd")
        # One camera of four heads: its first frame waits for the others, then goes out together with the second, and the newest wins.
        self.assertEqual(len(frames), real_frames.FRAMES - 1)
        self.assertEqual(stairs_bars.num_confirmed(frames), 0)
        _, topology, ladder = frames[-1]
        self.assertIn(stairs_bars.SAFE_GROUND, topology.plane_class)
        self.assertIn(WALL, topology.plane_class)
        bars_m = stairs_bars.bar_heights_m(topology, ladder)
        near = [tread_m for tread_m in stairs_bars.treads_m() if any(abs(tread_m - bar_m) <= 0.015 for bar_m in bars_m)]
        self.assertGreaterEqual(len(near), 4)
        self.assertLessEqual(len(bars_m), 18)  # the fronts of the lowest boards are 0.17 m high and hold two or three bars each

    def test_stairs_from_the_side_are_no_ladder(self):
        """The same stairs in another frame confirm nothing either."""
        self.assertEqual(stairs_bars.num_confirmed(self.understand("stairs/capture0002.pcd")), 0)

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
