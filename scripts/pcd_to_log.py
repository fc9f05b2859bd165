#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Turns a recorded point cloud (PCD) into an LCM log of raw head frames and inertial samples, for scripts/replay.

An organised cloud (an image of points, camera frame x right, y down, z forward) becomes the image of one head. An
unorganised one (z up) is drawn into four heads, two by two, at a viewpoint. Which way is up comes from --up or from
the floor in the cloud; the program prints which. The same input gives the same log, byte for byte.
"""

import argparse
import math
import pathlib
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ladder_scripts import codecs, depth_heads, floor_fit, lcm_log, pcd  # noqa: E402

START_US = 1_600_000_000_000_000
FRAME_RATE_HZ = 15
STAGGER_US = 16_667
IMU_PERIOD_US = 10_000
IMU_LEAD_US = 100_000
GRAVITY_M_S2 = 9.81
CAMERA_RESIDUAL_LIMIT_M = 0.02


class UsageError(Exception):
    """What the user asked for is not possible; says why."""


def numbers(text, count):
    try:
        values = [float(word) for word in text.split(",")]
    except ValueError:
        values = []
    if len(values) != count or not all(map(math.isfinite, values)):
        raise argparse.ArgumentTypeError(f"'{text}' is not {count} numbers with commas between")
    return values


def arguments(argv):
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("pcd", type=pathlib.Path)
    parser.add_argument("-o", "--out", type=pathlib.Path, required=True, help="the log")
    parser.add_argument("--frames", type=int, default=1, help="how often each frame is repeated, at 15 Hz (default 1)")
    parser.add_argument("--up", type=lambda text: numbers(text, 3), metavar="X,Y,Z",
                        help="direction of up in the cloud's axes, as --up=0,-1,0 (default: normal of the fitted floor)")
    parser.add_argument("--view", type=lambda text: numbers(text, 4), metavar="X,Y,Z,YAW",
                        help="unorganised clouds: where the heads stand [m, deg] (default: chosen and printed)")
    parser.add_argument("--fx", type=float, default=525.0, help="organised clouds: pinhole model [px] (default 525)")
    parser.add_argument("--fy", type=float, help="(default: as fx)")
    parser.add_argument("--cx", type=float, help="(default: the middle, 319.5 for 640 columns)")
    parser.add_argument("--cy", type=float, help="(default: the middle, 239.5 for 480 rows)")
    parser.add_argument("--range-min", type=float, default=0.1, help="the camera's nearest distance [m]")
    parser.add_argument("--range-max", type=float, default=4.0, help="the camera's farthest distance [m]")
    parser.add_argument("--wrap-range", type=float, default=0.0, help="unambiguous range [m]; 0 = never repeats")
    parser.add_argument("--codecs", type=pathlib.Path, help="folder of generated Python codecs (default build/python)")
    options = parser.parse_args(argv)
    if not 1 <= options.frames <= 100_000:
        parser.error("--frames must be 1 to 100000")
    if not 0.0 <= options.range_min < options.range_max <= 1000.0 or not 0.0 <= options.wrap_range <= 1000.0:
        parser.error("ranges must satisfy 0 <= --range-min < --range-max and --wrap-range >= 0")
    return options


def direction_of_up(options, points, rough_up):
    """Unit vector in the axes of the cloud; prints where it comes from."""
    if options.up:
        up = floor_fit.unit(options.up)
        if up is None:
            raise UsageError("--up has no length")
        print("up: from --up, %.4f %.4f %.4f" % up)
        return up, None
    floor = floor_fit.fit_floor(points, rough_up)
    if floor is None:
        raise UsageError("no floor found: name the direction of up with --up X,Y,Z")
    up, offset, share = floor
    tilt_deg = math.degrees(math.acos(min(1.0, floor_fit.dot(up, rough_up))))
    print("up: from the fitted floor, %.4f %.4f %.4f, %.2f deg from %s, %.0f %% of the points on it"
          % (*up, tilt_deg, ",".join("%g" % v for v in rough_up), 100.0 * share))
    return up, offset


def organised_head(options, cloud):
    """The one head of an organised cloud, and up in its body frame."""
    if cloud.width > 1024 or cloud.height > 1024:
        raise UsageError(f"{cloud.width} x {cloud.height} pixels; a head has at most 1024 x 1024")
    head = depth_heads.Head(cloud.width, cloud.height, options.fx, options.fy or options.fx,
                            (cloud.width - 1) / 2 if options.cx is None else options.cx,
                            (cloud.height - 1) / 2 if options.cy is None else options.cy)
    if not (1.0 <= head.fx <= 1e5 and 1.0 <= head.fy <= 1e5):
        raise UsageError("--fx and --fy must be 1 to 100000 px")
    median_m, p95_m = depth_heads.image_of_organised(cloud, head)
    print("camera: %d x %d, fx %g fy %g cx %g cy %g; the cloud's points lie %.2f mm (median), %.2f mm (p95) from it"
          % (head.width, head.height, head.fx, head.fy, head.cx, head.cy, 1e3 * median_m, 1e3 * p95_m))
    if median_m > CAMERA_RESIDUAL_LIMIT_M:
        raise UsageError("the cloud was not seen by this camera; its points fit --fx %.1f --cx %.1f --fy %.1f --cy %.1f"
                         % depth_heads.fit_pinhole(cloud))
    points = pcd.finite_points(cloud)
    up, offset = direction_of_up(options, points, (0.0, -1.0, 0.0))
    if offset is not None:
        print("camera height above the floor: %.3f m" % -offset)
    return [head], depth_heads.rotate(depth_heads.LOOKING_AHEAD, up)


def default_view(points, range_max_m):
    """In the middle of the cloud, 0.55 m above its low points, looking where most points are in range; in whole
    millimetres, as it is printed."""
    sample = points[:: max(1, len(points) // 5000)]
    x, y = (round(sorted(p[i] for p in sample)[len(sample) // 2], 3) for i in range(2))
    z = round(sorted(p[2] for p in sample)[len(sample) // 20] + 0.55, 3)

    def num_ahead(yaw_deg):
        cosine, sine = math.cos(math.radians(yaw_deg)), math.sin(math.radians(yaw_deg))
        ahead = [cosine * (p[0] - x) + sine * (p[1] - y) for p in sample]
        aside = [cosine * (p[1] - y) - sine * (p[0] - x) for p in sample]
        return sum(1 for a, b in zip(ahead, aside) if 0.3 < a < range_max_m and abs(b) < a)

    return [x, y, z, max((45.0 * i for i in range(8)), key=num_ahead)]


def drawn_heads(options, cloud):
    """The four heads of an unorganised cloud, and up in their body frame."""
    points = pcd.finite_points(cloud)
    if not points:
        raise UsageError("the cloud has no point")
    up, _ = direction_of_up(options, points, (0.0, 0.0, 1.0))
    x, y, z, yaw_deg = options.view or default_view(points, options.range_max)
    print("view: %.3f,%.3f,%.3f,%.1f %s" % (x, y, z, yaw_deg, "(--view)" if options.view else "(chosen)"))
    cosine, sine = math.cos(math.radians(yaw_deg)), math.sin(math.radians(yaw_deg))

    def to_body(v):
        return (cosine * v[0] + sine * v[1], cosine * v[1] - sine * v[0], v[2])

    points_body = [to_body((px - x, py - y, pz - z)) for px, py, pz in points]
    spacing_m = depth_heads.point_spacing_m(points)
    heads = depth_heads.fan_heads()
    num_seen = [depth_heads.draw_into(head, points_body, spacing_m, options.range_max) for head in heads]
    print("heads: 4 of %d x %d; pixels with a point: %s; point spacing %.1f mm"
          % (heads[0].width, heads[0].height, " ".join(map(str, num_seen)), 1e3 * spacing_m))
    if not any(num_seen):
        raise UsageError("no head sees a point from there: choose another --view")
    return heads, to_body(up)


def frame_message(messages, options, head_index, head):
    message = messages.tof_frame_t()
    message.head = head_index
    message.depth_kind = message.DEPTH_Z
    message.width_px, message.height_px = head.width, head.height
    message.fx_px, message.fy_px, message.cx_px, message.cy_px = head.fx, head.fy, head.cx, head.cy
    message.range_min_m, message.range_max_m = options.range_min, options.range_max
    message.wrap_range_m = options.wrap_range
    message.p_body_head_m = [0.0, 0.0, 0.0]
    message.q_body_head = list(head.q_body_head)
    message.num_pixels = len(head.depth_mm)
    message.depth_mm = head.depth_mm
    message.num_confidence = 0
    message.confidence = b""
    return message


def imu_message(messages, up_body):
    message = messages.imu_t()
    message.accelerometer_m_s2 = [GRAVITY_M_S2 * v for v in up_body]
    message.gyroscope_rad_s = [0.0, 0.0, 0.0]
    return message


def write_log(file, messages, options, heads, up_body):
    """All events in the order of their time; the samples begin a little before the first frame."""
    frames = [frame_message(messages, options, h, head) for h, head in enumerate(heads)]
    imu = imu_message(messages, up_body)
    schedule = []
    for seq in range(options.frames):
        for h in range(len(heads)):
            schedule.append((START_US + seq * 1_000_000 // FRAME_RATE_HZ + h * STAGGER_US, h, seq))
    end_us = max(schedule)[0]
    num_samples = (end_us - START_US + IMU_LEAD_US) // IMU_PERIOD_US + 1
    schedule += [(START_US - IMU_LEAD_US + i * IMU_PERIOD_US, -1, i) for i in range(num_samples)]
    writer = lcm_log.LogWriter(file)
    for utime_us, source, seq in sorted(schedule):
        message = imu if source < 0 else frames[source]
        message.utime, message.seq = utime_us, seq
        channel = "LADDER_IMU" if source < 0 else f"LADDER_TOF_{source}"
        writer.write(utime_us, channel, message.encode())
    return writer.num_events


def run(argv):
    options = arguments(argv)
    messages = codecs.load_messages(options.codecs)
    cloud = pcd.read_pcd(options.pcd.read_bytes())
    print(f"{options.pcd.name}: {'organised' if cloud.is_organised else 'unorganised'}, "
          f"{cloud.width} x {cloud.height} points")
    heads, up_body = organised_head(options, cloud) if cloud.is_organised else drawn_heads(options, cloud)
    options.out.parent.mkdir(parents=True, exist_ok=True)
    with open(options.out, "wb") as file:
        num_events = write_log(file, messages, options, heads, up_body)
    if len(heads) == 1 and options.frames == 1:
        print("note: one frame of one head makes no cloud, the first one waits for more: see --frames")
    print(f"written: {options.out}, {num_events} events")


def main():
    try:
        run(sys.argv[1:])
    except (UsageError, pcd.PcdError, depth_heads.ViewError, codecs.CodecError, OSError) as error:
        print(f"pcd_to_log: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
