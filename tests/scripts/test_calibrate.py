#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""calibrate on drawn depth images and joint angles of which the truth is known."""

import math
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import tomllib
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from ladder_scripts import head_planes, lcm_log, lcm_types, toml_lines  # noqa: E402
from ladder_scripts.floor_fit import dot  # noqa: E402

HEIGHT_M, WALL_M = 0.55, 2.2
WIDTH, PIXELS_HIGH, FOCAL_PX = 64, 48, 45.0
AHEAD = (0.5, -0.5, 0.5, -0.5)  # x right, y down, z ahead -> body
TYPES = {path.stem: lcm_types.parse(path) for path in (ROOT / "lcmtypes").glob("*.lcm")}


def about(axis, degrees):
    half = math.radians(degrees) / 2.0
    return (math.cos(half), *(math.sin(half) * v for v in axis))


def encoded(name, values):
    message_type = TYPES[name]
    out = [lcm_types.fingerprint(message_type).to_bytes(8, "big")]
    code = {"int8_t": "b", "int16_t": "h", "int32_t": "i", "int64_t": "q", "float": "f", "double": "d", "byte": "B"}
    for field in message_type.fields:
        size = len(values.get(field.name, ())) if field.count_index >= 0 else field.fixed
        value = values.get(field.name, [0] * size if field.is_array else 0)
        out.append(struct.pack(f">{size}{code[field.kind]}", *(value if field.is_array else [value])))
    return b"".join(out)


def depth_image(p, q, rng):
    """Distances [mm] of floor and wall along the axis of a head that really sits at p, q."""
    image = []
    for row in range(PIXELS_HIGH):
        for column in range(WIDTH):
            ray = head_planes.rotate(q, ((column - (WIDTH - 1) / 2) / FOCAL_PX, (row - (PIXELS_HIGH - 1) / 2) / FOCAL_PX, 1.0))
            hits = [(-HEIGHT_M - p[2]) / ray[2] if ray[2] < -1e-6 else math.inf, (WALL_M - p[0]) / ray[0] if ray[0] > 1e-6 else math.inf]
            depth = min(hits) * 1000.0 + rng.gauss(0.0, 5.0)
            image.append(int(depth) if 100.0 < depth < 6000.0 else 0)
    return image


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.log = pathlib.Path(folder.name) / "still.lcm"
        self.toml = pathlib.Path(folder.name) / "robot.toml"
        self.toml.write_text((ROOT / "config/robot.toml").read_text())

    def record(self, events):
        with open(self.log, "wb") as file:
            writer = lcm_log.LogWriter(file)
            for i, (channel, message) in enumerate(events):
                writer.write(1_000_000 * i, channel, message)

    def calibrate(self, *arguments):
        return subprocess.run([str(ROOT / "scripts/calibrate"), *map(str, arguments)], capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)


