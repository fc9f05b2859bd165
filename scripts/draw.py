#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws what the robot understood in one frame of a replayed or recorded log as an SVG picture: edges and nodes coloured by class,
rungs, where a gripper may close, and beside it the truth where the log holds it.
draw.py LOG.lcm -o PICTURE.svg [--frame N]   (N counts LADDER_RUNGS messages; default: the last)"""
import argparse
import html
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ladder_scripts import codecs, lcm_log  # noqa: E402

WIDTH_PX, HEIGHT_PX = 900, 620
CLASS_COLORS = {0: "#999999", 1: "#4c9f70", 2: "#7a8fb8", 3: "#d9822b"}  # unknown, safe ground, wall, obstacle
FEASIBLE_COLOR, REFUSED_COLOR = "#1a9e3f", "#c62828"
RUNG_COLOR, SOUND_COLOR, DAMAGED_COLOR = "#333333", "#1f5fd6", "#a020c0"
DASHED = ' stroke-dasharray="6 4"'
CONFIRMED, TRUSTED, SOUND = 2, 2, 1  # ladder_t.LADDER_CONFIRMED, ladder_t.RUNG_TRUSTED, truth_t.RUNG_SOUND
LAST_CONFIRMED = None  # instead of a frame's number: the last in which something is held for a ladder, else the last


def read_frame(path, frame):
    """(ladder_t, the topology_t it was made from, the truth_t nearest in time or None) of the frame-th rungs message; damage ends
    the log."""
    messages = codecs.load_messages()
    topologies, ladders, truths = {}, [], []
    try:
        for _, channel, data in lcm_log.read_events(pathlib.Path(path).read_bytes()):
            if channel == "LADDER_TOPOLOGY":
                topology = messages.topology_t.decode(data)
                topologies[topology.utime] = topology
            elif channel == "LADDER_RUNGS":
                ladders.append(messages.ladder_t.decode(data))
            elif channel == "LADDER_TRUTH":
                truths.append(messages.truth_t.decode(data))
    except lcm_log.LogError as error:
        print(f"{path}: {error}", file=sys.stderr)
    ladders = [ladder for ladder in ladders if ladder.utime in topologies]
    if not ladders:
        raise SystemExit(f"{path} holds no LADDER_RUNGS with its LADDER_TOPOLOGY; make one with scripts/replay")
    if frame == LAST_CONFIRMED:
        frame = max((i for i, ladder in enumerate(ladders) if ladder.ladder_state == CONFIRMED), default=-1)
    ladder = ladders[frame]
    truth = min(truths, key=lambda truth: abs(truth.utime - ladder.utime), default=None)
    return ladder, topologies[ladder.utime], truth


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


def line(a, b, color, width, dash=""):
    return (f'<line x1="{a[0]:.1f}" y1="{a[1]:.1f}" x2="{b[0]:.1f}" y2="{b[1]:.1f}" stroke="{color}" stroke-width="{width}"{dash}/>')


def ends(message, part, i):
    """Of rung or rail i of a ladder_t or truth_t."""
    return tuple(tuple(getattr(message, f"{part}_{axis}{end}_m")[i] for axis in "xyz") for end in (0, 1))


def along(ladder, rung, distance_m):
    axes = list(zip(*ends(ladder, "rung", rung)))
    length = sum((b - a) ** 2 for a, b in axes) ** 0.5 or 1.0
    return [a + (b - a) * distance_m / length for a, b in axes]


def draw_truth(truth, view):
    """What is not in view is thin."""
    parts = [line(view(*a), view(*b), SOUND_COLOR, 1, DASHED) for a, b in (ends(truth, "rail", i) for i in range(truth.num_rails))]
    for i in range(truth.num_rungs):
        a, b = ends(truth, "rung", i)
        color = SOUND_COLOR if truth.rung_kind[i] == SOUND else DAMAGED_COLOR
        parts.append(line(view(*a), view(*b), color, 2.5 if truth.rung_visible[i] > 0 else 1, DASHED))
    return parts


def draw(ladder, topology, truth=None, caption=()):
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
        a, b = ends(ladder, "rung", i)
        parts.append(line(view(*a), view(*b), RUNG_COLOR, 2, "" if ladder.rung_state[i] == TRUSTED else DASHED))
    for rung, start, end, reason in zip(ladder.interval_rung, ladder.interval_from_m, ladder.interval_to_m, ladder.interval_reason):
        color = FEASIBLE_COLOR if reason == 0 else REFUSED_COLOR
        parts.append(line(view(*along(ladder, rung, start)), view(*along(ladder, rung, end)), color, 5))
    if truth is not None:
        parts += draw_truth(truth, view)
    legend = [("safe ground", CLASS_COLORS[1]), ("wall", CLASS_COLORS[2]), ("obstacle", CLASS_COLORS[3]),
              ("a gripper may close", FEASIBLE_COLOR), ("refused", REFUSED_COLOR), ("bar (dashed: not trusted)", RUNG_COLOR)]
    if truth is not None:
        legend += [("truth, dashed: sound", SOUND_COLOR), ("truth: damaged, or a bar", DAMAGED_COLOR)]
    for i, (text, color) in enumerate(legend):
        parts.append(f'<circle cx="{WIDTH_PX - 210}" cy="{30 + 20 * i}" r="6" fill="{color}"/>'
                     f'<text x="{WIDTH_PX - 196}" y="{35 + 20 * i}" font-family="sans-serif" font-size="14">{text}</text>')
    for i, text in enumerate(caption):
        parts.append(f'<text x="10" y="{20 + 16 * i}" font-family="sans-serif" font-size="12">{html.escape(text)}</text>')
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
