# SPDX-License-Identifier: BSD-3-Clause
"""The floor of a cloud: the largest plane that is nearly level and has next to nothing beneath it."""

import math
import random

HYPOTHESES = 600
SAMPLE = 4000
CELL_M = 0.4
MAX_TILT_COSINE = math.cos(math.radians(25.0))
MAX_SHARE_BELOW = 0.02


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def unit(a):
    """None for a vector without length."""
    length = math.sqrt(dot(a, a))
    return tuple(v / length for v in a) if length > 1e-12 else None


def fit_floor(points, rough_up, tolerance_m=0.02):
    """(up, offset, share): up . p = offset on the floor, share of the points on it. None when there is no floor.

    rough_up: unit vector; the floor's normal is at most 25 deg away from it. The same every time.
    """
    if len(points) < 3:
        return None
    rng = random.Random(1)
    sample = points[:: max(1, len(points) // SAMPLE)]
    cells = {}
    for p in sample:
        cells.setdefault(tuple(int(v // CELL_M) for v in p), []).append(p)
    best = None
    for _ in range(HYPOTHESES):
        plane = _hypothesis(sample, cells, rng, rough_up)
        if plane is None:
            continue
        up, offset = _refit(sample, *plane, 2.0 * tolerance_m)
        num_on, num_below = _count(sample, up, offset, tolerance_m)
        if num_below <= MAX_SHARE_BELOW * len(sample) and (best is None or num_on > best[0]):
            best = (num_on, up, offset)
    if best is None or best[0] < 0.02 * len(sample):
        return None
    _, up, offset = best
    for _ in range(3):
        up, offset = _refit(points, up, offset, tolerance_m)
    num_on, _ = _count(points, up, offset, tolerance_m)
    return up, offset, num_on / len(points)


def _hypothesis(sample, cells, rng, rough_up):
    """(up, offset) through three points of one cell: on a floor that is a small part of the view three points from
    anywhere would hardly ever meet."""
    cell = cells[tuple(int(v // CELL_M) for v in sample[int(rng.random() * len(sample))])]
    a, b, c = (cell[int(rng.random() * len(cell))] for _ in range(3))
    normal = unit(cross(minus(b, a), minus(c, a)))
    if normal is None or abs(dot(normal, rough_up)) < MAX_TILT_COSINE:
        return None
    if dot(normal, rough_up) < 0.0:
        normal = tuple(-v for v in normal)
    return normal, dot(normal, a)


def _count(points, up, offset, tolerance_m):
    """Points on the plane, and points clearly beneath it."""
    ux, uy, uz = up
    num_on = num_below = 0
    for x, y, z in points:
        height = ux * x + uy * y + uz * z - offset
        if height < -3.0 * tolerance_m:
            num_below += 1
        elif -tolerance_m <= height <= tolerance_m:
            num_on += 1
    return num_on, num_below


def _refit(points, up, offset, tolerance_m):
    """Least squares of the height over the plane's own axes."""
    e1 = unit(cross(up, (1.0, 0.0, 0.0) if abs(up[0]) < 0.7 else (0.0, 1.0, 0.0)))
    e2 = cross(up, e1)
    suu = suv = svv = su = sv = sh = suh = svh = n = 0.0
    for p in points:
        h = dot(up, p) - offset
        if abs(h) > tolerance_m:
            continue
        u, v = dot(e1, p), dot(e2, p)
        n, su, sv, sh = n + 1.0, su + u, sv + v, sh + h
        suu, suv, svv, suh, svh = suu + u * u, suv + u * v, svv + v * v, suh + u * h, svh + v * h
    if n < 3.0:
        return up, offset
    mu, mv, mh = su / n, sv / n, sh / n
    cuu, cuv, cvv = suu / n - mu * mu, suv / n - mu * mv, svv / n - mv * mv
    cuh, cvh = suh / n - mu * mh, svh / n - mv * mh
    determinant = cuu * cvv - cuv * cuv
    if determinant < 1e-12:
        return up, offset
    a = (cuh * cvv - cvh * cuv) / determinant
    b = (cvh * cuu - cuh * cuv) / determinant
    # height = mh + a (u - mu) + b (v - mv): the normal leans against the slope.
    normal = tuple(up[i] - a * e1[i] - b * e2[i] for i in range(3))
    length = math.sqrt(dot(normal, normal))
    return tuple(v / length for v in normal), (offset + mh - a * mu - b * mv) / length
