# SPDX-License-Identifier: BSD-3-Clause
"""Mishaps upon the live climbing robot, one kind again and again at random instants, with what must follow (docs/SAFETY.md) judged by the
plant's truth and the controller's word. The live twin of ladder_closed_loop; times here are those of separate processes in real time."""

import random
import subprocess
import time

from ladder_scripts import robot_faults
from ladder_scripts.climb_operator import ClimbOperator, GaveUp
from ladder_scripts.live_robot import LATCHED, LiveRobot

GONE_S = 1.0  # until systemd has a service back
BACK_S = 60.0
OLD_LOG_S = 5.0
OLD_CHANNELS = "LADDER_(TOF_[0-3]|IMU|POSE|COMMAND|RUNGS|CLIMB)"
# Seen from here: bounds of the table, and what two processes and a line of truth every 50 ms take.
SEEN_LATE_S = 0.25
PERCEPTION_S = 0.31 + SEEN_LATE_S
DRIVES_STOP_S = 0.16 + SEEN_LATE_S
ESTOP_S = 0.02 + SEEN_LATE_S
KINDS = ("kill_sensor", "kill_gng", "kill_ladder", "kill_controller", "estop", "one_head", "two_heads", "flood", "old_log")


class Missed(Exception):
    """What should have been otherwise."""


class LiveDrill:
    def __init__(self, setup, kind, times, seed, tell):
        self.robot = LiveRobot(setup)
        self.operator = ClimbOperator(self.robot, self._hear, max_stops=10 * times)
        self.kind, self.times, self.tell = kind, times, tell
        self.random = random.Random(seed)
        self.old_log = setup.folder / f"{setup.name}-old.lcm"
        self.down = False
        self.rows = []
        self.missed = []

    def run(self):
        """{"rows": [...], "missed": [...], "falls": 0 or 1, ...}"""
        try:
            self._bring_up()
            while len(self.rows) < self.times:
                self.operator.pause(self.random.uniform(1.0, 8.0))
                self._climb_on()
                row = {"at_s": round(time.monotonic() - self.robot.started_s, 1), "state": self.robot.state_name, "reaction_ms": -1.0}
                self._suffer(row)
                begun_s = time.monotonic()
                self._climb_on()
                row["back_s"] = round(time.monotonic() - begun_s, 1)
                self.rows.append(row)
                self.tell(f"  {self.kind} {len(self.rows)}: {row}")
        except (Missed, GaveUp) as why:
            self.missed.append(f"{time.monotonic() - self.robot.started_s:.1f} s: {why}")
        finally:
            self.robot.end()
        return {"mishap": self.kind, "how": "live", "rows": self.rows, "missed": self.missed, "falls": int(self.robot.has_fallen),
                "min_support": self.robot.min_held, "rungs_climbed": self.robot.num_rungs, "stops": self.operator.stops}

    def _hear(self):
        self.robot.take_lines()
        self.robot.events.clear()

    def _bring_up(self):
        logger = None
        self.robot.start_all()
        if self.kind == "old_log":
            self.old_log.unlink(missing_ok=True)
            logger = subprocess.Popen(["lcm-logger", "-q", f"--lcm-url={self.robot.setup.url}", "-c", OLD_CHANNELS, self.old_log],
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.operator.hang()
        self._climb_on()
        if logger:
            self.operator.pause(OLD_LOG_S)
            logger.terminate()
            logger.wait()

    def _climb_on(self):
        """Until it climbs; at the top down, at the dock's place up again."""
        until_s = time.monotonic() + BACK_S
        while self.robot.state_name != "CLIMBING":
            state = self.robot.state_name
            if time.monotonic() > until_s:
                raise Missed(f"does not climb again: {state} ({self.robot.reason or 'no reason told'})")
            if self.operator.is_stopped(state):
                self.operator.recover()
            elif state == "HOLD":
                if self.operator.is_there(self.down):
                    self.down = not self.down
                self.operator.give("climb", *(["--down"] if self.down else []))
            self.operator.look()

    def _suffer(self, row):
        if self.kind == "kill_controller":
            self._kill_controller(row)
        elif self.kind.startswith("kill_"):
            self._kill_service(self.kind[len("kill_") :], row)
        elif self.kind == "estop":
            self._press_estop(row)
        elif self.kind == "flood":
            row["messages"] = robot_faults.flood(self.robot.setup.url, seed=self.random.random())
        elif self.kind == "old_log":
            subprocess.run(["lcm-logplayer", "-l", self.robot.setup.url, self.old_log], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                           check=True, timeout=60)
        else:
            self._lose_heads(2 if self.kind == "two_heads" else 1)

    def _after(self, condition, within_s, what):
        """ms until it is so."""
        begun_s = time.monotonic()
        if not self.operator.wait(condition, within_s):
            raise Missed(f"not within {1000 * within_s:.0f} ms: {what}; it is {self.robot.state_name} ({self.robot.reason})")
        return round(1000 * (time.monotonic() - begun_s), 1)

    def _kill_service(self, service, row):
        self.robot.kill(service)
        row["reaction_ms"] = self._after(lambda: self.robot.state_name != "CLIMBING", PERCEPTION_S, "perception silent is told")
        self.operator.pause(GONE_S)
        self.robot.start(service)

    def _kill_controller(self, row):
        robot = self.robot
        robot.kill("climb")
        row["reaction_ms"] = self._after(lambda: robot.truth.stopped == 16, DRIVES_STOP_S, "all drives stand and hold by themselves")
        self.operator.pause(GONE_S)
        robot.start("climb")
        session = self.operator.session
        self._after(lambda: robot.state["session_id"] != session and robot.state_name == "DISARMED", 20.0, "the new controller is disarmed")
        self.operator.pause(2.0)
        if robot.state_name != "DISARMED" or robot.truth.enabled > 0:
            raise Missed("a new controller enables drives that nobody armed")

    def _press_estop(self, row):
        robot = self.robot
        robot.hand("estop 0 0 2")
        row["reaction_ms"] = self._after(lambda: robot.state_name == "ESTOP" and robot.truth.enabled == 0, ESTOP_S, "ESTOP, no drive enabled")
        self.operator.pause(3.5)
        if robot.state_name != "ESTOP" or robot.truth.enabled > 0:
            raise Missed(f"a released E-stop is followed by {robot.state_name}")

    def _lose_heads(self, num_heads):
        first = self.random.randrange(4)
        heads = [(first + i) % 4 for i in range(num_heads)]
        for head in heads:
            self.robot.hand(f"head_dead {head}")
        self.operator.wait(lambda: self.robot.state_name in LATCHED, 10.0)
        for head in heads:
            self.robot.hand(f"head_back {head}")