class Heads(InFolder):
    def test_mounting_errors_are_found(self):
        """Turns of up to 2 deg and shifts of 10 mm are found to 0.15 deg and 3 mm; a head that sees the wall alone keeps its roll and height."""
        rng = random.Random(4)
        truth, events = [], []
        for head, pitch_deg in enumerate((25.0, 15.0, -20.0)):  # + looks down
            q = head_planes.multiply(about((0.0, 1.0, 0.0), pitch_deg), AHEAD)
            turn = about((1, 0, 0), rng.uniform(-2, 2)) if head < 2 else (1.0, 0.0, 0.0, 0.0)
            for axis in ((0, 1, 0), (0, 0, 1)):
                turn = head_planes.multiply(about(axis, rng.uniform(-2, 2)), turn)
            nominal_p, real_q = (0.1, 0.05 * head, 0.02), head_planes.multiply(turn, q)
            real_p = (nominal_p[0] + rng.uniform(-0.01, 0.01), nominal_p[1], nominal_p[2] + (rng.uniform(-0.01, 0.01) if head < 2 else 0.0))
            truth.append((real_p, real_q))
            for _ in range(4):
                image = depth_image(real_p, real_q, rng)
                events.append((f"LADDER_TOF_{head}", encoded("tof_frame_t", {
                    "head": head, "depth_kind": 1, "width_px": WIDTH, "height_px": PIXELS_HIGH, "fx_px": FOCAL_PX, "fy_px": FOCAL_PX,
                    "cx_px": (WIDTH - 1) / 2, "cy_px": (PIXELS_HIGH - 1) / 2, "range_max_m": 6.0, "p_body_head_m": nominal_p, "q_body_head": q,
                    "num_pixels": len(image), "depth_mm": image})))
        self.record(events)
        said = self.calibrate("heads", self.log, "--height_m", HEIGHT_M, "--wall_m", WALL_M, "--write", self.toml, "--yes")
        self.assertEqual(said.returncode, 0, said.stderr)
        written = tomllib.loads(self.toml.read_text())["sensor"]
        for head, (p, q) in enumerate(truth):
            found = written[f"head_{head}"]
            off = head_planes.angle_deg(head_planes.multiply(found["q_body_head"], (q[0], -q[1], -q[2], -q[3])))
            with self.subTest(head=head, off_deg=off):
                self.assertLess(off, 0.15 if head < 2 else 0.4)
                self.assertLess(abs(found["p_body_head_m"][0] - p[0]), 0.003)
                self.assertLess(abs(found["p_body_head_m"][2] - p[2]), 0.003)
        self.assertIn("LADDER_TOF_2: sees wall;", said.stdout)
        self.assertIn("+p_body_head_m", said.stdout, "the difference is shown")

    def test_nothing_is_written_unasked(self):
        """Without --yes and without a person to ask, the file stays; an empty recording is not enough; a wrong height is seen."""
        image = depth_image((0.1, 0.0, 0.0), head_planes.multiply(about((0, 1, 0), 25.0), AHEAD), random.Random(5))
        frame = {"depth_kind": 1, "width_px": WIDTH, "height_px": PIXELS_HIGH, "fx_px": FOCAL_PX, "fy_px": FOCAL_PX, "cx_px": 31.5, "cy_px": 23.5,
                 "p_body_head_m": (0.1, 0.0, 0.0), "q_body_head": head_planes.multiply(about((0, 1, 0), 24.0), AHEAD), "num_pixels": len(image), "depth_mm": image}
        self.record([("LADDER_TOF_0", encoded("tof_frame_t", frame))])
        before = self.toml.read_text()
        said = self.calibrate("heads", self.log, "--height_m", HEIGHT_M, "--wall_m", WALL_M, "--write", self.toml)
        self.assertEqual((said.returncode, self.toml.read_text()), (0, before))
        self.assertIn("was not changed", said.stdout)
        self.assertEqual(self.calibrate("heads", self.log, "--height_m", 1.0, "--wall_m", WALL_M).returncode, 1)
        self.record([])
        self.assertEqual(self.calibrate("heads", self.log, "--height_m", HEIGHT_M, "--wall_m", WALL_M).returncode, 1)
        self.assertEqual(self.calibrate("heads", "/no/such.lcm", "--height_m", 1, "--wall_m", 1).returncode, 3)
        self.assertEqual(self.calibrate("heads", self.log).returncode, 2)


class Joints(InFolder):
    def test_offsets(self):
        """The offset is what brings the measured angle to the pose; it adds to the one that was in use."""
        measured = [0.01 * axis - 0.05 for axis in range(16)]
        pose = [0.0] * 15 + [1.2]
        self.record([("LADDER_CLIMB", encoded("climb_state_t", {"is_heard": [1] * 16, "measured_rad": measured}))] * 3)
        self.toml.write_text(toml_lines.set_value(self.toml.read_text(), "climb.drives", "offset_rad", str([0.5] * 16)))
        said = self.calibrate("joints", self.log, "--pose_rad", ",".join(map(str, pose)), "--write", self.toml, "--yes")
        self.assertEqual(said.returncode, 0, said.stderr)
        for offset, was, wanted in zip(tomllib.loads(self.toml.read_text())["climb"]["drives"]["offset_rad"], measured, pose):
            self.assertAlmostEqual(offset, 0.5 + wanted - was, places=4)

    def test_refused(self):
        """A drive that is not heard, or a joint that moves, is named."""
        heard = [1] * 16
        heard[3] = 0
        self.record([("LADDER_CLIMB", encoded("climb_state_t", {"is_heard": heard}))])
        said = self.calibrate("joints", self.log)
        self.assertEqual((said.returncode, "axes [3]" in said.stderr), (1, True))
        self.record([("LADDER_CLIMB", encoded("climb_state_t", {"is_heard": [1] * 16, "measured_rad": [angle] * 16})) for angle in (0.0, 0.1)])
        self.assertIn("must stand still", self.calibrate("joints", self.log).stderr)


class Toml(unittest.TestCase):
    def test_single_values(self):
        """Only the value changes, in its own table alone; a key that is not there is named."""
        text = '[a]\nx = [1, 2]  # why\n[a.b]\n  x = "old"\n[c]\nx = 3'
        self.assertEqual(toml_lines.set_value(text, "a.b", "x", '"new"'), text.replace("old", "new"))
        self.assertEqual(toml_lines.set_value(text, "a", "x", "[0]"), text.replace("[1, 2]", "[0]"))
        self.assertEqual(toml_lines.set_value(text, "c", "x", "4"), text.replace("= 3", "= 4"))
        with self.assertRaises(toml_lines.NoSuchKey):
            toml_lines.set_value(text, "c", "y", "4")

    def test_turns(self):
        """The shortest turn brings one vector upon the other."""
        a, b = (0.6, 0.0, 0.8), (0.0, -1.0, 0.0)
        self.assertGreater(dot(head_planes.rotate(head_planes.shortest_turn(a, b), a), b), 1.0 - 1e-12)


if __name__ == "__main__":
    unittest.main()
