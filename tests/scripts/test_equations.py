#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""docs/EQUATIONS.md names only places, tests and deviations that exist, and every deviation that a comment announces is explained there."""
import pathlib
import re
import unittest

import named_tests

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIBRARIES = {"ddgng": ROOT / "gng_service", "ladder": ROOT / "ladder_service"}
TEXT = (ROOT / "docs/EQUATIONS.md").read_text()
CODE_SPANS = re.findall(r"`([^`\n]+)`", TEXT)


class Equations(unittest.TestCase):
    def test_every_place_exists(self):
        places = [span for span in CODE_SPANS if re.fullmatch(r"(ddgng|ladder)/\w+\.(h|cpp):\w+", span)]
        self.assertGreater(len(places), 50)
        for place in places:
            file, name = place.split(":")
            path = LIBRARIES[file.split("/")[0]] / file
            self.assertTrue(path.is_file(), place)
            self.assertRegex(path.read_text(), rf"\b{name}\(", place)

    def test_every_test_exists(self):
        known = named_tests.cases()
        named = [span for span in CODE_SPANS if re.fullmatch(r"[A-Z]\w*\.[A-Z]\w*", span)]
        self.assertGreater(len(named), 40)
        self.assertEqual([name for name in named if name not in known], [])

    def test_every_file_exists(self):
        for span in CODE_SPANS:
            if re.fullmatch(r"(tests|scripts|docs|config)/[\w./]+", span):
                self.assertTrue((ROOT / span).exists(), span)

    def test_links_and_numbers_resolve(self):
        titles = re.findall(r"^#+ (.+)$", TEXT, re.M)
        anchors = {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}
        for anchor in re.findall(r"\]\(#([^)]+)\)", TEXT):
            self.assertIn(anchor, anchors)
        numbers = {int(number) for number in re.findall(r"^#### (\d+)\.", TEXT, re.M)}
        self.assertEqual(numbers, set(range(1, len(numbers) + 1)))
        for number in re.findall(r"#(\d+)", TEXT.replace("](#", "](")):
            self.assertIn(int(number), numbers)

    def test_every_announced_deviation_is_explained(self):
        """A file with a comment "PAPER:" is named by a row of the tables that has a numbered deviation."""
        rows = [line for line in TEXT.splitlines() if line.startswith("|") and "[#" in line]
        announcing = 0
        for library, folder in LIBRARIES.items():
            for path in sorted((folder / library).glob("*")):
                if "PAPER:" not in path.read_text():
                    continue
                announcing += 1
                self.assertTrue(any(f"{library}/{path.name}:" in row for row in rows), path)
        self.assertGreater(announcing, 5)


if __name__ == "__main__":
    unittest.main()
