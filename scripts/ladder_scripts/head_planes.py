# SPDX-License-Identifier: BSD-3-Clause
"""Where a head sits, from two planes that it sees: the floor and a wall straight ahead of a robot that stands still.

The floor gives roll, pitch and height, the wall yaw and distance; sideways neither tells anything. A head that sees only one of
them is turned by the smallest angle that brings that plane where it belongs."""

import math

from ladder_scripts import floor_fit
from ladder_scripts.floor_fit import cross, dot, unit

UP, TOWARDS_ROBOT = (0.0, 0.0, 1.0), (-1.0, 0.0, 0.0)
MIN_SHARE = 0.03  # of a head's points on a plane
MAX_POINTS = 6000
MIN_COSINE = math.cos(math.radians(20.0))  # a plane that stands otherwise is another one


def rotate(q, v):
    """v turned by the unit quaternion q (w x y z)."""
    w, x, y, z = q
    t = tuple(2.0 * c for c in cross((x, y, z), v))
    u = cross((x, y, z), t)
    return (v[0] + w * t[0] + u[0], v[1] + w * t[1] + u[1], v[2] + w * t[2] + u[2])


def multiply(a, b):
    w, x, y, z = a
    v, i, j, k = b
    return (w * v - x * i - y * j - z * k, w * i + x * v + y * k - z * j, w * j - x * k + y * v + z * i, w * k + x * j - y * i + z * v)


def angle_deg(q):
    return math.degrees(2.0 * math.atan2(math.sqrt(q[1] ** 2 + q[2] ** 2 + q[3] ** 2), abs(q[0])))


def shortest_turn(a, b):
    """The unit quaternion that turns the unit vector a into b by the smallest angle."""
    w = 1.0 + dot(a, b)
    x, y, z = cross(a, b)
    length = math.sqrt(w * w + x * x + y * y + z * z)
    return (w / length, x / length, y / length, z / length)


def mean_points(frames):
    """Points in the head's frame, each pixel's distance the mean over the frames that measured it."""
    sums, counts = [0] * frames[0]["num_pixels"], [0] * frames[0]["num_pixels"]
    for frame in frames:
        for i, depth in enumerate(frame["depth_mm"]):
            if depth > 0:
                sums[i] += depth
                counts[i] += 1
    frame, points = frames[0], []
    step = max(1, len(sums) // MAX_POINTS)
    for i in range(0, len(sums), step):
        if 2 * counts[i] <= len(frames):
            continue
        x = (i % frame["width_px"] - frame["cx_px"]) / frame["fx_px"]
        y = (i // frame["width_px"] - frame["cy_px"]) / frame["fy_px"]
        depth_m = 0.001 * sums[i] / counts[i]
        if frame["depth_kind"] == 2:
            depth_m /= math.sqrt(1.0 + x * x + y * y)
        points.append((x * depth_m, y * depth_m, depth_m))
    return points


def fit(points, direction):
    """(normal, offset, share) of the plane that faces `direction`, or None."""
    plane = floor_fit.fit_floor(points, direction)
    return plane if plane and plane[2] >= MIN_SHARE and dot(plane[0], direction) >= MIN_COSINE else None


def improved(p, q, points, height_m, wall_m):
    """(new p_body_head_m, new q_body_head, what was seen: 'floor', 'wall') from points in the head's frame."""
    in_body = [tuple(a + b for a, b in zip(rotate(q, point), p)) for point in points]
    floor, wall = fit(in_body, UP), fit(in_body, TOWARDS_ROBOT)
    turn = (1.0, 0.0, 0.0, 0.0)
    if floor:
        turn = shortest_turn(floor[0], UP)
    if wall:
        normal = rotate(turn, wall[0])
        level = unit((normal[0], normal[1], 0.0)) if floor else normal
        turn = multiply(shortest_turn(level, TOWARDS_ROBOT), turn)
    new_p = list(p)
    if floor:
        new_p[2] = -height_m - (floor[1] - dot(floor[0], p))
    if wall:
        new_p[0] = wall_m + wall[1] - dot(wall[0], p)
    return tuple(new_p), multiply(turn, q), [name for name, plane in (("floor", floor), ("wall", wall)) if plane]
