#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints which share of the terrain recording has the class that planes set by hand give it, class by class: of the
nodes, and of the points of the cloud (each point takes the class of its nearest node)."""

import json
import math
import sys
import tempfile

import real_frames
from ladder_scripts import depth_heads

CLASSES = {"safe ground": 1, "wall": 2, "obstacle": 3}
NUM_POINTS = 2000  # of the cloud, evenly spaced


def read_truth():
    return json.loads((real_frames.REPOSITORY / "tests/data/terrain_planes.json").read_text())


def is_within(plane, point):
    return plane["low_m"] is None or all(low <= p <= high for low, p, high in zip(plane["low_m"], point, plane["high_m"]))


def expected_class(truth, point):
    """Of the nearest plane that holds there, within the tolerance; else obstacle."""
    nearest_m, name = truth["tolerance_m"], "obstacle"
    for plane in truth["planes"]:
        distance_m = abs(sum(n * p for n, p in zip(plane["normal"], point)) - plane["offset_m"])
        if distance_m < nearest_m and is_within(plane, point):
            nearest_m, name = distance_m, plane["class"]
    return name


def from_odom(topology, view):
    """The function that takes a point of the odom frame to the axes of the recording: the body stands at the view."""
    x, y, z, yaw_deg = view
    w, i, j, k = topology.q_odom_body
    cosine, sine = math.cos(math.radians(yaw_deg)), math.sin(math.radians(yaw_deg))

    def transform(p):
        offset = [a - b for a, b in zip(p, topology.p_odom_body_m)]
        ahead, left, up = depth_heads.rotate((w, -i, -j, -k), offset)
        return x + cosine * ahead - sine * left, y + sine * ahead + cosine * left, z + up

    return transform


def class_of_nearest(nodes, classes, points):
    """Of each point the class of its nearest node."""
    def squared(node, p):
        return (node[0] - p[0]) ** 2 + (node[1] - p[1]) ** 2 + (node[2] - p[2]) ** 2

    return [classes[min(range(len(nodes)), key=lambda i: squared(nodes[i], p))] for p in points]


def count(truth, points, classes):
    """{class expected: [points, of them agreeing]}"""
    counts = {name: [0, 0] for name in CLASSES}
    for point, found in zip(points, classes):
        expected = expected_class(truth, point)
        counts[expected][0] += 1
        counts[expected][1] += found == CLASSES[expected]
    return counts


def agreement(name, folder):
    """{"nodes" and "points": {class: [number, of them agreeing]}} of the last frame, from the view of this name."""
    truth = read_truth()
    view = truth["views"][name]
    frame = real_frames.understand("terrain/terrain_close_rect.pcd", folder, "--view=" + ",".join(map(str, view)))[-1]
    topology, cloud = frame.topology, frame.cloud
    transform = from_odom(topology, view)
    nodes = [transform(p) for p in zip(topology.node_x_m, topology.node_y_m, topology.node_z_m)]
    points = list(zip(cloud.x_m, cloud.y_m, cloud.z_m))
    points = [transform(p) for p in points[::max(1, len(points) // NUM_POINTS)]]
    classes = list(topology.node_class)
    return {"nodes": count(truth, nodes, classes), "points": count(truth, points, class_of_nearest(nodes, classes, points))}


def share(counts):
    """Of all, the agreeing."""
    return sum(agreeing for _, agreeing in counts.values()) / max(1, sum(number for number, _ in counts.values()))


def main():
    try:
        with tempfile.TemporaryDirectory() as folder:
            views = {name: agreement(name, folder) for name in read_truth()["views"]}
    except real_frames.Missing as missing:
        print(f"SKIPPED: {missing}")
        return 0
    for view, kinds in views.items():
        for kind, counts in kinds.items():
            parts = [f"{name} {agreeing / number:.2f} of {number}" for name, (number, agreeing) in counts.items() if number]
            print(f"view {view:9} {kind:6} {share(counts):.3f} agree: {', '.join(parts)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
