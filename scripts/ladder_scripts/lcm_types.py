# SPDX-License-Identifier: BSD-3-Clause
"""Our message types as the .lcm files say them: fields, bounds, fingerprint. Read by the generator of the wire guard
(cmake/wire_tables.py) and by the log tools.

A strict subset of the LCM language, the one our house rules allow; anything else is an error with file and line: one
struct per file, named like the file; primitive fields; arrays of one dimension, sized by a number or by an earlier
int32_t field; the bound of every count num_xs is a constant MAX_XS and the bound of every string s a constant
MAX_S_BYTES of the same type. No nested types: messages are flat, parallel arrays.
"""

import re
from dataclasses import dataclass

SIZE_BYTES = {"boolean": 1, "byte": 1, "int8_t": 1, "int16_t": 2, "int32_t": 4, "int64_t": 8, "float": 4, "double": 8}
PACKAGE = "ladder_msgs"
MAX_FIELDS = 128  # as in runtime/wire_guard.cpp

PACKAGE_LINE = re.compile(r"package\s+(\w+)\s*;")
STRUCT_LINE = re.compile(r"struct\s+(\w+)")
CONST_LINE = re.compile(r"const\s+(int8_t|int16_t|int32_t|int64_t)\s+([A-Z]\w*)\s*=\s*(-?\d+)\s*;")
FIELD_LINE = re.compile(r"([a-z]\w*)\s+([a-z]\w*)\s*(?:\[\s*(\w+)\s*\])?\s*;")


class LcmError(Exception):
    """Something outside the subset; the text names file and line."""


@dataclass
class Field:
    kind: str  # name of the primitive type, or "string"
    name: str
    fixed: int = 1  # number of elements unless count_index says otherwise
    count_index: int = -1  # index of the field that holds the number of elements
    is_array: bool = False
    limit: int = -1  # highest value of a count, longest string in bytes


@dataclass
class Type:
    name: str
    fields: list
    constants: dict

    def find(self, name):
        return next((i for i, field in enumerate(self.fields) if field.name == name), -1)

    def arrays_of(self, count_index):
        return [field for field in self.fields if field.count_index == count_index]


def parse(path):
    """Reads one .lcm file; LcmError for anything outside the subset."""
    message = Type("", [], {})
    state = "package"
    for number, raw in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        line = raw.split("//", 1)[0].strip()
        if not line:
            continue

        def fail(reason, number=number, line=line):
            raise LcmError(f"{path}:{number}: {reason}: '{line}'")

        if state == "package":
            match = PACKAGE_LINE.fullmatch(line) or fail(f"expected 'package {PACKAGE};'")
            if match[1] != PACKAGE:
                fail(f"the package must be {PACKAGE}")
            state = "struct"
        elif state == "struct":
            match = STRUCT_LINE.fullmatch(line) or fail("expected 'struct <name>'")
            message.name = match[1]
            if message.name != path.stem:
                fail(f"a file holds one struct named like the file ({path.stem})")
            state = "open"
        elif state == "open":
            if line != "{":
                fail("expected '{' on a line of its own")
            state = "body"
        elif state == "body" and line == "}":
            state = "done"
        elif state == "body":
            parse_member(message, line, fail)
        else:
            fail("nothing may follow the struct")
    if state != "done":
        raise LcmError(f"{path}: ends before the struct does")
    bound(message, path)
    return message


def parse_member(message, line, fail):
    """One constant or one field."""
    match = CONST_LINE.fullmatch(line)
    if match:
        message.constants[match[2]] = int(match[3])
        return
    match = FIELD_LINE.fullmatch(line) or fail("neither an integer constant nor a field with at most one dimension")
    kind, name, dimension = match.groups()
    if kind not in SIZE_BYTES and kind != "string":
        fail(f"'{kind}' is not a primitive type (LCM has no unsigned ones, and messages are not nested)")
    if message.find(name) >= 0:
        fail(f"'{name}' is there twice")
    field = Field(kind, name, is_array=dimension is not None)
    if dimension is not None and kind == "string":
        fail("no arrays of strings")
    if dimension is not None and dimension.isdigit():
        field.fixed = int(dimension)
        if field.fixed < 1:
            fail("an array has at least one element")
    elif dimension is not None:
        field.count_index = message.find(dimension)
        if field.count_index < 0 or message.fields[field.count_index].is_array:
            fail(f"'{dimension}' is not an earlier field")
        if message.fields[field.count_index].kind != "int32_t":
            fail(f"the count '{dimension}' must be an int32_t")
    message.fields.append(field)


def bound(message, path):
    """Finds MAX_* for each count and each string."""
    if len(message.fields) > MAX_FIELDS:
        raise LcmError(f"{path}: {len(message.fields)} fields, more than {MAX_FIELDS}")
    for index, field in enumerate(message.fields):
        if field.kind == "string":
            constant = f"MAX_{field.name.upper()}_BYTES"
        elif message.arrays_of(index):
            if not field.name.startswith("num_"):
                raise LcmError(f"{path}: the count '{field.name}' must be named num_*")
            constant = f"MAX_{field.name[4:].upper()}"
        else:
            continue
        if constant not in message.constants:
            raise LcmError(f"{path}: '{field.name}' has no bound: add 'const int32_t {constant} = ...;'")
        field.limit = message.constants[constant]
        if not 0 < field.limit < 2**31:
            raise LcmError(f"{path}: {constant} must be in 1 .. 2^31-1")


def max_bytes(message):
    """Encoded size of the largest message within the bounds, fingerprint included."""
    total = 8
    for field in message.fields:
        if field.kind == "string":
            total += 4 + field.limit + 1
        elif field.count_index >= 0:
            total += SIZE_BYTES[field.kind] * message.fields[field.count_index].limit
        else:
            total += SIZE_BYTES[field.kind] * field.fixed
    if total >= 2**31:
        raise LcmError(f"{message.name}: up to {total} bytes, more than LCM can carry")
    return total


def fingerprint(message):
    """LCM's hash of a type without nested types (lcmgen.c: lcm_struct_hash), rotated as in getHash()."""

    def update(value, byte):
        signed_byte = byte - 256 if byte > 127 else byte
        shifted = ((value << 8) ^ ((value - (1 << 64) if value >> 63 else value) >> 55)) & (2**64 - 1)
        return (shifted + signed_byte) & (2**64 - 1)

    def update_string(value, text):
        value = update(value, len(text))
        for byte in text.encode():
            value = update(value, byte)
        return value

    value = 0x12345678
    for field in message.fields:
        value = update_string(value, field.name)
        value = update_string(value, field.kind)
        value = update(value, 1 if field.is_array else 0)
        if field.is_array:
            is_counted = field.count_index >= 0
            value = update(value, 1 if is_counted else 0)
            size = message.fields[field.count_index].name if is_counted else str(field.fixed)
            value = update_string(value, size)
    return ((value << 1) + (value >> 63)) & (2**64 - 1)
