#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The last line of scripts/test counts each case once, by its last try, and a failure that stays is never lost."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PASS, FAIL, SKIP = "", "<failure message='no'/>", "<skipped/>"


class Summary(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="ladder_summary_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "checks.txt").write_text("")
        self.num_reports = 0

    def report(self, name, **cases):
        """A GoogleTest report, one second younger than the one before."""
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        text = "".join(f"<testcase classname='Climb' name='{case}'>{inside}</testcase>" for case, inside in cases.items())
        path.write_text(f"<testsuites>{text}</testsuites>")
        self.num_reports += 1
        os.utime(path, (self.num_reports, self.num_reports))

    def summary(self):
        done = subprocess.run([sys.executable, ROOT / "tests/static/summary.py", self.folder], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout.splitlines()

    def test_nothing_run_is_a_failure(self):
        self.assertEqual(self.summary(), (1, ["0 passed, 0 failed, 0 skipped"]))

    def test_a_failed_check_is_named(self):
        (self.folder / "checks.txt").write_text("passed format\nfailed drill\n")
        self.assertEqual(self.summary(), (1, ["FAILED: drill", "1 passed, 1 failed, 0 skipped"]))

    def test_failed_and_skipped_cases_are_named(self):
        self.report("release/climb_test.xml", Up=PASS, Down=FAIL, Sideways=SKIP)
        self.assertEqual(self.summary(), (1, ["SKIPPED: release/Climb.Sideways", "FAILED: release/Climb.Down",
                                              "1 passed, 1 failed, 1 skipped"]))

    def test_a_case_that_passes_when_tried_again_is_told_and_counts_as_passed(self):
        self.report("hardware/climb_test.xml", Up=FAIL)
        self.report("hardware/climb_test_1.xml", Up=PASS)
        self.assertEqual(self.summary(), (0, ["PASSED AT TRY 2: hardware/Climb.Up", "1 passed, 0 failed, 0 skipped"]))

    def test_a_case_that_fails_at_its_last_try_failed(self):
        self.report("hardware/climb_test.xml", Up=PASS)
        self.report("hardware/climb_test_1.xml", Up=FAIL)
        self.assertEqual(self.summary(), (1, ["FAILED: hardware/Climb.Up", "0 passed, 1 failed, 0 skipped"]))

    def test_one_name_in_two_programs_or_builds_is_two_cases(self):
        self.report("release/climb_test.xml", Up=FAIL)
        self.report("release/plant_test.xml", Up=PASS)
        self.report("clang/climb_test.xml", Up=PASS)
        self.assertEqual(self.summary(), (1, ["FAILED: release/Climb.Up", "2 passed, 1 failed, 0 skipped"]))


if __name__ == "__main__":
    unittest.main()
