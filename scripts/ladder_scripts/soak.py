# SPDX-License-Identifier: BSD-3-Clause
"""What must not grow while the whole chain runs for long (scripts/demo --soak): memory of each process, lost messages, and the pauses in
which a service does not feed its watchdog, heard where systemd would hear them. It only looks."""

import pathlib
import re
import select
import socket
import threading
import time

from ladder_scripts.live_robot import PROGRAMS

WARM_UP_S = 60.0
SAMPLE_PERIOD_S = 10.0
MAX_GROWTH_KB = 1024
UNITS = pathlib.Path(__file__).resolve().parents[2] / "config/systemd"


def memory_kb(pid):
    """{"rss_kB", "anonymous_kB"} of a process; None when it is gone."""
    try:
        text = pathlib.Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
    except OSError:
        return None
    found = dict(re.findall(r"^(VmRSS|RssAnon):\s+(\d+) kB", text, re.M))
    return {"rss_kB": int(found["VmRSS"]), "anonymous_kB": int(found["RssAnon"])} if len(found) == 2 else None


def watchdog_s(service):
    """After how long a pause systemd would kill the service and start it again."""
    unit = (UNITS / f"ladder-{service}.service").read_text(encoding="utf-8")
    return float(re.search(r"^WatchdogSec=(\d+)$", unit, re.M)[1])


class SignsOfLife:
    """Takes systemd's part at NOTIFY_SOCKET: the longest pause of each service between two WATCHDOG=1, from READY=1 to STOPPING=1."""

    def __init__(self, paths):
        self.longest_s = {}
        self.fed_s = {}  # of those that are ready and not stopping
        self.sockets = {}
        for service, path in paths.items():
            path.unlink(missing_ok=True)
            ear = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
            ear.bind(str(path))
            self.sockets[ear] = service
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self):
        while True:
            for ear in select.select(list(self.sockets), [], [])[0]:
                self.hear(self.sockets[ear], ear.recv(4096), time.monotonic())

    def hear(self, service, message, now_s):
        for word in message.split(b"\n"):
            if word == b"READY=1":
                self.fed_s[service] = now_s
                self.longest_s.setdefault(service, 0.0)
            elif word in (b"WATCHDOG=1", b"STOPPING=1") and service in self.fed_s:
                self.longest_s[service] = max(self.longest_s[service], now_s - self.fed_s[service])
                self.fed_s[service] = now_s
                if word == b"STOPPING=1":
                    del self.fed_s[service]

    def pauses_s(self, now_s):
        """The longest of each, the one that lasts included."""
        return {service: max(longest_s, now_s - self.fed_s.get(service, now_s)) for service, longest_s in list(self.longest_s.items())}


class Soak:
    """look() often; figures() at the end, while the processes still run."""

    def __init__(self, robot):
        self.robot = robot
        self.signs = SignsOfLife({service: robot.notify_socket_of(service) for service in PROGRAMS})
        self.samples = []  # since when, and {process: memory}
        self.due_s = WARM_UP_S

    def look(self):
        since_s = time.monotonic() - self.robot.started_s
        if since_s < self.due_s:
            return
        self.due_s += SAMPLE_PERIOD_S
        self.samples.append((round(since_s, 1), {name: memory_kb(process.pid) for name, process in self.robot.processes.items()}))

    def lost(self):
        """Messages, by the services' own count since they started."""
        constants = self.robot.types["health_t"].constants
        names = {value: name[len("SERVICE_") :].lower() for name, value in constants.items() if name.startswith("SERVICE_")}
        return {names.get(service, str(service)): sum(health["input_lost"]) for service, health in self.robot.health.items()}

    def figures(self):
        pauses_s = self.signs.pauses_s(time.monotonic())
        return {
            "memory": growth_of(self.samples),
            "samples": [{"at_s": at_s, **{name: memory and memory["rss_kB"] for name, memory in sample.items()}} for at_s, sample in self.samples],
            "lost": self.lost(),
            "watchdog": {service: {"longest_pause_s": round(pause_s, 3), "bound_s": watchdog_s(service)} for service, pause_s in pauses_s.items()},
        }


def growth_of(samples):
    """{process: kB}: first after the warm-up, last, and the most that any was above the first."""
    growth = {}
    for name in samples[0][1] if samples else ():
        course = [sample[name] for _, sample in samples if sample.get(name)]
        rss_kb = [memory["rss_kB"] for memory in course]
        anonymous_kb = [memory["anonymous_kB"] for memory in course]
        if course:
            growth[name] = {"first_kB": rss_kb[0], "last_kB": rss_kb[-1], "growth_kB": max(rss_kb) - rss_kb[0],
                            "anonymous_growth_kB": max(anonymous_kb) - anonymous_kb[0]}
    return growth


def excesses(figures):
    """What is beyond its bound, in words; of a service that was never heard nothing is known, which is beyond."""
    found = [f"{name} grew by {memory['growth_kB']} kB (bound {MAX_GROWTH_KB})" for name, memory in figures["memory"].items()
             if memory["growth_kB"] >= MAX_GROWTH_KB]
    found += [f"{name} lost {lost} messages" for name, lost in figures["lost"].items() if lost]
    found += [f"{name} did not feed its watchdog for {pause['longest_pause_s']} s (bound {pause['bound_s']})"
              for name, pause in figures["watchdog"].items() if pause["longest_pause_s"] >= pause["bound_s"]]
    for what in ("memory", "lost", "watchdog"):
        found += [f"{name}: no figure of {what}" for name in PROGRAMS if name not in figures[what]]
    return found


def table(figures):
    """One line per process."""
    rows = [f"  {'process':10}{'RSS kB':>10}{'growth':>9}{'of it heap':>12}{'lost':>7}{'longest pause':>16}"]
    for name, memory in figures["memory"].items():
        pause = figures["watchdog"].get(name)
        told = f"{pause['longest_pause_s']:.2f} of {pause['bound_s']:g} s" if pause else "-"
        rows.append(f"  {name:10}{memory['last_kB']:>10}{memory['growth_kB']:>9}{memory['anonymous_growth_kB']:>12}"
                    f"{figures['lost'].get(name, '-'):>7}{told:>16}")
    return "\n".join(rows)
