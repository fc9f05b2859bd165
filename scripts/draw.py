#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws what the robot understood in one frame of a replayed or recorded log as an SVG picture: edges and nodes coloured by class,
rungs, and where a gripper may close.   draw.py LOG.lcm -o PICTURE.svg [--frame N]   (N counts LADDER_RUNGS messages; default: the last)"""
import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ladder_scripts import codecs, lcm_log  # noqa: E402

WIDTH_PX, HEIGHT_PX = 900, 620
CLASS_COLORS = {0: "#999999", 1: "#4c9f70", 2: "#7a8fb8", 3: "#d9822b"}  # unknown, safe ground, wall, obstacle
FEASIBLE_COLOR, REFUSED_COLOR = "#1a9e3f", "#c62828"


def read_frame(path, frame):
    """(ladder_t, the topology_t it was made from) of the frame-th rungs message."""
    messages = codecs.load_messages()
    topologies, ladders = {}, []
    for _, channel, data in lcm_log.read_events(pathlib.Path(path).read_bytes()):
        if channel == "LADDER_TOPOLOGY":
            topology = messages.topology_t.decode(data)
            topologies[topology.utime] = topology
        elif channel == "LADDER_RUNGS":
            ladders.append(messages.ladder_t.decode(data))
    ladders = [ladder for ladder in ladders if ladder.utime in topologies]
    if not ladders:
        raise SystemExit(f"{path} holds no LADDER_RUNGS with its LADDER_TOPOLOGY; make one with scripts/replay")
    ladder = ladders[frame]
    return ladder, topologies[ladder.utime]


class View:
    """Oblique parallel projection of odom (x ahead, y left, z up) onto the picture."""

    def __init__(self, points):
        flat = [self._flat(*point) for point in points]
        self._left = min(u for u, _ in flat)
        self._top = max(v for _, v in flat)
        spread = max(max(u for u, _ in flat) - self._left, (self._top - min(v for _, v in flat)) * WIDTH_PX / HEIGHT_PX, 0.1)
        self._scale = (WIDTH_PX - 60) / spread
        self._indent = (WIDTH_PX - (max(u for u, _ in flat) - self._left) * self._scale) / 2

    @staticmethod
    def _flat(x, y, z):
        return -y + 0.45 * x, z + 0.25 * x

    def __call__(self, x, y, z):
        u, v = self._flat(x, y, z)
        return self._indent + (u - self._left) * self._scale, 30 + (self._top - v) * self._scale


def line(a, b, color, width):
    return f'<line x1="{a[0]:.1f}" y1="{a[1]:.1f}" x2="{b[0]:.1f}" y2="{b[1]:.1f}" stroke="{color}" stroke-width="{width}"/>'


def along(ladder, rung, distance_m):
    ends = [(ladder.rung_x0_m[rung], ladder.rung_x1_m[rung]), (ladder.rung_y0_m[rung], ladder.rung_y1_m[rung]),
            (ladder.rung_z0_m[rung], ladder.rung_z1_m[rung])]
    length = sum((b - a) ** 2 for a, b in ends) ** 0.5 or 1.0
    return [a + (b - a) * distance_m / length for a, b in ends]


def draw(ladder, topology):
    nodes = list(zip(topology.node_x_m, topology.node_y_m, topology.node_z_m))
    if not nodes:
        raise SystemExit("this frame has no nodes")
    view = View(nodes)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH_PX}" height="{HEIGHT_PX}" viewBox="0 0 {WIDTH_PX} {HEIGHT_PX}">',
             '<rect width="100%" height="100%" fill="white"/>']
    for a, b in zip(topology.edge_a, topology.edge_b):
        same = topology.node_class[a] == topology.node_class[b]
        parts.append(line(view(*nodes[a]), view(*nodes[b]), CLASS_COLORS[topology.node_class[a]] if same else "#cccccc", 0.7))
    for node, node_class in zip(nodes, topology.node_class):
        u, v = view(*node)
        parts.append(f'<circle cx="{u:.1f}" cy="{v:.1f}" r="1.6" fill="{CLASS_COLORS[node_class]}"/>')
    for i in range(ladder.num_rungs):
        parts.append(line(view(*along(ladder, i, 0.0)), view(ladder.rung_x1_m[i], ladder.rung_y1_m[i], ladder.rung_z1_m[i]), "#333333", 2))
    for rung, start, end, reason in zip(ladder.interval_rung, ladder.interval_from_m, ladder.interval_to_m, ladder.interval_reason):
        color = FEASIBLE_COLOR if reason == 0 else REFUSED_COLOR
        parts.append(line(view(*along(ladder, rung, start)), view(*along(ladder, rung, end)), color, 5))
    legend = [("safe ground", CLASS_COLORS[1]), ("wall", CLASS_COLORS[2]), ("obstacle", CLASS_COLORS[3]),
              ("a gripper may close", FEASIBLE_COLOR), ("refused", REFUSED_COLOR)]
    for i, (text, color) in enumerate(legend):
        parts.append(f'<circle cx="{WIDTH_PX - 180}" cy="{30 + 20 * i}" r="6" fill="{color}"/>'
                     f'<text x="{WIDTH_PX - 166}" y="{35 + 20 * i}" font-family="sans-serif" font-size="14">{text}</text>')
    return "\n".join(parts + ["</svg>"]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("log")
    parser.add_argument("-o", "--out", required=True)
    parser.add_argument("--frame", type=int, default=-1)
    arguments = parser.parse_args()
    pathlib.Path(arguments.out).write_text(draw(*read_frame(arguments.log, arguments.frame)))
    print(f"written: {arguments.out}")


if __name__ == "__main__":
    main()
