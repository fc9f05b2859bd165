#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/climbs adds runs up: several runs, one ladder twice, a run that was broken off, and what makes it end badly."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SUMS = pathlib.Path(__file__).resolve().parents[2] / "scripts/ladder_scripts/climb_sums.py"


def climb(seed, damage="plain", end="top", **more):
    return {"seed": seed, "damage": damage, "rungs": 13, "end": end, "falls": 0, "wall_s": 30.0} | more


class ClimbSums(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.lines, self.target = (pathlib.Path(folder.name) / name for name in ("lines", "climbs.json"))

    def add(self, *climbs):
        """Exit status and the file after a run with these climbs; without any, after one that was broken off at once."""
        if climbs:
            self.lines.write_text("".join(json.dumps(c) + "\n" for c in climbs))
        done = subprocess.run([sys.executable, SUMS, self.lines, self.target], capture_output=True, text=True, check=False)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        self.assertFalse(self.lines.exists())
        return done.returncode, json.loads(self.target.read_text())

    def test_runs_add_up_and_one_ladder_counts_once(self):
        self.assertEqual(self.add(climb(1), climb(1, "bent", "held", reason="damaged"))[0], 0)
        status, sums = self.add(climb(2), climb(1, end="held", reason="no way"))
        self.assertEqual((status, sums["climbs"], sums["plain"], sums["plain_tops"]), (1, 3, 2, 1))
        status, sums = self.add(climb(1))
        self.assertEqual((status, sums["climbs"], sums["plain_tops"], sums["minutes"]), (0, 3, 2, 1.5))
        self.assertEqual([c["seed"] for c in sums["each"]], [1, 2, 1])
        self.assertEqual(self.add(climb(1, rungs=8))[1]["climbs"], 4)

    def test_a_run_without_climbs_changes_nothing_and_is_no_success_alone(self):
        self.assertEqual(self.add()[0], 1)
        before = self.add(climb(1))[1]
        self.assertEqual(self.add(), (0, before))

    def test_who_came_down_is_counted(self):
        status, sums = self.add(climb(1, down="dock"), climb(2), climb(1, "bent", down="held"))
        self.assertEqual((status, sums["plain_down"], sums["plain_docks"], sums["damaged_docks"], sums["plain_tops"]), (0, 1, 1, 0, 2))

    def test_what_is_no_success(self):
        for bad in (climb(1, "weak", falls=1), climb(1, "bent", unsafe_grasps=1), climb(1, violations=1), climb(1, end="held"), climb(1, down="held"),
                    climb(1, "loose", "too long"), {"seed": 1, "damage": "weak", "rungs": 13, "end": "crashed"}):
            self.target.unlink(missing_ok=True)
            self.assertEqual(self.add(climb(7), bad)[0], 1, bad)


if __name__ == "__main__":
    unittest.main()
