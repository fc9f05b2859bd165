#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Adds up what scripts/test ran: its own checks and every GoogleTest case. Names failed and skipped ones, and those that passed
at a later try only (scripts/test says which tests are tried again, and why). Exit 1 when one failed."""
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree


def outcome_of(case):
    if case.find("failure") is not None:
        return "failed"
    return "skipped" if case.find("skipped") is not None or case.get("result") == "skipped" else "passed"


def gtest_cases(folder):
    """The outcomes of each case in the XML reports below folder, in the order of its tries. GoogleTest names the reports of a
    program's tries climb_test.xml, climb_test_1.xml, ..."""
    tries = {}
    for report in sorted(folder.rglob("*.xml"), key=lambda path: path.stat().st_mtime_ns):
        program = re.sub(r"_\d+$", "", report.stem)
        for case in ElementTree.parse(report).iter("testcase"):
            name = f"{case.get('classname')}.{case.get('name')}"
            tries.setdefault((report.parent.name, program, name), []).append(outcome_of(case))
    return [(f"{folder_name}/{name}", outcomes) for (folder_name, _, name), outcomes in tries.items()]


def main():
    folder = pathlib.Path(sys.argv[1])
    outcomes = {"passed": [], "failed": [], "skipped": []}
    for line in (folder / "checks.txt").read_text().splitlines():
        outcome, name = line.split(maxsplit=1)
        outcomes[outcome].append(name)
    for name, tries in gtest_cases(folder):
        outcomes[tries[-1]].append(name)
        if tries[-1] == "passed" and "failed" in tries:
            print(f"PASSED AT TRY {len(tries)}: {name}")
    for outcome in ("skipped", "failed"):
        for name in outcomes[outcome]:
            print(f"{outcome.upper()}: {name}")
    counts = {outcome: len(names) for outcome, names in outcomes.items()}
    print(f"{counts['passed']} passed, {counts['failed']} failed, {counts['skipped']} skipped")
    return 1 if counts["failed"] or not counts["passed"] else 0


if __name__ == "__main__":
    sys.exit(main())
