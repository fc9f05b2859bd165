# SPDX-License-Identifier: BSD-3-Clause
"""The robot in physics with its four services, as separate processes, and somebody who hears what they say: for demo and closed-loop drill.

It starts and kills processes, gives orders with ladder-command, acts upon the simulated robot (dock, faults), and keeps what was
heard last: the controller's state, each service's health, events, and the plant's truth, which the robot itself prints."""

import collections
import os
import pathlib
import queue
import re
import subprocess
import threading
import time
from dataclasses import dataclass, field

from ladder_scripts import messages
from ladder_scripts.lcm_udp import Listener

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = {"sensor": "sensor_service", "gng": "gng_service", "ladder": "ladder_service", "climb": "climb_controller"}
PERCEPTION = ("sensor", "gng", "ladder")
CHANNELS = ("LADDER_CLIMB", "LADDER_HEALTH", "LADDER_EVENT")
TRUTH = re.compile(r"\s*([\d.]+) s  truth  enabled +(\d+)(?:  stopped (\d+))?  claws((?: \S+)+)  z (-?[\d.]+) m(.*)")
RUNG = re.compile(r"\s*([\d.]+) s  rung (\d+) climbed")
LATCHED = ("FAULT_HOLD", "ESTOP")


@dataclass
class Setup:
    url: str
    bin: pathlib.Path = REPOSITORY / "build/release/bin"
    folder: pathlib.Path = REPOSITORY / "build/logs"
    name: str = "climb"  # of logs and sockets
    overrides: list = field(default_factory=list)  # "--set", "table.key=value"
    robot: list = field(default_factory=list)  # arguments of ladder_robot
    notifies: bool = False  # services tell systemd's part at notify_socket_of() how they are


@dataclass
class Truth:
    """What the plant knows and no service does."""

    time_s: float
    enabled: int  # drives that follow targets
    stopped: int  # drives that stand and hold after a quick stop
    rungs: list  # which rung each claw holds, None
    height_m: float
    docked: bool
    fallen: bool

    @property
    def num_held(self):
        return sum(rung is not None for rung in self.rungs)


def truth_from(line):
    match = TRUTH.match(line)
    if not match:
        return None
    time_s, enabled, stopped, claws, height, rest = match.groups()
    rungs = [None if claw == "-" else int(claw.rstrip("*")) for claw in claws.split()]
    return Truth(float(time_s), int(enabled), int(stopped or 0), rungs, float(height), "docked" in rest, "FALLEN" in rest)


