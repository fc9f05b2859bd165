# SPDX-License-Identifier: BSD-3-Clause
"""Reads point clouds in the PCD format, version 0.7: ascii, binary and binary_compressed. Only x, y and z are kept.

Damaged or foreign files raise PcdError, which says what is wrong.
"""

import array
import dataclasses
import math
import struct
import sys

KEYWORDS = ("VERSION", "FIELDS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA")
MAX_POINTS = 50_000_000


class PcdError(Exception):
    """Not a PCD file that this reader understands."""


@dataclasses.dataclass
class Cloud:
    """x, y, z in metres, parallel, width * height long, row by row; NaN where a pixel saw nothing."""

    width: int
    height: int
    x: array.array
    y: array.array
    z: array.array

    @property
    def is_organised(self):
        return self.height > 1


def read_pcd(data):
    """The cloud in these bytes."""
    header, body = _split(data)
    fields = _fields(header)
    width, height = _one_int(header, "WIDTH"), _one_int(header, "HEIGHT")
    num_points = _one_int(header, "POINTS") if "POINTS" in header else width * height
    if width * height != num_points:
        raise PcdError(f"WIDTH {width} x HEIGHT {height} is not POINTS {num_points}")
    if not 0 < num_points <= MAX_POINTS:
        raise PcdError(f"{num_points} points; 1 to {MAX_POINTS} can be read")
    kind = header["DATA"][0].lower()
    readers = {"ascii": _ascii, "binary": _binary, "binary_compressed": _compressed}
    if kind not in readers:
        raise PcdError(f"DATA {kind} is unknown")
    return Cloud(width, height, *readers[kind](body, fields, num_points))


def _split(data):
    """Header as keyword -> values, and the bytes behind its DATA line."""
    header = {}
    at = 0
    while "DATA" not in header:
        end = data.find(b"\n", at)
        if end < 0 or end - at > 10000:
            raise PcdError("the header has no DATA line: this is not a PCD file")
        try:
            words = data[at:end].decode("ascii").split()
        except UnicodeDecodeError:
            raise PcdError("the header is not text: this is not a PCD file") from None
        at = end + 1
        if not words or words[0].startswith("#"):
            continue
        if words[0] not in KEYWORDS:
            raise PcdError(f"unknown header line '{words[0]}'")
        if len(words) < 2:
            raise PcdError(f"header line {words[0]} has no value")
        header[words[0]] = words[1:]
    for keyword in ("VERSION", "FIELDS", "SIZE", "TYPE", "WIDTH", "HEIGHT"):
        if keyword not in header:
            raise PcdError(f"the header lacks {keyword}")
    if header["VERSION"][0] not in ("0.7", ".7"):
        raise PcdError(f"VERSION {header['VERSION'][0]} is not 0.7")
    return header, data[at:]


def _one_int(header, keyword):
    try:
        return int(header[keyword][0])
    except ValueError:
        raise PcdError(f"{keyword} {header[keyword][0]} is not a whole number") from None


@dataclasses.dataclass
class _Field:
    name: str
    size: int
    kind: str
    count: int
    offset: int  # bytes from the start of a point
    column: int  # words from the start of a line


def _fields(header):
    try:
        sizes = [int(word) for word in header["SIZE"]]
        counts = [int(word) for word in header.get("COUNT", ["1"] * len(sizes))]
    except ValueError:
        raise PcdError("SIZE and COUNT are whole numbers") from None
    names, kinds = header["FIELDS"], header["TYPE"]
    if not len(names) == len(sizes) == len(kinds) == len(counts):
        raise PcdError("FIELDS, SIZE, TYPE and COUNT have different lengths")
    fields, offset, column = [], 0, 0
    for name, size, kind, count in zip(names, sizes, kinds, counts):
        if size not in (1, 2, 4, 8) or count < 1 or kind not in "FUI":
            raise PcdError(f"field {name}: TYPE {kind} SIZE {size} COUNT {count} is not possible")
        fields.append(_Field(name, size, kind, count, offset, column))
        offset += size * count
        column += count
    for axis in "xyz":
        found = [field for field in fields if field.name == axis]
        if len(found) != 1 or found[0].kind != "F" or found[0].count != 1 or found[0].size < 4:
            raise PcdError(f"there must be one field {axis} of TYPE F and SIZE 4 or 8")
    return fields


