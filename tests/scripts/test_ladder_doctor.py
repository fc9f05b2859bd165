#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""ladder-doctor finds what is wrong and names the fix. Faults of the network are made in network namespaces of their own; those of CAN,
GPIO, clock and buffers in the virtual machine (tests/hardware/doctor_test.py).

    test_ladder_doctor.py FOLDER_OF_SERVICES"""

import json
import os
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCTOR = ROOT / "scripts" / "ladder-doctor"
sys.path.insert(0, str(ROOT / "scripts"))
from ladder_scripts.doctor import clock, gpio_lines, listener, network, publishers  # noqa: E402
from ladder_scripts.doctor.finding import FAULT, Report  # noqa: E402

GROUP, PORT = "239.255.76.67", 7667
UNSHARE = ["unshare", "--net"] if os.geteuid() == 0 else ["unshare", "--map-root-user", "--net"]
LOOPBACK = "ip link set lo up; ip route add 239.255.76.67/32 dev lo src 127.0.0.1; "


def can_unshare():
    got = subprocess.run([*UNSHARE, "true"], capture_output=True, text=True, check=False)
    return got.returncode == 0


def publish(channel, seconds, size=100):
    """What an LCM program does that sends 50 messages a second; run as a process of its own."""
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    health = struct.pack(">8xqqbbi", time.time_ns() // 1000, 0, 2, 2, os.getpid())
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        message = health if channel == "LADDER_HEALTH" else bytes(size)
        sender.sendto(struct.pack(">II", 0x4C433032, 0) + channel.encode() + b"\0" + message, (GROUP, PORT))
        time.sleep(0.02)


def hold(seconds):
    """A subscriber that never reads."""
    with listener.open_socket(GROUP, PORT) as held:
        held.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        time.sleep(seconds)


def doctor(*arguments, before="", seconds=1.0):
    """Findings of the doctor, run in a network namespace of its own after the shell commands `before`, and its exit code."""
    peer = f"{sys.executable} {pathlib.Path(__file__).resolve()}"
    command = before.replace("PEER", peer) + f"{DOCTOR} --json --seconds {seconds} " + " ".join(arguments) + \
        "; code=$?; kill -KILL $(jobs -p) 2>/dev/null; exit $code"
    environment = {key: value for key, value in os.environ.items() if key != "LCM_DEFAULT_URL"}
    got = subprocess.run([*UNSHARE, "bash", "-c", command], capture_output=True, text=True, check=False, env=environment)
    if not got.stdout:
        raise AssertionError(got.stderr)
    return json.loads(got.stdout), got.returncode


@unittest.skipUnless(can_unshare(), "no network namespaces here: neither as root nor as a user")
class Network(unittest.TestCase):
    def test_nothing_wrong(self):
        """A pinned group, one sender and one reader that reads: no fault, exit 0."""
        findings, code = doctor("--only route,sockets,publishers,clock", before=LOOPBACK + "PEER publish LADDER_CLOUD 4 & sleep 0.3; ")
        self.assertEqual([finding for finding in findings if finding["level"] == FAULT], [])
        self.assertEqual(code, 0)

    def test_missing_route(self):
        """Without a route LCM cannot start; the fix names the command."""
        findings, code = doctor("--only route,publishers", before="ip link set lo up; ")
        self.assertEqual(code, 1)
        self.assertIn("no route to 239.255.76.67", findings[0]["what"])
        self.assertIn("ip route replace 239.255.76.67/32 dev lo", findings[0]["fix"])
        self.assertEqual(findings[1]["level"], FAULT, "and nothing can be heard")

    def test_route_through_a_cable(self):
        """A default route takes the group with it, until it is pinned; between two hosts the cable is what is wanted."""
        cable = "ip link set lo up; ip link add cable type veth peer name far; ip addr add 10.9.8.7/24 dev cable; " \
                "ip link set cable up; ip link set far up; ip route add default dev cable; "
        findings, code = doctor("--only route", before=cable)
        self.assertEqual(code, 1)
        self.assertIn("goes through cable, not lo", findings[0]["what"])
        unsourced, code = doctor("--only route", before=cable + "ip route replace 239.255.76.67/32 dev lo; ")
        self.assertEqual((code, "from the address 10.9.8.7" in unsourced[0]["what"]), (1, True), "pinned, but sent from the cable's address")
        self.assertEqual(doctor("--only route", before=cable + "ip route replace 239.255.76.67/32 dev lo src 127.0.0.1; ")[1], 0)
        self.assertEqual(doctor("--only route --interface cable", before=cable)[1], 0)

    def test_full_socket(self):
        """A stopped subscriber is told with its pid while it loses messages."""
        findings, code = doctor("--only sockets", before=LOOPBACK + "PEER hold 6 & kept=$!; sleep 0.5; PEER publish LADDER_CLOUD 5 & sleep 0.5; kill -STOP $kept; ")
        self.assertEqual(code, 1)
        self.assertRegex(findings[0]["what"], r"socket of python3?[\d.]* \(pid \d+\) is full .* datagrams lost just now")
        self.assertIn("kill -CONT", findings[0]["fix"])

    def test_two_publishers(self):
        """Two senders on one channel, and one service with two processes, are told with their pids."""
        twice = "PEER publish LADDER_TOPOLOGY 4 & PEER publish LADDER_TOPOLOGY 4 & PEER publish LADDER_HEALTH 4 & PEER publish LADDER_HEALTH 4 & sleep 0.5; "
        findings, code = doctor("--only publishers", before=LOOPBACK + twice)
        self.assertEqual(code, 1)
        self.assertRegex(findings[0]["what"], r"LADDER_TOPOLOGY has 2 senders: .*\(pid \d+\), .*\(pid \d+\)")
        self.assertRegex(findings[1]["what"], r"gng_service runs 2 times: pids \d+, \d+")
        self.assertEqual(len(findings), 2, "many senders of LADDER_HEALTH are as it should be")


class Configuration(unittest.TestCase):
    def findings(self, text, programs):
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write(text)
            file.flush()
            got = subprocess.run([DOCTOR, "--json", "--only", "configuration,can,lines", "--config", file.name, "--programs", programs],
                                 capture_output=True, text=True, check=False)
        return json.loads(got.stdout), got.returncode

    def test_wrong_configuration(self):
        """A wrong key, a wrong value and a file that is no TOML are told by the service, with file and line."""
        for text, said in (("[gng]\nnum_nodez = 3\n", "num_nodez"), ("[climb]\nperiod_s = -1.0\n", "period_s"), ("[sensor\n", ":1:")):
            findings, code = self.findings(text, SERVICES)
            with self.subTest(said):
                self.assertEqual(code, 1)
                self.assertIn(said, " ".join(finding["what"] for finding in findings if finding["level"] == FAULT))

    def test_devices_that_are_named(self):
        """A head's device that is not there is told; simulated drives and lines are no fault but never pass unseen."""
        findings, code = self.findings('[sensor]\nsource = "a010"\n[sensor.head_0]\ndevice = "/dev/no_such_head"\nfx_px = 90.0\nfy_px = 90.0\n'
                                       '[climb.can]\ninterface = "unix:/tmp/can"\n[climb.lines]\nchip = "unix:/tmp/lines"\n', SERVICES)
        said = {finding["check"]: finding for finding in findings}
        self.assertIn("no /dev/no_such_head", " ".join(finding["what"] for finding in findings))
        self.assertEqual((code, said["can"]["level"], said["lines"]["level"]), (1, "warning", "warning"))

    def test_missing_programs(self):
        """Services that are not installed are a fault of their own."""
        with tempfile.TemporaryDirectory() as empty:
            findings, code = self.findings("", empty)
        self.assertEqual(code, 1)
        self.assertEqual(sum("is not there" in finding["what"] for finding in findings), 4)


