#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Parts of the climbing demo that need no robot: fault words, the plant's line of truth, small LCM messages."""
import pathlib
import sys
import time
import types
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from ladder_scripts import climb_operator, lcm_udp, robot_faults  # noqa: E402
from ladder_scripts.live_robot import PERCEPTION, truth_from  # noqa: E402


class FaultWords(unittest.TestCase):
    def test_what_is_refused_is_named(self):
        for bad in ("", "estop", "estop@", "estop@rung:", "estop@rung:x", "@3", "kill@3", "kill:nobody@3", "head_dead@3", "head_dead:4@3", "silent@3",
                    "rung_breaks:x@3", "melts@3", "estop@-1", "estop@1@2"):
            with self.subTest(bad), self.assertRaises(ValueError) as refused:
                robot_faults.parse(bad)
            self.assertIn(bad, str(refused.exception))

    def test_time_and_rung(self):
        at_time = robot_faults.parse("kill:gng@12.5")
        self.assertEqual((at_time.name, at_time.target, at_time.time_s), ("kill", "gng", 12.5))
        self.assertFalse(at_time.is_due(12.4, 99))
        self.assertTrue(at_time.is_due(12.5, 0))
        at_rung = robot_faults.parse("rung_weak:6=40@rung:2")
        self.assertEqual((at_rung.target, at_rung.value, str(at_rung)), ("6", "40", "rung_weak:6=40"))
        self.assertFalse(at_rung.is_due(1e9, 1))
        self.assertTrue(at_rung.is_due(0.0, 2))

    def test_the_plants_kinds_are_the_plants(self):
        source = (ROOT / "simulator/plant/fault_script.cpp").read_text()
        for kind in robot_faults.PLANT:
            self.assertIn(f'"{kind}"', source)


class TruthLine(unittest.TestCase):
    def test_reads_what_the_plant_writes(self):
        truth = truth_from("   12.05 s  truth  enabled  0  stopped 16  claws 3* 3 - 12*  z 0.842 m  docked  E-STOP  FALLEN")
        self.assertEqual((truth.time_s, truth.enabled, truth.stopped, truth.rungs), (12.05, 0, 16, [3, 3, None, 12]))
        self.assertEqual((truth.height_m, truth.docked, truth.fallen, truth.num_held), (0.842, True, True, 3))
        truth = truth_from("    0.00 s  truth  enabled 16  claws - - - -  z -0.100 m")
        self.assertEqual((truth.enabled, truth.stopped, truth.num_held, truth.docked, truth.fallen), (16, 0, 0, False, False))

    def test_other_lines_are_none(self):
        for line in ("", "ladder plain, seed 3", "  40.1 s  rung 3 climbed, body at 1.2 m"):
            self.assertIsNone(truth_from(line))


class ScriptedRobot:
    """A controller that takes orders as told, without time: refusals are counted down."""

    def __init__(self, state, session=7, refused_resets=0):
        self.state_name, self.reason = state, "servo fault"
        self.state = {"session_id": session, "estop_active": 0, "at_top": 0}
        self.state_s = self.started_s = 0.0
        self.refused_resets = refused_resets
        self.done = []
        self.has_fallen = False

    def listen(self, seconds):
        self.state_s = time.monotonic()

    def dead(self):
        return []

    def log_of(self, name):
        return f"{name}.log"

    def hand(self, line):
        self.done.append(line)

    def kill(self, service):
        self.done.append(f"kill {service}")

    def start(self, service):
        self.done.append(f"start {service}")

    def order(self, *words):
        self.done.append(words[0])
        refused = words[0] == "reset" and self.refused_resets > 0
        self.refused_resets -= refused
        if not refused:
            self.state_name = {"reset": "DISARMED", "arm": "HOLD"}[words[0]]
        return types.SimpleNamespace(poll=lambda: int(refused), returncode=int(refused))


class Operator(unittest.TestCase):
    def operator(self, robot):
        operator = climb_operator.ClimbOperator(robot)
        operator.session = 7
        operator.pause = lambda seconds: None
        return operator

    def test_a_reset_that_is_refused_is_given_again(self):
        robot = ScriptedRobot("FAULT_HOLD", refused_resets=climb_operator.MAX_RESETS - 1)
        self.operator(robot).recover()
        self.assertEqual(robot.done, ["reset"] * climb_operator.MAX_RESETS + ["arm"])

    def test_gives_up_with_the_reason_and_where_to_read_on(self):
        robot = ScriptedRobot("FAULT_HOLD", refused_resets=1000)
        with self.assertRaises(climb_operator.GaveUp) as gave_up:
            self.operator(robot).recover()
        self.assertEqual(robot.done, ["reset"] * climb_operator.MAX_RESETS)
        for word in ("FAULT_HOLD", "servo fault", "climb.log", "OPERATION"):
            self.assertIn(word, str(gave_up.exception))

    def test_a_new_controller_is_armed_where_it_hangs(self):
        robot = ScriptedRobot("DISARMED", session=8)
        operator = self.operator(robot)
        operator.recover()
        self.assertEqual(robot.done, [f"{what} {service}" for service in PERCEPTION for what in ("kill", "start")] + ["arm"])
        self.assertEqual(operator.session, 8)


class SmallMessages(unittest.TestCase):
    URL = "udpm://239.255.76.67:27699?ttl=0"

    def test_come_as_sent(self):
        listener, sender = lcm_udp.Listener(self.URL), lcm_udp.Sender(self.URL)
        sent = [("LADDER_CLIMB", b""), ("A", b"\0\1\2"), ("LADDER_HEALTH", bytes(1000))]
        for channel, message in sent:
            sender.publish(channel, message)
        self.assertEqual(list(listener.messages(time.monotonic() + 0.3)), sent)

    def test_fragments_and_noise_are_left_out(self):
        listener, sender = lcm_udp.Listener(self.URL), lcm_udp.Sender(self.URL)
        for datagram in (b"", b"LC03" + bytes(60), b"LC", bytes(4000)):
            sender.socket.sendto(datagram, sender.target)
        sender.publish("B", b"x")
        self.assertEqual(list(listener.messages(time.monotonic() + 0.3)), [("B", b"x")])

    def test_too_large_is_refused(self):
        with self.assertRaises(ValueError):
            lcm_udp.Sender(self.URL).publish("A", bytes(70000))


if __name__ == "__main__":
    unittest.main()
