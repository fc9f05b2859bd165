# SPDX-License-Identifier: BSD-3-Clause
"""Turns a point cloud into what depth heads would have delivered: images in millimetres with a pinhole model."""

import dataclasses
import math

MAX_DEPTH_MM = 32767
LOOKING_AHEAD = (0.5, -0.5, 0.5, -0.5)  # w x y z: head (x right, y down, z forward) into body (x ahead, y left, z up)


class ViewError(Exception):
    """The cloud does not fit the camera or the view."""


@dataclasses.dataclass
class Head:
    """One head: image size, pinhole model, orientation in the body, depths along the optical axis (0 = nothing)."""

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    q_body_head: tuple = LOOKING_AHEAD
    depth_mm: list = dataclasses.field(default_factory=list)


# The heads that the detector is tuned on: 224 x 171 pixels, 62 x 45 deg, two by two.
FAN_YAW_RAD = math.radians(28.0)
FAN_PITCH_RAD = math.radians(20.0)
FAN_WIDTH, FAN_HEIGHT = 224, 171
FAN_FX = 0.5 * FAN_WIDTH / math.tan(math.radians(31.0))
FAN_FY = 0.5 * FAN_HEIGHT / math.tan(math.radians(22.5))


def to_mm(depth_m):
    """0 for what cannot be written."""
    if not math.isfinite(depth_m):
        return 0
    depth_mm = int(depth_m * 1000.0 + 0.5)
    return depth_mm if 0 < depth_mm <= MAX_DEPTH_MM else 0


def image_of_organised(cloud, head):
    """Fills head.depth_mm from the cloud's own rows; (median, 95th percentile) of the distance in metres between its
    points and where the pinhole model puts them."""
    head.depth_mm = [to_mm(z) for z in cloud.z]
    residuals = []
    rows = range(0, cloud.height, 2)
    for row in rows:
        ray_y = (row - head.cy) / head.fy
        for column in range(0, cloud.width, 2):
            i = row * cloud.width + column
            if head.depth_mm[i] == 0:
                continue
            z = cloud.z[i]
            residuals.append(math.hypot(cloud.x[i] - z * (column - head.cx) / head.fx, cloud.y[i] - z * ray_y))
    residuals = sorted(r for r in residuals if math.isfinite(r))
    if not residuals:
        raise ViewError("no pixel has a depth")
    return residuals[len(residuals) // 2], residuals[len(residuals) * 95 // 100]


def fit_pinhole(cloud):
    """(fx, cx, fy, cy) that the points of an organised cloud follow best: u = fx x / z + cx by least squares."""
    width = cloud.width
    tangents_x, columns, tangents_y, rows = [], [], [], []
    for i in range(0, len(cloud.z), 7):
        x, y, z = cloud.x[i], cloud.y[i], cloud.z[i]
        if math.isfinite(x) and math.isfinite(y) and math.isfinite(z) and z > 0.0:
            tangents_x.append(x / z)
            columns.append(i % width)
            tangents_y.append(y / z)
            rows.append(i // width)
    return (*_line(tangents_x, columns), *_line(tangents_y, rows))


def _line(a, b):
    """Slope and offset of b over a; NaN without spread."""
    n = len(a)
    if n < 2:
        return math.nan, math.nan
    mean_a, mean_b = sum(a) / n, sum(b) / n
    spread = sum((v - mean_a) ** 2 for v in a)
    if spread == 0.0:
        return math.nan, math.nan
    slope = sum((v - mean_a) * (w - mean_b) for v, w in zip(a, b)) / spread
    return slope, mean_b - slope * mean_a


def multiply(a, b):
    """Product of two quaternions w x y z."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (aw * bw - ax * bx - ay * by - az * bz, aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw)


def rotate(q, v):
    """v turned by the unit quaternion q."""
    w, x, y, z = q
    tx, ty, tz = 2.0 * (y * v[2] - z * v[1]), 2.0 * (z * v[0] - x * v[2]), 2.0 * (x * v[1] - y * v[0])
    return (v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz, v[2] + w * tz + x * ty - y * tx)


def fan_heads():
    """Four heads, two by two: upper left, upper right, lower left, lower right."""
    heads = []
    for pitch_up, yaw_left in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        yaw, pitch = yaw_left * FAN_YAW_RAD, pitch_up * FAN_PITCH_RAD
        turn = multiply((math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)),
                        (math.cos(pitch / 2), 0.0, -math.sin(pitch / 2), 0.0))
        heads.append(Head(FAN_WIDTH, FAN_HEIGHT, FAN_FX, FAN_FY, (FAN_WIDTH - 1) / 2, (FAN_HEIGHT - 1) / 2,
                          multiply(turn, LOOKING_AHEAD)))
    return heads


def point_spacing_m(points):
    """Typical distance of neighbours on a surface: from the number of points per occupied 5 cm cell."""
    side_m = 0.05
    cells = {(int(x // side_m), int(y // side_m), int(z // side_m)) for x, y, z in points}
    return side_m / math.sqrt(max(1.0, len(points) / len(cells)))


def draw_into(head, points_body, spacing_m, range_max_m):
    """Z-buffer: each pixel gets the nearest point; a point covers the square of its spacing, so that surfaces close."""
    w, x, y, z = head.q_body_head
    q_head_body = (w, -x, -y, -z)
    columns = [rotate(q_head_body, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]
    (rxx, ryx, rzx), (rxy, ryy, rzy), (rxz, ryz, rzz) = columns
    width, height = head.width, head.height
    depth_mm = [0] * (width * height)
    for bx, by, bz in points_body:
        depth_m = rzx * bx + rzy * by + rzz * bz
        if not 0.05 < depth_m <= range_max_m:
            continue
        column = head.fx * (rxx * bx + rxy * by + rxz * bz) / depth_m + head.cx
        row = head.fy * (ryx * bx + ryy * by + ryz * bz) / depth_m + head.cy
        half_x = min(3.0, 0.5 * spacing_m * head.fx / depth_m)
        half_y = min(3.0, 0.5 * spacing_m * head.fy / depth_m)
        first_row, last_row = max(0, round(row - half_y)), min(height - 1, round(row + half_y))
        first, last = max(0, round(column - half_x)), min(width - 1, round(column + half_x))
        mm = to_mm(depth_m)
        for r in range(first_row, last_row + 1):
            for i in range(r * width + first, r * width + last + 1):
                if depth_mm[i] == 0 or mm < depth_mm[i]:
                    depth_mm[i] = mm
    head.depth_mm = depth_mm
    return sum(1 for mm in depth_mm if mm)
