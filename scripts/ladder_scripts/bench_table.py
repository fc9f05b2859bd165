# SPDX-License-Identifier: BSD-3-Clause
"""The ratios that matter, from what scripts/bench measured. Not for use by hand.

    bench_table.py FILE.json             signals per second: ddgng against linear; median and p95 of each stage
    bench_table.py --turns FILE.txt      the yardstick's lines and ladder_bench's CSV lines in turns
"""
import collections
import csv
import json
import re
import statistics
import sys


def rates_and_stages(results):
    """name -> signals per second, name -> (median_ms, p95_ms); of repetitions the median."""
    rates, stages = {}, {}
    for result in results:
        if result.get("aggregate_name", "median") != "median":
            continue
        name = result["run_name"]
        if "signals_per_second" in result:
            rates[name] = result["signals_per_second"]
        if "median_ms" in result:
            stages[name] = (result["median_ms"], result["p95_ms"])
    return rates, stages


def print_report(path):
    with open(path, encoding="utf-8") as file:
        rates, stages = rates_and_stages(json.load(file)["benchmarks"])
    if rates:
        print("\nsignals per second    ddgng / linear")
    for name, rate in sorted(rates.items(), key=lambda item: int(item[0].split("/")[1])):
        kind, nodes = name.split("/")
        linear = rates.get(f"linear/{nodes}")
        if kind == "ddgng" and linear:
            print(f"{nodes:>8} nodes {rate:12.0f}   x {rate / linear:.2f}")
    if stages:
        print("\nstage                       median ms    p95 ms")
    for name, (median_ms, p95_ms) in sorted(stages.items()):
        print(f"{name:27} {median_ms:9.3f} {p95_ms:9.3f}")


def read_turns(lines):
    """(kind, nodes) -> list of signals per second."""
    turns = collections.defaultdict(list)
    header = None
    for line in lines:
        yardstick = re.search(r" N=(\d+) .*? sig/s=(\d+)", line)
        if yardstick:
            turns["yardstick", int(yardstick[1])].append(float(yardstick[2]))
        elif line.startswith("name,"):
            header = next(csv.reader([line]))
        elif header and re.match(r'"?(ddgng|linear)/', line):
            row = dict(zip(header, next(csv.reader([line]))))
            kind, nodes = row["name"].split("/")
            turns[kind, int(nodes)].append(float(row["signals_per_second"]))
    return turns


def print_turns(path):
    with open(path, encoding="utf-8") as file:
        turns = {key: statistics.median(rates) for key, rates in read_turns(file).items()}
    print("\n   nodes    yardstick        ddgng       linear   ddgng / yardstick")
    for nodes in sorted(nodes for kind, nodes in turns if kind == "yardstick"):
        yardstick, ddgng, linear = (turns.get((kind, nodes), float("nan")) for kind in ("yardstick", "ddgng", "linear"))
        print(f"{nodes:8} {yardstick:12.0f} {ddgng:12.0f} {linear:12.0f}   x {ddgng / yardstick:.2f}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--turns"]:
        print_turns(sys.argv[2])
    else:
        print_report(sys.argv[1])
