#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""canmatrix and the C++ codec agree on config/leg_servos.dbc, both ways, through candump logs.
usage: dbc_test.py FRAME_TOOL leg_servos.dbc"""
import contextlib
import io
import pathlib
import random
import re
import subprocess
import sys
import unittest

try:
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        import canmatrix
        import canmatrix.formats
except ImportError:
    print("SKIPPED can_dbc_test: python3-canmatrix is not installed (scripts/setup)")
    sys.exit(77)

NUM_FRAMES = 4000


def run(*arguments, text=""):
    done = subprocess.run([TOOL, *arguments], input=text, capture_output=True, text=True, check=True)
    return done.stdout.splitlines()


def values(text):
    return {name: int(value) for name, value in (pair.split("=") for pair in text.split())}


def frame_of(identifier):
    return MATRIX.frame_by_id(canmatrix.ArbitrationId(identifier, extended=False))


class Dbc(unittest.TestCase):
    def test_every_frame_of_the_contract_is_described(self):
        """Six frames for each of sixteen axes, four claws, NMT, SYNC, master heartbeat; lengths as in the contract."""
        sizes = {0x080: 8, 0x180: 8, 0x200: 8, 0x280: 7, 0x300: 8, 0x700: 1}
        for node in range(1, 17):
            for function, size in sizes.items():
                self.assertEqual(frame_of(function + node).size, size, hex(function + node))
        for identifier, size in {0x000: 2, 0x080: 0, 0x1A1: 6, 0x1A4: 6, 0x77F: 1}.items():
            self.assertEqual(frame_of(identifier).size, size, hex(identifier))
        self.assertEqual(len(MATRIX.frames), 16 * 6 + 4 + 3)

    def test_canmatrix_decodes_what_cpp_encodes(self):
        lines = run("encode", str(NUM_FRAMES), "11")
        self.assertEqual(len(lines), NUM_FRAMES)
        worst = 0
        for line in lines:
            log, told = line.split(" | ")
            match = re.fullmatch(r"\(\d+\.\d{6}\) can0 ([0-9A-F]{3})#((?:[0-9A-F]{2})*)", log)
            self.assertTrue(match, log)
            decoded = frame_of(int(match[1], 16)).decode(bytes.fromhex(match[2]))
            expected = values(told)
            self.assertEqual(set(decoded), set(expected), log)
            worst = max([worst] + [abs(decoded[name].raw_value - expected[name]) for name in expected])
        self.assertLessEqual(worst, 0, "in units of the last place")

    def test_cpp_decodes_what_canmatrix_encodes(self):
        rng = random.Random(12)
        frames = [frame for frame in MATRIX.frames if frame.signals]
        log, expected = [], []
        while len(log) < NUM_FRAMES:
            frame = rng.choice(frames)
            raw = {}
            for signal in frame.signals:
                low, high = (-(1 << signal.size - 1), (1 << signal.size - 1) - 1) if signal.is_signed else (0, (1 << signal.size) - 1)
                known = sorted(int(value) for value in signal.values)
                raw[signal.name] = rng.choice(known) if known else rng.choice([low, high, rng.randint(low, high)])
            if "nmt_node" in raw:
                raw["nmt_node"] %= 128
            payload = frame.encode(raw)  # canmatrix 0.9.5 takes raw values here
            log.append(f"(1700000000.000000) can0 {frame.arbitration_id.id:03X}#{payload.hex().upper()}")
            expected.append(raw)
        decoded = run("decode", text="\n".join(log) + "\n")
        self.assertEqual(len(decoded), NUM_FRAMES)
        for line, raw, sent in zip(decoded, expected, log):
            told = values(line.split(" ", 1)[1])
            self.assertEqual(set(told), set(raw), sent)
            for name, value in raw.items():
                self.assertLessEqual(abs(told[name] - value), 1, f"{sent} {name}")


if __name__ == "__main__":
    TOOL, dbc = sys.argv[1], pathlib.Path(sys.argv[2])
    with contextlib.redirect_stderr(io.StringIO()):
        MATRIX = canmatrix.formats.loadp_flat(str(dbc))
    unittest.main(argv=sys.argv[:1], verbosity=1)
