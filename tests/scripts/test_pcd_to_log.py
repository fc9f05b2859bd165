#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""pcd_to_log on small clouds of every kind, odd and damaged ones first, read back through the message codecs.

    test_pcd_to_log.py [FOLDER_OF_ladder_msgs]
"""

import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
SCRIPTS = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts"
sys.path.insert(0, str(SCRIPTS))
from ladder_scripts import codecs, floor_fit, lcm_log, pcd  # noqa: E402

CODECS = sys.argv.pop(1) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else None
WIDTH, HEIGHT = 32, 24
FX = 25.0
TILT = math.radians(4.0)
UP = (0.0, -math.cos(TILT), -math.sin(TILT))  # a camera that looks 4 deg down
CAMERA_HEIGHT_M = 0.8


def camera_points():
    """Floor and a wall 3 m ahead, through the pinhole; pixel 5 sees nothing."""
    points = []
    for row in range(HEIGHT):
        for column in range(WIDTH):
            ray = ((column - (WIDTH - 1) / 2) / FX, (row - (HEIGHT - 1) / 2) / FX, 1.0)
            down = -floor_fit.dot(UP, ray)
            z = min(3.0, CAMERA_HEIGHT_M / down) if down > 1e-9 else 3.0
            points.append(tuple(z * v for v in ray))
    points[5] = (math.nan,) * 3
    return points


def header(fields, width, height, kind, version="0.7", end="\n"):
    names, sizes, types, counts = zip(*fields)
    lines = ["# .PCD", f"VERSION {version}", "FIELDS " + " ".join(names), "SIZE " + " ".join(map(str, sizes)),
             "TYPE " + " ".join(types), "COUNT " + " ".join(map(str, counts)), f"WIDTH {width}", f"HEIGHT {height}",
             "VIEWPOINT 0 0 0 1 0 0 0", f"POINTS {width * height}", f"DATA {kind}"]
    return (end.join(lines) + end).encode()


XYZ = [("x", 4, "F", 1), ("y", 4, "F", 1), ("z", 4, "F", 1)]
XYZ_AND_MORE = [("rgb", 4, "U", 1), ("x", 4, "F", 1), ("normal", 4, "F", 3), ("y", 8, "F", 1), ("z", 4, "F", 1)]


def literal_lzf(data):
    return b"".join(bytes([len(data[i : i + 32]) - 1]) + data[i : i + 32] for i in range(0, len(data), 32))


def as_ascii(points, width=WIDTH, height=HEIGHT, version="0.7", end="\n"):
    body = end.join(" ".join("%.9g" % v for v in p) for p in points) + end
    return header(XYZ, width, height, "ascii", version, end) + body.encode()


def as_binary(points, width=WIDTH, height=HEIGHT):
    body = b"".join(struct.pack("<If3fdf", 7, x, 0, 0, 1, y, z) for x, y, z in points)
    return header(XYZ_AND_MORE, width, height, "binary") + body


def as_compressed(points, width=WIDTH, height=HEIGHT):
    columns = b"".join(struct.pack(f"<{len(points)}f", *axis) for axis in zip(*points))
    packed = literal_lzf(columns)
    return header(XYZ, width, height, "binary_compressed") + struct.pack("<II", len(packed), len(columns)) + packed


class Pcd(unittest.TestCase):
    def refused(self, data, words):
        with self.assertRaisesRegex(pcd.PcdError, words):
            pcd.read_pcd(data)

    def test_foreign_files_are_refused(self):
        """What is not a PCD file is named as that."""
        self.refused(b"", "not a PCD")
        self.refused(b"\x89PNG\r\n\x1a\n" * 9, "not a PCD")
        self.refused(b"ply\nformat ascii 1.0\n", "unknown header line")
        self.refused(b"hello" * 9000, "not a PCD")

    def test_impossible_headers_are_refused(self):
        """Each contradiction in the header is named."""
        good = as_ascii([(1, 2, 3)], 1, 1)
        pcd.read_pcd(good)
        for old, new, words in ((b"VERSION 0.7", b"VERSION 0.5", "VERSION"), (b"WIDTH 1", b"WIDTH 2", "POINTS"),
                                (b"WIDTH 1", b"WIDTH x", "WIDTH"), (b"SIZE 4 4 4", b"SIZE 4 4", "lengths"),
                                (b"FIELDS x y z", b"FIELDS x y w", "field z"),
                                (b"TYPE F F F", b"TYPE F F U", "field z"),
                                (b"DATA ascii", b"DATA zip", "zip"), (b"SIZE 4 4 4\n", b"", "lacks SIZE"),
                                (b"FIELDS x y z", b"FIELDS x x z", "field x"),
                                (b"SIZE 4 4 4", b"SIZE 4 4 2", "field z"),
                                (b"WIDTH 1\nHEIGHT 1", b"WIDTH 0\nHEIGHT 0", "POINTS"),
                                (b"COUNT 1 1 1", b"COUNT 1 1 0", "field z")):
            self.refused(good.replace(old, new), words)

    def test_damaged_points_are_refused(self):
        """Cut or corrupt points are not read as a shorter cloud."""
        points = camera_points()
        self.refused(as_ascii(points)[:-40], "lines|values")
        self.refused(as_ascii(points).replace(b"nan", b"n@n", 1), "not a number")
        self.refused(as_binary(points)[:-1], "cut short")
        self.refused(as_compressed(points)[:-1], "cut short")
        self.refused(header(XYZ, 1, 1, "binary_compressed"), "cut short")

    def test_corrupt_compression_is_refused(self):
        """Tokens that reach before the beginning, end early or unpack to another size."""
        for packed, words in ((b"\x20\x00", "before its beginning"), (b"\x05abc", "within a token"),
                              (b"\x00a\xe0", "within a token"), (b"\x00a", "instead of 12")):
            with self.assertRaisesRegex(pcd.PcdError, words):
                pcd.lzf_decompress(packed, 12)

    def test_repetitions_unpack(self):
        """Short, long and overlapping repetitions, as LibLZF writes them."""
        self.assertEqual(pcd.lzf_decompress(b"\x00a\x20\x00", 4), b"aaaa")
        self.assertEqual(pcd.lzf_decompress(b"\x02abc\x40\x02", 7), b"abcabca")
        self.assertEqual(pcd.lzf_decompress(b"\x02abc\xe0\x10\x02", 28), (b"abc" * 10)[:28])

    def test_every_kind_reads_the_same(self):
        """Three encodings, both version spellings, both line ends, fields between: one cloud."""
        points = camera_points()
        for data in (as_ascii(points), as_ascii(points, version=".7", end="\r\n"), as_binary(points),
                     as_compressed(points)):
            cloud = pcd.read_pcd(data)
            self.assertEqual((cloud.width, cloud.height), (WIDTH, HEIGHT))
            for i, p in enumerate(points):
                for got, expected in zip((cloud.x[i], cloud.y[i], cloud.z[i]), p):
                    self.assertTrue(math.isnan(got) if math.isnan(expected) else abs(got - expected) < 1e-6)


class Log(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.messages = codecs.load_messages(CODECS)

    def run_script(self, data, *options):
        (self.folder / "in.pcd").write_bytes(data)
        codec_options = ["--codecs", CODECS] if CODECS else []
        return subprocess.run([sys.executable, SCRIPTS / "pcd_to_log.py", self.folder / "in.pcd", "-o",
                               self.folder / "out.lcm", *codec_options, *options], capture_output=True, text=True)

    def convert(self, data, *options):
        """(what was printed, [(utime, channel, message)])"""
        result = self.run_script(data, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        events = []
        for utime_us, channel, message in lcm_log.read_events((self.folder / "out.lcm").read_bytes()):
            kind = self.messages.imu_t if channel == "LADDER_IMU" else self.messages.tof_frame_t
            events.append((utime_us, channel, kind.decode(message)))
        return result.stdout, events

    def frames(self, events):
        return [message for _, channel, message in events if channel.startswith("LADDER_TOF_")]

    def test_mistakes_are_explained(self):
        """A wrong file, an impossible wish and a foreign camera end with one line and code 2."""
        for data, options, words in ((b"junk", (), "not a PCD"),
                                     (as_ascii(camera_points()), ("--fx", "25", "--up", "0,0,0"), "length"),
                                     (as_ascii(camera_points()), ("--fx", "50"), "--fx 25.0"),
                                     (as_ascii([(math.nan,) * 3] * 4, 2, 2), (), "no pixel"),
                                     (as_ascii([(1.0, 2.0, 1.0)], 1, 1), (), "no floor"),
                                     (as_ascii([(0.0, 0.0, 1.0)] * 2000, 1, 2000), (), "1024")):
            result = self.run_script(data, *options)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertRegex(result.stderr, words)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)

    def test_organised_cloud_is_one_head(self):
        """Pixels, camera and ranges arrive as they were; no return stays no return."""
        points = camera_points()
        printed, events = self.convert(as_compressed(points), "--fx", "25", "--range-max", "5", "--wrap-range", "2.49")
        (frame,) = self.frames(events)
        self.assertEqual((frame.width_px, frame.height_px, frame.num_pixels), (WIDTH, HEIGHT, WIDTH * HEIGHT))
        self.assertEqual((frame.fx_px, frame.fy_px, frame.cx_px, frame.cy_px), (25.0, 25.0, 15.5, 11.5))
        self.assertEqual((frame.range_max_m, frame.wrap_range_m), (5.0, 2.49))
        self.assertEqual(frame.depth_kind, self.messages.tof_frame_t.DEPTH_Z)
        self.assertEqual(frame.depth_mm[5], 0)
        for got, p in zip(frame.depth_mm, points):
            if not math.isnan(p[2]):
                self.assertLessEqual(abs(got - 1000.0 * p[2]), 0.5001)
        self.assertIn("0.00 mm (median)", printed)

    def test_up_from_the_floor(self):
        """The fitted floor gives the tilt of the camera; in body axes (x ahead, z up) that is a pitch."""
        printed, events = self.convert(as_binary(camera_points()), "--fx", "25")
        self.assertIn("up: from the fitted floor", printed)
        self.assertIn("above the floor: 0.80", printed)
        imu = next(message for _, channel, message in events if channel == "LADDER_IMU")
        expected = (-9.81 * math.sin(TILT), 0.0, 9.81 * math.cos(TILT))
        for got, value in zip(imu.accelerometer_m_s2, expected):
            self.assertAlmostEqual(got, value, delta=0.03)

    def test_up_from_the_option(self):
        """--up is taken as it is, in the axes of the cloud, and said so."""
        printed, events = self.convert(as_ascii(camera_points()), "--fx", "25", "--up", "0,0,-2")
        self.assertIn("up: from --up", printed)
        imu = next(message for _, channel, message in events if channel == "LADDER_IMU")
        for got, value in zip(imu.accelerometer_m_s2, (-9.81, 0.0, 0.0)):
            self.assertAlmostEqual(got, value, delta=1e-9)

    def test_repeated_frames_advance(self):
        """15 Hz, seq from 0, events in the order of time, samples before the first frame; twice the same bytes."""
        data = as_ascii(camera_points())
        _, events = self.convert(data, "--fx", "25", "--frames", "16")
        first = (self.folder / "out.lcm").read_bytes()
        frames = self.frames(events)
        self.assertEqual([frame.seq for frame in frames], list(range(16)))
        self.assertEqual(frames[15].utime - frames[0].utime, 1_000_000)
        times = [utime for utime, _, _ in events]
        self.assertEqual(times, sorted(times))
        self.assertEqual(events[0][1], "LADDER_IMU")
        self.assertTrue(all(utime == message.utime for utime, _, message in events))
        self.convert(data, "--fx", "25", "--frames", "16")
        self.assertEqual((self.folder / "out.lcm").read_bytes(), first)

    def test_unorganised_cloud_is_four_heads(self):
        """A wall 2 m ahead of --view and the floor: every pixel of the heads that has a depth lies on one of them."""
        wall = [(3.0, 0.02 * y - 3.0, 0.02 * z) for y in range(300) for z in range(100)]
        floor = [(0.02 * x, 0.02 * y - 3.0, 0.0) for x in range(150) for y in range(300)]
        points = wall + floor
        printed, events = self.convert(as_binary(points, len(points), 1), "--view", "1,0,0.5,0", "--range-max", "4")
        self.assertIn("view: 1.000,0.000,0.500,0.0 (--view)", printed)
        frames = self.frames(events)
        self.assertEqual([frame.head for frame in frames], [0, 1, 2, 3])
        num_seen = 0
        for frame in frames:
            w, x, y, z = frame.q_body_head
            for i in range(0, frame.num_pixels, 97):
                if frame.depth_mm[i] == 0:
                    continue
                depth_m = frame.depth_mm[i] / 1000.0
                row, column = divmod(i, frame.width_px)
                ray = ((column - frame.cx_px) / frame.fx_px, (row - frame.cy_px) / frame.fy_px)
                p = (depth_m * ray[0], depth_m * ray[1], depth_m)
                t = tuple(2.0 * v for v in floor_fit.cross((x, y, z), p))
                turned = floor_fit.cross((x, y, z), t)
                body = [p[k] + w * t[k] + turned[k] for k in range(3)]
                self.assertLess(min(abs(body[0] - 2.0), abs(body[2] + 0.5)), 0.03, body)
                num_seen += 1
        self.assertGreater(num_seen, 1000)

    def test_default_view_is_printed(self):
        """Without --view one is chosen from which something is seen."""
        wall = [(3.0, 0.03 * y - 3.0, 0.03 * z) for y in range(200) for z in range(60)]
        floor = [(0.03 * x, 0.03 * y - 3.0, 0.0) for x in range(100) for y in range(200)]
        printed, _ = self.convert(as_ascii(wall + floor, len(wall + floor), 1))
        self.assertRegex(printed, r"view: .* \(chosen\)")


class EventLog(unittest.TestCase):
    def test_damage_is_found(self):
        """A log that is cut or shifted is not read as a shorter one."""
        event = lcm_log.HEAD.pack(lcm_log.MAGIC, 0, 5, 1, 2) + b"Cxy"
        self.assertEqual(list(lcm_log.read_events(event)), [(5, "C", b"xy")])
        for damaged in (event[:-1], event[:10], b"?" + event):
            with self.assertRaises(lcm_log.LogError):
                list(lcm_log.read_events(damaged))


if __name__ == "__main__":
    unittest.main()
