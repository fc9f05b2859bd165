#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints how many nodes of the terrain recording have the class that planes set by hand give them, class by class."""

import json
import math
import sys
import tempfile

import real_frames
from ladder_scripts import depth_heads

CLASSES = {"safe ground": 1, "wall": 2, "obstacle": 3}


def expected_class(truth, point):
    """By the nearest plane within the tolerance."""
    nearest = min((abs(sum(n * p for n, p in zip(plane["normal"], point)) - plane["offset_m"]), plane["class"])
                  for plane in truth["planes"])
    return CLASSES[nearest[1]] if nearest[0] < truth["tolerance_m"] else CLASSES["obstacle"]


def read_truth():
    return json.loads((real_frames.REPOSITORY / "tests/data/terrain_planes.json").read_text())


def agreement(name, folder):
    """{class: (nodes, of them agreeing)} of the last frame, from the view of this name."""
    truth = read_truth()
    x, y, z, yaw_deg = truth["views"][name]
    view = "--view=" + ",".join(map(str, truth["views"][name]))
    topology, _ = real_frames.understand("terrain/terrain_close_rect.pcd", folder, view)[-1]
    w, i, j, k = topology.q_odom_body
    cosine, sine = math.cos(math.radians(yaw_deg)), math.sin(math.radians(yaw_deg))
    counts = {name: [0, 0] for name in CLASSES}
    for *node, node_class in zip(topology.node_x_m, topology.node_y_m, topology.node_z_m, topology.node_class):
        offset = [a - b for a, b in zip(node, topology.p_odom_body_m)]
        ahead, left, up = depth_heads.rotate((w, -i, -j, -k), offset)  # in the body, which stands at the view
        point = (x + cosine * ahead - sine * left, y + sine * ahead + cosine * left, z + up)
        expected = expected_class(truth, point)
        name = next(name for name, value in CLASSES.items() if value == expected)
        counts[name][0] += 1
        counts[name][1] += node_class == expected
    return counts


def main():
    try:
        with tempfile.TemporaryDirectory() as folder:
            views = {name: agreement(name, folder) for name in read_truth()["views"]}
    except real_frames.Missing as missing:
        print(f"SKIPPED: {missing}")
        return 0
    for view, counts in views.items():
        for name, (nodes, agreeing) in counts.items():
            share = f"{agreeing / nodes:.2f}" if nodes else "-"
            print(f"view of the {view:6} {name:12} {agreeing:4d} of {nodes:4d} nodes agree: {share}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
