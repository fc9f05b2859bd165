#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""tshark reads the candump log of a whole run as CANopen: every frame labelled, none malformed, each service present.
usage: tshark_test.py FRAME_TOOL"""
import collections
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

FIELDS = ["_ws.col.Protocol", "canopen.function_code", "_ws.malformed", "_ws.col.Info"]
# Function codes (identifier >> 7) of the services that a run must contain. SYNC and EMCY share theirs.
SERVICES = {"NMT": 0x0, "SYNC, EMCY": 0x1, "TPDO1": 0x3, "RPDO1": 0x4, "SDO answer": 0xB, "SDO request": 0xC, "heartbeat": 0xE}


class Tshark(unittest.TestCase):
    def test_run_is_canopen_with_nothing_malformed(self):
        log = subprocess.run([TOOL, "run"], capture_output=True, text=True, check=True).stdout
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "run.log"
            path.write_text(log)
            command = ["tshark", "-r", str(path), "-d", "can.subdissector,canopen", "-T", "fields"]
            for field in FIELDS:
                command += ["-e", field]
            done = subprocess.run(command, capture_output=True, text=True, check=True)
        rows = [line.split("\t") for line in done.stdout.splitlines()]
        self.assertEqual(len(rows), len(log.splitlines()))
        self.assertGreater(len(rows), 4000)
        self.assertEqual({row[0] for row in rows}, {"CANopen"})
        self.assertEqual([row for row in rows if row[2] or "alformed" in row[3]], [])
        counts = collections.Counter(int(row[1], 16) for row in rows)
        for name, code in SERVICES.items():
            self.assertGreater(counts[code], 0, name)
        for word in ("SYNC", "EMCY"):
            self.assertTrue(any(row[3].startswith(word) for row in rows), word)
        self.assertEqual(sum(counts.values()), sum(counts[code] for code in SERVICES.values()))


if __name__ == "__main__":
    if shutil.which("tshark") is None:
        print("SKIPPED can_tshark_test: tshark is not installed (scripts/setup)")
        sys.exit(77)
    TOOL = sys.argv[1]
    unittest.main(argv=sys.argv[:1], verbosity=1)
