#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes what the page must know of the message types, from the .lcm files: fields in their order, constants, channels.

    write_messages.py OUT.js

OUT.js   export const TYPES = {"<fingerprint as hex>": {name, fields: [[name, kind, fixed, index of the count or -1], ...]}}
         export const health_t = {SERVICE_SENSOR: 1, ...}, and so on for each type: its constants
"""

import json
import pathlib
import sys

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from ladder_scripts.lcm_types import fingerprint, parse  # noqa: E402


def main():
    messages = [parse(path) for path in sorted((ROOT / "lcmtypes").glob("*.lcm"))]
    text = "// SPDX-License-Identifier: BSD-3-Clause\n// Written by viewer/web/write_messages.py from lcmtypes/*.lcm; do not edit.\n"
    text += "export const TYPES = {\n"
    for message in messages:
        fields = [[field.name, field.kind, field.fixed if field.is_array and field.count_index < 0 else 0, field.count_index]
                  for field in message.fields]
        text += f'  "{fingerprint(message):016x}": {json.dumps({"name": message.name, "fields": fields})},\n'
    text += "};\n"
    for message in messages:
        text += f"export const {message.name} = {json.dumps(message.constants)};\n"
    out = pathlib.Path(sys.argv[1])
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