class LiveRobot:
    def __init__(self, setup):
        self.setup = setup
        setup.folder.mkdir(parents=True, exist_ok=True)
        self.processes = {}
        self.killed = set()  # on purpose, and not started again
        self.listener = Listener(setup.url)
        types = messages.load_types(REPOSITORY / "lcmtypes")
        self.types = {message_type.name: message_type for message_type in types.values()}
        self.by_fingerprint = types
        self.state = None  # newest climb_state_t
        self.state_s = 0.0  # when it came
        self.health = {}
        self.events = collections.deque(maxlen=1000)  # texts of warnings and errors that nobody has taken yet
        self.truth = None
        self.truth_s = 0.0
        self.has_fallen = False
        self.min_held = 4  # out of the dock, once it has hung
        self.num_rungs = 0  # climbed, by truth
        self.lines = queue.Queue()  # of the robot, but for truth
        self.started_s = time.monotonic()

    # --- processes ------------------------------------------------------------------------------------------------------
    def log_of(self, name):
        return self.setup.folder / f"{self.setup.name}-{name}.log"

    def socket_of(self, what):
        return self.setup.folder / f"{self.setup.name}.{what}"

    def notify_socket_of(self, service):
        return self.socket_of(f"{service}.notify")

    def start_robot(self):
        command = [self.setup.bin / "ladder_robot", "--can", f"unix:{self.socket_of('can')}", "--lines", f"unix:{self.socket_of('lines')}",
                   "--url", self.setup.url, "--hand", "--print_period_s", "0.05", "--json", self.log_of("figures"), *self.setup.robot]
        for path in (self.log_of("figures"), self.socket_of("can"), self.socket_of("lines")):
            path.unlink(missing_ok=True)  # an earlier climb's are not this one's
        with open(self.log_of("robot"), "w", encoding="utf-8") as log:
            robot = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=log, text=True, start_new_session=True)
        self.processes["robot"] = robot
        threading.Thread(target=self._read_robot, args=(robot,), daemon=True).start()

    def start(self, service):
        command = [self.setup.bin / PROGRAMS[service], "--url", self.setup.url, "--config", "config/robot.toml", "--config", "config/sim.toml",
                   *self.setup.overrides]
        if service == "climb":
            command += ["--set", f"climb.can.interface=unix:{self.socket_of('can')}", "--set",
                        f"climb.lines.chip=unix:{self.socket_of('lines')}"]
        environment = {**os.environ, **({"NOTIFY_SOCKET": str(self.notify_socket_of(service))} if self.setup.notifies else {})}
        self.killed.discard(service)
        again = service in self.processes
        with open(self.log_of(service), "a" if again else "w", encoding="utf-8") as log:
            self.processes[service] = subprocess.Popen(command, cwd=REPOSITORY, env=environment, stdout=log, stderr=log, start_new_session=True)

    def start_all(self):
        self.start_robot()
        for service in PROGRAMS:
            if service == "climb":
                self._wait_for_doors()
            self.start(service)

    def _wait_for_doors(self):
        """The controller needs the robot's bus and lines when it starts."""
        until_s = time.monotonic() + 15.0
        while not (self.socket_of("can").exists() and self.socket_of("lines").exists()) and time.monotonic() < until_s:
            time.sleep(0.02)

    def kill(self, service):
        """As kill -9 does."""
        self.killed.add(service)
        self.processes[service].kill()
        self.processes[service].wait()

    def dead(self):
        """Names of processes that have ended by themselves."""
        return [name for name, process in self.processes.items() if process.poll() is not None and name not in self.killed]

    def end(self):
        """Ends all: the controller first, while it still sees, the robot last. Names of those that did not end with 0."""
        unclean = []
        for name in sorted(self.processes, key=lambda name: (name != "climb", name == "robot")):
            process = self.processes[name]
            if process.poll() is None:
                process.terminate()
            try:
                process.wait(5.0)
            except subprocess.TimeoutExpired:  # a step in the air is finished first, but not upon a second one
                process.terminate() if name == "climb" else process.kill()
            if process.wait() != 0 and name not in self.killed:
                unclean.append(name)
        self.processes = {}
        return unclean

    # --- what it hears --------------------------------------------------------------------------------------------------
    def _read_robot(self, robot):
        for line in robot.stdout:
            truth = truth_from(line)
            if truth is None:
                self.lines.put(line.rstrip("\n"))
                continue
            self.truth, self.truth_s = truth, time.monotonic()
            self.has_fallen = self.has_fallen or truth.fallen
            if not truth.docked:
                self.min_held = min(self.min_held, truth.num_held)

    def listen(self, seconds):
        for channel, message in self.listener.messages(time.monotonic() + seconds):
            if channel not in CHANNELS:
                continue
            message_type = messages.type_of(self.by_fingerprint, message)
            if message_type is None or messages.fault_of(message_type, message):
                continue
            self._take(message_type.name, messages.decode(message_type, message))

    def _take(self, name, values):
        if name == "climb_state_t":
            if self.state is None or values["utime"] > self.state["utime"]:  # an old log may be played beside
                self.state, self.state_s = values, time.monotonic()
        elif name == "health_t":
            self.health[values["service"]] = values
        elif name == "event_t" and values["level"] >= self.types["event_t"].constants["LEVEL_WARNING"]:
            self.events.append(values["text"])

    def take_lines(self):
        """What the robot printed since; counts rungs."""
        lines = []
        while not self.lines.empty():
            lines.append(self.lines.get())
            match = RUNG.match(lines[-1])
            if match:
                self.num_rungs = int(match[2])
        return lines

    def word(self, field_name, prefix):
        """The name of a constant, e.g. word("state", "STATE") = "HOLD"."""
        if self.state is None:
            return "UNKNOWN"
        for name, value in self.types["climb_state_t"].constants.items():
            if name.startswith(prefix + "_") and value == self.state[field_name]:
                return name[len(prefix) + 1 :]
        return "UNKNOWN"

    @property
    def state_name(self):
        return self.word("state", "STATE")

    @property
    def reason(self):
        """Why it stands, in words; '' = no cause is told."""
        for field_name, prefix in (("reason", "REASON"), ("refusal", "REFUSAL"), ("burden", "BURDEN")):
            word = self.word(field_name, prefix)
            if word not in ("NONE", "UNKNOWN", "BORNE"):
                return word.lower().replace("_", " ")
        return ""

    def ages_ms(self):
        """(median, 99 %) of the rungs' age when the controller takes them, over the last second; None before it knows."""
        health = self.health.get(self.types["health_t"].constants["SERVICE_CLIMB"])
        rungs = self.types["health_t"].constants["CHANNEL_RUNGS"]
        if health is None or rungs not in health["input_channel"]:
            return None
        at = health["input_channel"].index(rungs)
        p50_us, p99_us = health["input_age_p50_us"][at], health["input_age_p99_us"][at]
        return None if p50_us < 0 else (p50_us / 1000.0, p99_us / 1000.0)

    # --- what it does ---------------------------------------------------------------------------------------------------
    def hand(self, line):
        """Something happens to the simulated robot: dock, undock, head_dead N, or a fault of ladder_robot."""
        robot = self.processes["robot"]
        robot.stdin.write(line + "\n")
        robot.stdin.flush()

    def order(self, *words):
        """ladder-command as a process; poll() it while listening. Its output goes to a log."""
        with open(self.log_of("command"), "a", encoding="utf-8") as log:
            log.write(f"$ ladder-command {' '.join(words)}\n")
            log.flush()
            return subprocess.Popen([self.setup.bin / "ladder-command", "--url", self.setup.url, *words], stdout=log, stderr=log)