def _axes(fields):
    return [next(field for field in fields if field.name == axis) for axis in "xyz"]


def _ascii(body, fields, num_points):
    words_per_line = sum(field.count for field in fields)
    columns = [field.column for field in _axes(fields)]
    axes = [array.array("d") for _ in columns]
    lines = [line for line in body.splitlines() if line.strip()]
    if len(lines) != num_points:
        raise PcdError(f"{len(lines)} lines of points instead of {num_points}")
    for number, line in enumerate(lines):
        words = line.split()
        if len(words) != words_per_line:
            raise PcdError(f"point {number} has {len(words)} values instead of {words_per_line}")
        try:
            for axis, column in zip(axes, columns):
                axis.append(float(words[column]))
        except ValueError:
            raise PcdError(f"point {number}: '{words[column].decode(errors='replace')}' is not a number") from None
    return axes


def _binary(body, fields, num_points):
    stride = sum(field.size * field.count for field in fields)
    if len(body) < stride * num_points:
        raise PcdError(f"{len(body)} bytes of points instead of {stride * num_points}: cut short")
    body = body[: stride * num_points]
    axes = []
    for field in _axes(fields):
        before, behind = field.offset, stride - field.offset - field.size
        one = struct.Struct(f"<{before}x{'f' if field.size == 4 else 'd'}{behind}x")
        axes.append(array.array("d", (value for (value,) in one.iter_unpack(body))))
    return axes


def _compressed(body, fields, num_points):
    if len(body) < 8:
        raise PcdError("the sizes of the compressed block are missing: cut short")
    packed, unpacked = struct.unpack_from("<II", body)
    stride = sum(field.size * field.count for field in fields)
    if unpacked != stride * num_points:
        raise PcdError(f"the compressed block holds {unpacked} bytes instead of {stride * num_points}")
    if len(body) - 8 < packed:
        raise PcdError(f"{len(body) - 8} compressed bytes instead of {packed}: cut short")
    columns = lzf_decompress(body[8 : 8 + packed], unpacked)
    axes = []
    for field in _axes(fields):
        start = field.offset * num_points
        values = array.array("f" if field.size == 4 else "d")
        values.frombytes(columns[start : start + field.size * num_points])
        if sys.byteorder == "big":
            values.byteswap()
        axes.append(values)
    return axes


def lzf_decompress(packed, size):
    """LibLZF's format: a control byte below 32 announces that many + 1 literal bytes, another one a repetition."""
    out = bytearray()
    at = 0
    try:
        while at < len(packed):
            control = packed[at]
            at += 1
            if control < 32:
                literal = packed[at : at + control + 1]
                if len(literal) != control + 1:
                    raise IndexError
                out += literal
                at += control + 1
                continue
            length = control >> 5
            if length == 7:
                length += packed[at]
                at += 1
            length += 2
            distance = ((control & 31) << 8) + packed[at] + 1
            at += 1
            start = len(out) - distance
            if start < 0:
                raise PcdError("the compressed block repeats bytes before its beginning")
            chunk = out[start : start + length]
            while len(chunk) < length:
                chunk += chunk[: length - len(chunk)]
            out += chunk
            if len(out) > size:
                break
    except IndexError:
        raise PcdError("the compressed block ends within a token") from None
    if len(out) != size:
        raise PcdError(f"the compressed block unpacks to {len(out)} bytes or more instead of {size}")
    return bytes(out)


def finite_points(cloud):
    """Those (x, y, z) that are numbers."""
    isfinite = math.isfinite
    return [p for p in zip(cloud.x, cloud.y, cloud.z) if isfinite(p[0]) and isfinite(p[1]) and isfinite(p[2])]
