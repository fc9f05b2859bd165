#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The generator refuses what lies outside its subset of the LCM language, and says where and why."""

import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "cmake"))
sys.dont_write_bytecode = True
import wire_tables  # noqa: E402


def parse(body, name="a_t", head="package ladder_msgs;\nstruct a_t\n{\n"):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / f"{name}.lcm"
        path.write_text(head + body + "\n}\n", encoding="utf-8")
        return wire_tables.parse(path)


class Subset(unittest.TestCase):
    def refused(self, reason, *arguments, **options):
        with self.assertRaisesRegex(wire_tables.LcmError, reason):
            parse(*arguments, **options)

    def test_outside_the_subset(self):
        """Each construct that our messages must not use is refused with its reason and line."""
        self.refused(r"a_t\.lcm:4: 'uint16_t' is not a primitive type", "uint16_t x;")
        self.refused("'point_t' is not a primitive type", "point_t p;")
        self.refused("at most one dimension", "float x_m[3][4];")
        self.refused("no arrays of strings", "string names[3];")
        self.refused("at least one element", "float x_m[0];")
        self.refused("'num_x' is not an earlier field", "float x_m[num_x];\nint32_t num_x;")
        self.refused("must be an int32_t", "int16_t num_x;\nfloat x_m[num_x];\nconst int32_t MAX_X = 1;")
        self.refused("must be named num_", "int32_t n;\nfloat x_m[n];\nconst int32_t MAX_N = 1;")
        self.refused("add 'const int32_t MAX_X = ...;'", "int32_t num_x;\nfloat x_m[num_x];")
        self.refused("add 'const int32_t MAX_TEXT_BYTES = ...;'", "string text;")
        self.refused("MAX_X must be in 1", "int32_t num_x;\nfloat x_m[num_x];\nconst int32_t MAX_X = -1;")
        self.refused("is there twice", "int8_t x;\nint8_t x;")
        self.refused("neither an integer constant nor a field", "const double G = 9.81;")
        self.refused("neither an integer constant nor a field", "int8_t x, y;")
        self.refused("neither an integer constant nor a field", "/* int8_t x; */")
        self.refused("named like the file", "int8_t x;", name="b_t")
        self.refused("nothing may follow", "int8_t x;\n}\nstruct b_t\n{")
        self.refused("the package must be", "int8_t x;", head="package other;\nstruct a_t\n{\n")
        self.refused("expected 'package", "int8_t x;", head="struct a_t\n{\n")
        self.refused("more than 128", "\n".join(f"int8_t x{i};" for i in range(129)))

    def test_too_large(self):
        """A type whose largest message LCM could not carry is refused."""
        message = parse("int32_t num_x;\ndouble x_m[num_x];\nconst int32_t MAX_X = 300000000;")
        with self.assertRaisesRegex(wire_tables.LcmError, "more than LCM can carry"):
            wire_tables.max_bytes(message)

    def test_bound(self):
        """max_bytes counts the fingerprint, fixed and counted arrays, strings with length and NUL."""
        message = parse("byte b[3];\nint32_t num_x;\nint16_t x_mm[num_x];\nstring s; // text\n"
                        "const int32_t MAX_X = 10;\nconst int32_t MAX_S_BYTES = 7;")
        self.assertEqual(wire_tables.max_bytes(message), 8 + 3 + 4 + 20 + 4 + 7 + 1)


if __name__ == "__main__":
    unittest.main()
