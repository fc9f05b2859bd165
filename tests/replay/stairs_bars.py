#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints which bar of a real staircase was found nearest to each tread that was measured by hand, and whether anything was held
for a ladder there (from two views)."""

import csv
import sys
import tempfile

import real_frames

CONFIRMED = 2
SAFE_GROUND = 1


def treads_m():
    """Heights of the treads' fronts above the floor, good to 8 mm."""
    with open(real_frames.recording("stairs/capture0005_treads.csv"), encoding="utf-8") as file:
        rows = csv.reader(line for line in file if not line.startswith("#"))
        return [float(row[3]) for row in rows if row]


def bar_heights_m(topology, ladder):
    """Above the lowest safe ground."""
    floor_m = min(offset / nz for offset, nz, plane_class in
                  zip(topology.plane_offset_m, topology.plane_normal_z, topology.plane_class) if plane_class == SAFE_GROUND)
    return [0.5 * (a + b) - floor_m for a, b in zip(ladder.rung_z0_m, ladder.rung_z1_m)]


def num_confirmed(frames):
    return sum(frame.ladder.ladder_state == CONFIRMED for frame in frames)


def main():
    try:
        for name in ("capture0005", "capture0002"):
            with tempfile.TemporaryDirectory() as folder:
                frames = real_frames.understand(f"stairs/{name}.pcd", folder)
            print(f"{name}: {len(frames)} frames, {num_confirmed(frames)} with a ladder, {frames[-1].ladder.num_rungs} bars in the last")
            if name != "capture0005":
                continue
            bars_m = bar_heights_m(frames[-1].topology, frames[-1].ladder)
            for tread_m in treads_m():
                bar_m = min(bars_m, key=lambda bar_m: abs(bar_m - tread_m))
                print(f"  tread at {tread_m:.3f} m: nearest bar at {bar_m:.3f} m, {1000 * (bar_m - tread_m):+.0f} mm")
    except real_frames.Missing as missing:
        print(f"SKIPPED: {missing}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
