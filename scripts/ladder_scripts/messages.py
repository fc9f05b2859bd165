# SPDX-License-Identifier: BSD-3-Clause
"""Messages read by the tables of lcm_types, without lcm-gen's codecs: is one whole, and what does it say.

The same judgement as runtime/wire_guard: fingerprint, counts within their bounds, strings with their NUL, exact end. An
array's elements are not judged: a flipped bit in a depth image cannot be seen."""

import pathlib
import struct

from ladder_scripts import lcm_types

INTEGER_32 = struct.Struct(">i")
CODE = {"boolean": "?", "byte": "B", "int8_t": "b", "int16_t": "h", "int32_t": "i", "int64_t": "q", "float": "f", "double": "d"}


def load_types(folder):
    """Fingerprint as 8 bytes -> type, of every .lcm file in the folder."""
    types = [lcm_types.parse(path) for path in sorted(pathlib.Path(folder).glob("*.lcm"))]
    return {lcm_types.fingerprint(message_type).to_bytes(8, "big"): message_type for message_type in types}


def type_of(types, message):
    """The type with this message's fingerprint, or None."""
    return types.get(bytes(message[:8]))


def _layout(message_type, message):
    """Yields (field, first byte, number of elements); raises ValueError where the message breaks its type's rules."""
    at = 8
    counts = {}
    for index, field in enumerate(message_type.fields):
        if field.kind == "string":
            if at + 4 > len(message):
                raise ValueError(f"ends before '{field.name}'")
            size = INTEGER_32.unpack_from(message, at)[0]
            at += 4
            if not 1 <= size <= field.limit + 1 or at + size > len(message) or message[at + size - 1] != 0:
                raise ValueError(f"'{field.name}' is no string")
            yield field, at, size
            at += size
            continue
        elements = counts[field.count_index] if field.count_index >= 0 else field.fixed
        size = elements * lcm_types.SIZE_BYTES[field.kind]
        if at + size > len(message):
            raise ValueError(f"ends within '{field.name}'")
        if field.limit >= 0:
            counts[index] = INTEGER_32.unpack_from(message, at)[0]
            if not 0 <= counts[index] <= field.limit:
                raise ValueError(f"'{field.name}' is {counts[index]}")
        yield field, at, elements
        at += size
    if at != len(message):
        raise ValueError(f"{len(message) - at} bytes too many")


def fault_of(message_type, message):
    """'' or what is wrong with a message of this type."""
    try:
        for _ in _layout(message_type, message):
            pass
    except ValueError as error:
        return f"{message_type.name}: {error}"
    return ""


def decode(message_type, message):
    """Field name -> number, text, or tuple of numbers, in the order of the type."""
    values = {}
    for field, at, elements in _layout(message_type, message):
        if field.kind == "string":
            values[field.name] = bytes(message[at : at + elements - 1]).decode("utf-8", "replace")
        else:
            numbers = struct.unpack_from(f">{elements}{CODE[field.kind]}", message, at)
            values[field.name] = numbers if field.is_array else numbers[0]
    return values
