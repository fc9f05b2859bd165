# SPDX-License-Identifier: BSD-3-Clause
"""Faults by name upon the live robot: NAME[:TARGET][=VALUE] @ a time or a rung. Most are the plant's own (ladder_robot --fault);
here are those of processes, heads and the network."""

import random
import re
import time
from dataclasses import dataclass

from ladder_scripts.lcm_udp import Sender
from ladder_scripts.live_robot import PROGRAMS

SPEC = re.compile(r"(\w+)(?::(\w+))?(?:=([\w.]+))?@(?:rung:(\d+)|(\d+(?:\.\d*)?))")
BACK_AFTER_S = 2.0  # a killed service is started again, as systemd would
ESTOP_FOR_S = 3.0
# Kinds of ladder_robot --fault, and how many targets each has; 0 = rungs.
PLANT = {**dict.fromkeys(("silent", "no_heartbeat", "no_state", "wrong_length", "slow", "stuck", "wrong_sign", "emergency", "reboot",
                          "pre_operational", "under_voltage", "frame_loss", "frame_duplicate", "frame_delay"), 16),
         **dict.fromkeys(("touch_stuck_low", "touch_stuck_high"), 4), **dict.fromkeys(("rung_breaks", "rung_weak", "rung_breaks_on_touch"), 0),
         **dict.fromkeys(("estop_wire", "bus_down", "bus_stalled", "bus_off", "foreign_sync", "junk_frames"), 1)}


@dataclass
class Fault:
    name: str
    target: str
    value: str
    rung: int  # after so many rungs climbed; -1 = at a time
    time_s: float

    def __str__(self):
        return self.name + (f":{self.target}" if self.target else "") + (f"={self.value}" if self.value else "")

    def is_due(self, since_s, num_rungs):
        return num_rungs >= self.rung if self.rung >= 0 else since_s >= self.time_s


def parse(text):
    """ValueError says what is wrong."""
    match = SPEC.fullmatch(text)
    if not match:
        raise ValueError(f"{text}: a fault is NAME[:TARGET][=VALUE]@SECONDS or ...@rung:N, e.g. estop@rung:3")
    name, target, value, rung, time_s = match.groups()
    fault = Fault(name, target or "", value or "", int(rung) if rung else -1, float(time_s or 0.0))
    if name == "kill" and fault.target not in PROGRAMS:
        raise ValueError(f"{text}: kill needs one of {', '.join(PROGRAMS)}, e.g. kill:gng@40")
    if name == "head_dead" and fault.target not in ("0", "1", "2", "3"):
        raise ValueError(f"{text}: head_dead needs a head 0 to 3, e.g. head_dead:2@40")
    if name in PLANT and PLANT[name] != 1 and not fault.target.isdigit():
        raise ValueError(f"{text}: {name} needs a number, e.g. {name}:3@40")
    if name not in PLANT and name not in ("estop", "kill", "head_dead", "two_heads_dead", "flood"):
        raise ValueError(f"{text}: unknown; there are estop, kill, head_dead, two_heads_dead, flood, {', '.join(PLANT)}")
    return fault


class FaultPlayer:
    def __init__(self, faults, robot):
        self.robot = robot
        self.waiting = list(faults)
        self.later = []  # (time, what to do then)

    def play(self, since_s):
        """Begins what is due; their names."""
        now_s = time.monotonic()
        for at_s, act in [entry for entry in self.later if entry[0] <= now_s]:
            self.later.remove((at_s, act))
            act()
        due = [fault for fault in self.waiting if fault.is_due(since_s, self.robot.num_rungs)]
        for fault in due:
            self.waiting.remove(fault)
            self._begin(fault)
        return [str(fault) for fault in due]

    def _begin(self, fault):
        robot = self.robot
        if fault.name == "kill":
            robot.kill(fault.target)
            self.later.append((time.monotonic() + BACK_AFTER_S, lambda: robot.start(fault.target)))
        elif fault.name == "estop":
            robot.hand(f"estop 0 0 {fault.value or ESTOP_FOR_S}")
        elif fault.name == "head_dead":
            robot.hand(f"head_dead {fault.target}")
        elif fault.name == "two_heads_dead":
            robot.hand("head_dead 0")
            robot.hand("head_dead 1")
        elif fault.name == "flood":
            flood(robot.setup.url)
        else:
            robot.hand(f"{fault.name} {fault.target or 0} {fault.value or 0}")


def flood(url, seconds=2.0, per_burst=50, seed=1):
    """Orders and clouds that are none, as fast as a script can, in bursts. How many."""
    rng = random.Random(seed)
    sender = Sender(url)
    number = 0
    until_s = time.monotonic() + seconds
    while time.monotonic() < until_s:
        for _ in range(per_burst):
            channel = ("LADDER_COMMAND", "LADDER_CLOUD", "LADDER_RUNGS", "LADDER_IMU")[number % 4]
            sender.publish(channel, rng.randbytes(rng.choice((0, 8, 60, 1400))))
            number += 1
        time.sleep(0.005)
    return number
