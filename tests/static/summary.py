#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Adds up what scripts/test ran: its own checks and every GoogleTest case. Names failed and skipped ones. Exit 1 when one failed."""
import pathlib
import sys
import xml.etree.ElementTree as ElementTree


def gtest_cases(folder):
    """Yields (outcome, name) of each case in the XML reports below folder."""
    for report in sorted(folder.rglob("*.xml")):
        for case in ElementTree.parse(report).iter("testcase"):
            name = f"{report.parent.name}/{case.get('classname')}.{case.get('name')}"
            skipped = case.find("skipped") is not None or case.get("result") == "skipped"
            yield "failed" if case.find("failure") is not None else "skipped" if skipped else "passed", name


def main():
    folder = pathlib.Path(sys.argv[1])
    outcomes = {"passed": [], "failed": [], "skipped": []}
    for line in (folder / "checks.txt").read_text().splitlines():
        outcome, name = line.split(maxsplit=1)
        outcomes[outcome].append(name)
    for outcome, name in gtest_cases(folder):
        outcomes[outcome].append(name)
    for outcome in ("skipped", "failed"):
        for name in outcomes[outcome]:
            print(f"{outcome.upper()}: {name}")
    counts = {outcome: len(names) for outcome, names in outcomes.items()}
    print(f"{counts['passed']} passed, {counts['failed']} failed, {counts['skipped']} skipped")
    return 1 if counts["failed"] or not counts["passed"] else 0


if __name__ == "__main__":
    sys.exit(main())
