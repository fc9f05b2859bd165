#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""ladder-doctor on the kernel's devices: faults of CAN, GPIO, clock and buffers, each made in the virtual machine and found.

    doctor_test.py FOLDER_OF_SERVICES"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

DOCTOR = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "ladder-doctor"


def run(command):
    subprocess.run(command.split(), check=True)


@unittest.skipUnless(os.environ.get("LADDER_VM"), "runs in scripts/vm alone: it takes devices down and sets the clock")
class Devices(unittest.TestCase):
    def found(self, checks, text=""):
        """What the doctor says of these checks with this configuration: {check: [(level, what)]}."""
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write(text)
            file.flush()
            got = subprocess.run([sys.executable, DOCTOR, "--json", "--only", checks, "--config", file.name, "--programs", SERVICES, "--seconds", "0.1"],
                                 capture_output=True, text=True, check=False)
        findings = json.loads(got.stdout)
        faults = [finding for finding in findings if finding["level"] == "FAULT"]
        self.assertEqual(got.returncode, 1 if faults else 0)
        return [finding["what"] for finding in faults]

    def test_can(self):
        """A bus that is up and stays off after bus-off is fine; automatic restart, down and missing are faults."""
        vcan, controller = '[climb.can]\ninterface = "vcan0"\n', '[climb.can]\ninterface = "can0"\n'
        self.assertEqual(self.found("can", vcan), [])
        run("ip link set vcan0 down")
        self.assertEqual(self.found("can", vcan), ["vcan0 is down"])
        run("ip link set vcan0 up")
        run("ip link set can0 down")
        run("ip link set can0 type can bitrate 1000000 restart-ms 100")
        said = self.found("can", controller)
        self.assertEqual(said[0], "can0 is down")
        self.assertIn("restarts by itself after 100 ms", said[1])
        run("ip link set can0 type can restart-ms 0")
        run("ip link set can0 up")
        self.assertEqual(self.found("can", controller), [])
        self.assertEqual(self.found("can", '[climb.can]\ninterface = "can7"\n'), ["there is no interface can7"])
        self.assertIn("no CAN interface", self.found("can", '[climb.can]\ninterface = "lo"\n')[0])

    def test_lines(self):
        """All five lines are found on the chip; another name is missed, as is another chip."""
        self.assertEqual(self.found("lines"), [])
        self.assertIn("no line 'BUTTON' (climb.lines.estop)", self.found("lines", '[climb.lines]\nestop = "BUTTON"\n')[0])
        self.assertIn("no GPIO chip 'other' (there: ladder-gpio)", self.found("lines", '[climb.lines]\nchip = "other"\n')[0])

    def test_clock_and_buffers(self):
        """A clock that stands at 1999, and Debian's own buffers."""
        self.assertEqual(self.found("clock,buffers"), [])
        until_now = time.time() - time.monotonic()
        run("date -s 1999-12-31")
        run("sysctl -qw net.core.rmem_max=212992 net.core.rmem_default=212992")
        said = self.found("clock,buffers")
        run("sysctl -qw net.core.rmem_max=8388608 net.core.rmem_default=8388608")
        run(f"date -s @{until_now + time.monotonic():.3f}")
        self.assertEqual(len(said), 3)
        self.assertIn("rmem_max is 212992", said[0])
        self.assertIn("the clock says 1999-12-31: it was never set", said[2])


if __name__ == "__main__":
    SERVICES = sys.argv.pop(1)
    unittest.main(verbosity=2)
