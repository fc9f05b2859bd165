# SPDX-License-Identifier: BSD-3-Clause
"""Changes single values of a TOML file and leaves every other byte as it is, comments included."""

import re


class NoSuchKey(Exception):
    """The file has no such line; says which."""


def set_value(text, table, key, value):
    """The text with `key = value` in [table]; the line's comment stays. NoSuchKey where the table or the key is not written out."""
    lines = text.split("\n")
    inside = False
    for i, line in enumerate(lines):
        if header := re.match(r"\s*\[([^\]]+)\]", line):
            inside = header[1].strip() == table
        elif inside and (found := re.match(rf"(\s*{re.escape(key)}\s*=\s*)(\[[^\]]*\]|\"[^\"]*\"|[^#\s]+)(.*)$", line)):
            lines[i] = found[1] + value + found[3]
            return "\n".join(lines)
    raise NoSuchKey(f"no line '{key} = ...' in [{table}]: add it first (config/robot.toml has every one)")
