#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""docs/SAFETY.md promises only tests that exist: every hazard and every row of the fault table has some."""
import re
import unittest

import named_tests

TEXT = (named_tests.ROOT / "docs/SAFETY.md").read_text()


def rows(pattern):
    """{first word of a table's row: the tests in its last column}"""
    found = {}
    for line in TEXT.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("|") and re.match(pattern, cells[0]):
            found[re.match(pattern, cells[0]).group(1)] = re.findall(r"`([^`]+)`", cells[-1])
    return found


class Safety(unittest.TestCase):
    def test_every_named_test_exists(self):
        cases, programs = named_tests.cases(), named_tests.programs()
        named = [test for table in (rows(r"(H\d+) "), rows(r"(\d+)$")) for tests in table.values() for test in tests]
        self.assertGreater(len(named), 80)
        self.assertEqual([test for test in named if test not in cases and test not in programs], [])

    def test_every_hazard_has_tests(self):
        hazards = rows(r"(H\d+) ")
        self.assertEqual(list(hazards), [f"H{number}" for number in range(1, len(hazards) + 1)])
        self.assertGreaterEqual(len(hazards), 18)
        self.assertEqual([hazard for hazard, tests in hazards.items() if not tests], [])

    def test_every_row_of_the_fault_table(self):
        table = rows(r"(\d+)$")
        self.assertEqual([int(row) for row in table], list(range(1, 33)))
        self.assertEqual([row for row, tests in table.items() if not tests], [])

    def test_files_exist(self):
        for span in re.findall(r"`([^`]+)`", TEXT):
            if re.fullmatch(r"(?:\./)?(tests|scripts|docs|config|simulator)/[\w./]+", span):
                self.assertTrue((named_tests.ROOT / span).exists(), span)


if __name__ == "__main__":
    unittest.main()
