#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares measured metrics with accepted ones: compare.py MEASURED.json ACCEPTED.json [--accept]
ACCEPTED.json maps each metric to {"accepted": value, "tolerance": t, "better": "higher"|"lower"|"equal"}.
Worse than accepted by more than the tolerance fails; so does a metric that was not measured, and comparing nothing."""
import json
import sys


def verdict(name, rule, measured):
    """("ok" or what is wrong, text to print)."""
    value = measured.get(name)
    accepted, tolerance, better = rule["accepted"], rule["tolerance"], rule["better"]
    if value is None:
        return "not measured", f"{name:28} accepted {accepted}, not measured"
    worse = {"higher": accepted - value, "lower": value - accepted, "equal": abs(value - accepted)}[better]
    result = "ok" if worse <= tolerance else "WORSE"
    return result, f"{name:28} {value:10.4g}  accepted {accepted:10.4g} ({better}, tolerance {tolerance})  {result}"


def main():
    measured_path, accepted_path = sys.argv[1:3]
    with open(measured_path) as file:
        measured = json.load(file)
    with open(accepted_path) as file:
        rules = json.load(file)
    if not rules:
        print(f"{accepted_path} names no metric: nothing compared")
        return 1
    if "--accept" in sys.argv[3:]:
        for name, rule in rules.items():
            if measured.get(name) is None:
                print(f"{name} was not measured and cannot be accepted")
                return 1
            rule["accepted"] = measured[name]
        with open(accepted_path, "w") as file:
            file.write(json.dumps(rules, indent=2) + "\n")
        print(f"accepted {len(rules)} metrics into {accepted_path}")
        return 0
    results = [verdict(name, rule, measured) for name, rule in rules.items()]
    for _, text in results:
        print(text)
    return 0 if all(result == "ok" for result, _ in results) else 1


if __name__ == "__main__":
    sys.exit(main())
