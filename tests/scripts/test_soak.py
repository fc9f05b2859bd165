#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What scripts/demo --soak judges by, without a robot: memory of a process, pauses between signs of life, figures beyond their bounds."""
import os
import pathlib
import socket
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from ladder_scripts import soak  # noqa: E402
from ladder_scripts.live_robot import PROGRAMS  # noqa: E402


def sample(**rss_kb):
    return {name: kb and {"rss_kB": kb, "anonymous_kB": kb // 2} for name, kb in rss_kb.items()}


def good_figures():
    return {"memory": {name: {"growth_kB": 1023} for name in ("robot", *PROGRAMS)}, "lost": dict.fromkeys(PROGRAMS, 0),
            "watchdog": {name: {"longest_pause_s": 0.9, "bound_s": 1.0} for name in PROGRAMS}}


class Memory(unittest.TestCase):
    def test_of_this_process_grows_with_it(self):
        before = soak.memory_kb(os.getpid())
        ballast = b"x" * (8 << 20)
        after = soak.memory_kb(os.getpid())
        for what in ("rss_kB", "anonymous_kB"):
            self.assertGreater(after[what] - before[what], 7 << 10)
        del ballast

    def test_of_nobody_is_none(self):
        self.assertIsNone(soak.memory_kb(2**22 + 1))

    def test_growth_is_the_most_above_the_first(self):
        growth = soak.growth_of([(60, sample(gng=1000, robot=500)), (70, sample(gng=1300, robot=400)), (80, sample(gng=1100, robot=None))])
        self.assertEqual(growth["gng"], {"first_kB": 1000, "last_kB": 1100, "growth_kB": 300, "anonymous_growth_kB": 150})
        self.assertEqual((growth["robot"]["growth_kB"], growth["robot"]["last_kB"]), (0, 400))

    def test_without_samples_there_is_none(self):
        self.assertEqual(soak.growth_of([]), {})


class SignsOfLife(unittest.TestCase):
    def test_longest_pause(self):
        signs = soak.SignsOfLife({})
        signs.hear("gng", b"WATCHDOG=1", 1.0)  # not ready yet: systemd does not count
        self.assertEqual(signs.pauses_s(9.0), {})
        signs.hear("gng", b"READY=1", 10.0)
        signs.hear("gng", b"WATCHDOG=1\nSTATUS=well", 10.5)
        signs.hear("gng", b"WATCHDOG=1", 12.0)
        self.assertEqual(signs.pauses_s(12.1), {"gng": 1.5})
        self.assertEqual(signs.pauses_s(20.0), {"gng": 8.0})  # it lasts
        signs.hear("gng", b"STOPPING=1", 13.0)
        self.assertEqual(signs.pauses_s(90.0), {"gng": 1.5})

    def test_is_heard_at_its_socket(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "climb.notify"
            signs = soak.SignsOfLife({"climb": path})
            with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as service:
                service.sendto(b"READY=1", str(path))
            until_s = time.monotonic() + 10.0
            while "climb" not in signs.pauses_s(0.0) and time.monotonic() < until_s:
                time.sleep(0.01)
        self.assertIn("climb", signs.pauses_s(0.0))

    def test_bounds_are_the_units(self):
        self.assertEqual({name: soak.watchdog_s(name) for name in PROGRAMS}, {"sensor": 2.0, "gng": 2.0, "ladder": 2.0, "climb": 1.0})


class Bounds(unittest.TestCase):
    def test_within(self):
        self.assertEqual(soak.excesses(good_figures()), [])

    def test_each_excess_is_named(self):
        for what, name, figure, words in (("memory", "robot", {"growth_kB": 1024}, "robot grew by 1024 kB"), ("lost", "sensor", 1, "sensor lost 1"),
                                          ("watchdog", "climb", {"longest_pause_s": 1.0, "bound_s": 1.0}, "climb did not feed its watchdog")):
            figures = good_figures()
            figures[what][name] = figure
            with self.subTest(what):
                found = soak.excesses(figures)
                self.assertEqual(len(found), 1)
                self.assertIn(words, found[0])

    def test_what_was_never_heard_is_no_success(self):
        for what in ("memory", "lost", "watchdog"):
            figures = good_figures()
            del figures[what]["gng"]
            with self.subTest(what):
                self.assertEqual(soak.excesses(figures), [f"gng: no figure of {what}"])


if __name__ == "__main__":
    unittest.main()
