#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""unpack_kernel.py VMLINUZ OUT: the plain kernel inside Debian's compressed one, which an emulated machine boots much faster."""
import lzma
import pathlib
import sys

packed = pathlib.Path(sys.argv[1]).read_bytes()
start = packed.find(b"\xfd7zXZ\x00")
if start < 0:
    sys.exit(f"{sys.argv[1]}: no xz stream inside")
plain = lzma.LZMADecompressor().decompress(packed[start:])
if plain[:4] != b"\x7fELF":
    sys.exit(f"{sys.argv[1]}: not an ELF kernel inside")
pathlib.Path(sys.argv[2]).write_bytes(plain)
