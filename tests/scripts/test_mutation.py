#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every defect of the mutation check can still be put into the sources."""
import pathlib
import subprocess
import unittest

CHECK = pathlib.Path(__file__).resolve().parents[1] / "mutation/mutation_check"


class Mutation(unittest.TestCase):
    def test_no_edit_is_stale(self):
        listed = subprocess.run([CHECK, "--list"], capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(listed.returncode, 0, listed.stderr)
        self.assertGreaterEqual(len(listed.stdout.splitlines()), 30)


if __name__ == "__main__":
    unittest.main()
