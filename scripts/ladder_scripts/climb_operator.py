# SPDX-License-Identifier: BSD-3-Clause
"""What an operator does with the live robot: arm in the dock, let go, send up or down, reset and arm again after a stop, and give up when
that does not help. It gives orders only through ladder-command; nothing here moves the robot by itself."""

import time

from ladder_scripts.live_robot import LATCHED, PERCEPTION

MAX_STOPS = 6  # latched ones, then enough
MAX_HELD = 3  # orders to go on from a HOLD that is not the top
MAX_RESETS = 4
PATIENCE_S = 60.0  # without perception, without a controller
SETTLING_S = 3.0
LOOK_S = 0.05
# What a computer that is too busy does to any real-time program.
STARVED = ("overrun", "imu silent", "perception silent", "transmit stalled", "servo silent", "heartbeat lost", "suspended")


class TimeIsUp(Exception):
    """The demo was to last so long."""


class GaveUp(Exception):
    """No way on; the text says why."""


class ClimbOperator:
    def __init__(self, robot, on_look=lambda: None, until_s=None, max_stops=MAX_STOPS):
        self.robot = robot
        self.on_look = on_look
        self.until_s = until_s
        self.max_stops = max_stops
        self.stops = []  # of latched ones: seconds since the start, state, reason
        self.dock_rungs = None
        self.session = None
        self.was_starved = False

    def look(self):
        if self.until_s is not None and time.monotonic() >= self.until_s:
            raise TimeIsUp
        self.robot.listen(LOOK_S)
        self.on_look()
        for name in self.robot.dead():
            raise GaveUp(f"{name} ended by itself, its last words are in {self.robot.log_of(name)}")
        if self.robot.has_fallen:
            raise GaveUp("the robot fell")

    def wait(self, condition, timeout_s):
        until_s = time.monotonic() + timeout_s
        while not condition():
            if time.monotonic() >= until_s:
                return False
            self.look()
        return True

    def pause(self, seconds):
        self.wait(lambda: False, seconds)

    def give(self, *words, timeout_s=None):
        """One order; whether it was accepted and led where it should."""
        tool = self.robot.order(*words, *([] if timeout_s is None else ["--timeout", str(timeout_s)]))
        try:
            while tool.poll() is None:
                self.look()
        except BaseException:
            tool.terminate()
            tool.wait()
            raise
        return tool.returncode == 0

    # --- whole actions --------------------------------------------------------------------------------------------------
    def hang(self):
        """Four claws grasp in the dock, then the dock lets go."""
        if not self.wait(lambda: self.robot.state_name == "DISARMED", PATIENCE_S):
            raise GaveUp(f"never DISARMED but {self.robot.state_name} ({self.robot.reason or 'no reason told'})")
        self.pause(SETTLING_S)  # it sees the ladder
        self._arm()
        self.dock_rungs = list(self.robot.truth.rungs)
        self.robot.hand("undock")
        self.pause(SETTLING_S)

    def climb(self, down=False):
        """'top', 'dock' or 'held'."""
        num_held = 0
        self._send(down)
        while True:
            self.look()
            state = self.robot.state_name
            if self.is_stopped(state):
                self.recover()
                self._send(down)
            elif state == "HOLD" and self.is_there(down):
                return "dock" if down else "top"
            elif state == "HOLD":
                num_held += 1
                if num_held > MAX_HELD:
                    return "held"
                self.pause(SETTLING_S)
                self._send(down)
            elif state == "PROTECTIVE_HOLD" and not self.wait(lambda: self.robot.state_name != "PROTECTIVE_HOLD", PATIENCE_S):
                raise GaveUp(f"PROTECTIVE_HOLD for {PATIENCE_S:.0f} s: {self.robot.reason}")

    def park(self):
        """Back in the dock: the dock takes the body, claws open, torque goes off."""
        self.robot.hand("dock")
        self.pause(1.0)
        if not self.give("disarm", "--wait", "DISARMED", timeout_s=60):
            raise GaveUp(f"not disarmed: {self.robot.state_name}, {self.robot.reason}")

    def is_there(self, down):
        if down:
            return self.dock_rungs is not None and self.robot.truth.rungs == self.dock_rungs
        return self.robot.state["at_top"] != 0

    # --- parts ----------------------------------------------------------------------------------------------------------
    def is_stopped(self, state):
        is_new = self.robot.state is not None and self.session is not None and self.robot.state["session_id"] != self.session
        is_silent = time.monotonic() - self.robot.state_s > 1.0
        return state in LATCHED or is_new or is_silent or state == "DISARMED"

    def _send(self, down):
        for _ in range(3):
            if self.give("climb", *(["--down"] if down else [])) or self.is_stopped(self.robot.state_name):
                return
            self.pause(SETTLING_S)
        if self.robot.state_name not in ("HOLD", "CLIMBING", "PROTECTIVE_HOLD"):
            raise GaveUp(f"'climb' is refused in {self.robot.state_name}: {self.robot.reason}")

    def _arm(self):
        for _ in range(MAX_STOPS):
            if self.give("arm"):
                self.session = self.robot.state["session_id"]
                return
            self._note_stop()
            self.pause(1.0)
            self.give("reset", timeout_s=20)
        raise GaveUp(f"cannot be armed: {self.robot.state_name}, {self.robot.reason}")

    def _note_stop(self):
        reason = self.robot.reason
        self.was_starved = self.was_starved or reason in STARVED
        self.stops.append({"at_s": round(time.monotonic() - self.robot.started_s, 1), "state": self.robot.state_name, "reason": reason})
        if len(self.stops) > self.max_stops:
            raise GaveUp(f"{self.robot.state_name}: {reason}")

    def _reset(self):
        """Again while the cause has not passed."""
        for _ in range(MAX_RESETS):
            if self.robot.state_name not in LATCHED or self.give("reset", timeout_s=20):
                return
            self.pause(SETTLING_S)
        raise GaveUp(f"reset is refused: {self.robot.state_name}, {self.robot.reason}; the controller's words are in {self.robot.log_of('climb')}, "
                     "what each reason asks for in docs/OPERATION.md")

    def recover(self):
        """After a stop: its cause gone, reset, arm. Where the controller was started anew, odom begins where the robot hangs: perception too."""
        if not self.wait(lambda: time.monotonic() - self.robot.state_s < 0.5, PATIENCE_S):
            raise GaveUp("no controller is heard")
        self._note_stop()
        self.pause(1.0)
        is_new = self.robot.state["session_id"] != self.session
        if is_new:
            for service in PERCEPTION:
                self.robot.kill(service)
                self.robot.start(service)
            if not self.wait(lambda: self.robot.state_name in ("DISARMED", *LATCHED), PATIENCE_S):
                raise GaveUp(f"the new controller is {self.robot.state_name}: {self.robot.reason}")
            self.pause(SETTLING_S)  # it sees the ladder
        self.wait(lambda: self.robot.state["estop_active"] == 0, PATIENCE_S)
        self._reset()
        self._arm()
