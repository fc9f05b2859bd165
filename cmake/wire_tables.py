#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes what lcm-gen does not: the wire layout of every message type, for the guards of runtime/wire_guard.h.

    wire_tables.py --out DIR a_t.lcm b_t.lcm ...

DIR/wire_tables.hpp   constexpr descriptor table, fingerprint and size bound of each type
DIR/encode_guard.hpp  encodable(message) and fit_arrays(message) of each type

What it accepts of the LCM language is said in scripts/ladder_scripts/lcm_types.py.
"""

import argparse
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "scripts"))
from ladder_scripts.lcm_types import LcmError, fingerprint, max_bytes, parse  # noqa: E402

HEAD = """// SPDX-License-Identifier: BSD-3-Clause
// Written by cmake/wire_tables.py from lcmtypes/*.lcm; do not edit.
#pragma once

"""


def kind_name(kind):
    return "k" + kind.removesuffix("_t").capitalize()


def wire_tables(messages):
    """The text of wire_tables.hpp."""
    text = HEAD + '#include "runtime/wire_type.h"\n\n'
    text += "namespace ladder_msgs {\n\n"
    text += "".join(f"class {message.name};\n" for message in messages)
    text += "\n}  // namespace ladder_msgs\n\nnamespace runtime {\n"
    for message in messages:
        text += f"\nnamespace wire_fields {{\ninline constexpr WireField {message.name}[] = {{\n"
        for field in message.fields:
            text += f'    {{"{field.name}", WireKind::{kind_name(field.kind)}, {field.fixed}, {field.count_index}, {field.limit}}},\n'
        text += "};\n}  // namespace wire_fields\n"
        text += f"template <>\ninline constexpr WireType kWireTypeOf<ladder_msgs::{message.name}>{{\n"
        text += f'    "{message.name}", 0x{fingerprint(message):016x}U, {max_bytes(message)}, wire_fields::{message.name}}};\n'
    text += "\n/// Every type, in alphabetical order.\ninline constexpr const WireType* kWireTypes[] = {\n"
    text += "".join(f"    &kWireTypeOf<ladder_msgs::{message.name}>,\n" for message in messages)
    text += "};\n\n}  // namespace runtime\n"
    return text


def encode_guard(messages):
    """The text of encode_guard.hpp."""
    text = HEAD + "#include <cstddef>\n#include <string>\n\n"
    text += "".join(f'#include "ladder_msgs/{message.name}.hpp"\n' for message in messages)
    text += """
namespace runtime {

inline bool is_wire_count(std::int32_t count, std::int32_t limit) { return count >= 0 && count <= limit; }
inline bool is_wire_string(const std::string& text, std::size_t limit) {
  return text.size() <= limit && text.find('\\0') == std::string::npos;
}
"""
    for message in messages:
        conditions, fits = [], []
        for index, field in enumerate(message.fields):
            if field.kind == "string":
                conditions.append(f"is_wire_string(m.{field.name}, {field.limit})")
            elif message.arrays_of(index):
                conditions.append(f"is_wire_count(m.{field.name}, {field.limit})")
            elif field.count_index >= 0:
                count = message.fields[field.count_index].name
                conditions.append(f"m.{field.name}.size() == static_cast<std::size_t>(m.{count})")
                fits.append(f"  m.{field.name}.resize(static_cast<std::size_t>(m.{count}));\n")
        text += f"\n/// True when every count fits its vectors and its bound, and every string its bound.\n"
        text += f"inline bool encodable([[maybe_unused]] const ladder_msgs::{message.name}& m) {{\n"
        text += "  return " + " &&\n         ".join(conditions or ["true"]) + ";\n}\n"
        text += f"\n/// lcm-gen's decode leaves the old elements of an array whose count is 0; this drops them.\n"
        text += f"inline void fit_arrays([[maybe_unused]] ladder_msgs::{message.name}& m) {{\n" + "".join(fits) + "}\n"
    return text + "\n}  // namespace runtime\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("files", type=Path, nargs="+")
    arguments = parser.parse_args()
    try:
        messages = sorted((parse(path) for path in arguments.files), key=lambda message: message.name)
        outputs = {"wire_tables.hpp": wire_tables(messages), "encode_guard.hpp": encode_guard(messages)}
    except LcmError as error:
        print(error, file=sys.stderr)
        return 1
    arguments.out.mkdir(parents=True, exist_ok=True)
    for name, text in outputs.items():
        (arguments.out / name).write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