class Parts(unittest.TestCase):
    """Single judgements, on made-up input."""

    def judged(self, check, *arguments):
        report = Report("check")
        check(report, *arguments)
        return [finding.what for finding in report.findings if finding.level == FAULT]

    def test_buffers(self):
        """Debian's stock buffers are too small, each by name."""
        with tempfile.TemporaryDirectory() as proc:
            folder = pathlib.Path(proc) / "sys/net/core"
            folder.mkdir(parents=True)
            for key in ("rmem_max", "rmem_default"):
                (folder / key).write_text("212992\n")
            said = self.judged(network.check_buffers, pathlib.Path(proc))
        self.assertEqual(["rmem_max is 212992" in said[0], "rmem_default is 212992" in said[1]], [True, True])

    def test_a_restart_is_no_second_sender(self):
        """A sender that comes back under another port is one sender; two that alternate are two."""
        a, b = ("127.0.0.1", 1000), ("127.0.0.1", 2000)
        self.assertFalse(publishers.is_interleaved([]))
        self.assertFalse(publishers.is_interleaved([a]))
        self.assertFalse(publishers.is_interleaved([a, b]))
        self.assertTrue(publishers.is_interleaved([a, b, a]))

    def test_odd_datagrams(self):
        """What is no beginning of an LCM message is passed over."""
        for datagram in (b"", b"LC02", b"x" * 100, b"LC02\0\0\0\0" + b"A" * 64, b"LC03" + bytes(12) + b"\0\1" + b"\0\2" + b"A\0"):
            self.assertIsNone(listener.begin_of_message(datagram))
        self.assertEqual(listener.begin_of_message(b"LC02\0\0\0\0A\0xy"), ("A", b"xy"))
        self.assertEqual(listener.begin_of_message(b"LC03" + bytes(12) + b"\0\0\0\2" + b"A\0xy"), ("A", b"xy"))

    def test_clock(self):
        """A clock that was never set, one that leaps, and a sensor whose clock is another."""
        now = clock.OLDEST_S + 1e6
        self.assertEqual(self.judged(clock.check_clock, (now, 5.0), (now + 2, 7.0), {}, False), [])
        self.assertIn("never set", self.judged(clock.check_clock, (100.0, 5.0), (102.0, 7.0), {}, False)[0])
        self.assertIn("was set by 3.000 s", self.judged(clock.check_clock, (now, 5.0), (now + 5, 7.0), {}, False)[0])
        report, sender = Report("clock"), ("10.0.0.2", 5)
        heard = listener.Heard([sender], {sender: bytes(8) + struct.pack(">q", 1_000_000) + bytes(8)}, {sender: 9_000_000})
        clock.check_clock(report, (now, 5.0), (now, 5.0), {"LADDER_IMU": heard}, False)
        self.assertIn("LADDER_IMU is 8.0 s old", report.findings[0].what)

    def test_no_chip(self):
        """No chip at all names the label that was looked for."""
        with tempfile.TemporaryDirectory() as dev:
            said = self.judged(gpio_lines.check_lines, {"chip": "ladder-gpio"}, pathlib.Path(dev))
        self.assertIn("no GPIO chip 'ladder-gpio' (there: none)", said[0])


if __name__ == "__main__":
    if sys.argv[1] == "publish":
        publish(sys.argv[2], float(sys.argv[3]))
    elif sys.argv[1] == "hold":
        hold(float(sys.argv[2]))
    else:
        SERVICES = sys.argv.pop(1)
        unittest.main()
