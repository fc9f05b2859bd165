# SPDX-License-Identifier: BSD-3-Clause
"""The climbing part of scripts/demo, which has built everything: robot, services and operator live, progress in the terminal, a summary."""

import argparse
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import time

from ladder_scripts import robot_faults, soak
from ladder_scripts.climb_operator import MAX_STOPS, ClimbOperator, GaveUp, TimeIsUp
from ladder_scripts.live_robot import LATCHED, REPOSITORY, LiveRobot, Setup

LIMBS = ("FL", "FR", "RL", "RR")
FIGURES = ("end", "reason", "rungs_climbed", "falls", "grasps_tried", "grasps_failed", "unsafe_grasps", "min_support", "stops", "seconds",
           "peak_joint_torque_Nm", "peak_grip_N", "pose_drift_mm", "latency_ms_p50", "latency_ms_p99", "messages_lost", "real_time_factor")
# A ladder whose weak rung looks sound is a fault of the plant.
HIDDEN_DAMAGE = {"loose": "0 rung_breaks_on_touch {rung}", "weak": "0 rung_weak {rung} 50"}
REAL_TIME = 0.97
WARN_AGAIN_S = 60.0


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scene", default="plain")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--json", type=pathlib.Path, required=True)
    parser.add_argument("--down", action="store_true")
    parser.add_argument("--soak", action="store_true", help="up and down until the time is up; memory, losses and watchdogs have bounds")
    parser.add_argument("--fault", action="append", default=[])
    parser.add_argument("--set", action="append", default=[], dest="overrides")
    parser.add_argument("--spy", action="store_true")
    return parser.parse_args()


def robot_arguments(options):
    """The ladder for ladder_robot; SCENE may be SCENE:RUNG."""
    scene, _, rung = options.scene.partition(":")
    if scene in HIDDEN_DAMAGE:
        return ["--scene", "plain", "--seed", str(options.seed), "--fault", HIDDEN_DAMAGE[scene].format(rung=rung or 6)]
    return ["--scene", scene, "--seed", str(options.seed), *(["--damaged_rung", rung] if rung else [])]


class Screen:
    """One line per thing that happens, and on a terminal a last line that is always now."""

    def __init__(self, robot, player):
        self.robot = robot
        self.player = player
        self.is_terminal = sys.stdout.isatty()
        self.said = None
        self.faults = []
        self.warned_s = {}  # when a text was told last
        self.ways = []  # how each way of a soak ended: top, dock, held
        self.num_blind = 0  # times that perception was too late, with no fault that explains it

    def tell(self, text):
        clear = "\r\033[K" if self.is_terminal else ""
        print(f"{clear}{time.monotonic() - self.robot.started_s:6.1f} s  {text}", flush=True)

    def look(self):
        robot = self.robot
        for line in robot.take_lines():
            self.tell(" ".join(line.split()[2:]) if " s  rung" in line else line)
        for name in self.player.play(time.monotonic() - robot.started_s):
            self.faults.append({"fault": name, "at_s": round(time.monotonic() - robot.started_s, 1)})
            self.tell(f"FAULT {name}")
        while robot.events:
            self.warn(robot.events.popleft())
        if robot.state is None:
            return
        now = robot.state_name + (f" ({robot.reason})" if robot.reason and robot.state_name != "CLIMBING" else "")
        if now != self.said:
            self.tell(now)
            self.num_blind += robot.state_name == "PROTECTIVE_HOLD" and not self.faults
        self.said = now
        if self.is_terminal:
            print("\r\033[K" + self.now_line()[: os.get_terminal_size().columns - 1], end="", flush=True)

    def warn(self, text):
        now_s = time.monotonic()
        if now_s - self.warned_s.get(text, -1e9) > WARN_AGAIN_S:
            self.tell(f"  warning: {text}")
            self.warned_s[text] = now_s

    def now_line(self):
        robot = self.robot
        limbs = "  ".join(f"{name} {'moves' if robot.truth and rung is None else rung}"
                          for name, rung in zip(LIMBS, robot.truth.rungs if robot.truth else [None] * 4))
        ages = robot.ages_ms()
        latency = f"rungs {ages[0]:.0f}/{ages[1]:.0f} ms old" if ages else "no rungs yet"
        height = f"{robot.truth.height_m:.2f} m" if robot.truth else ""
        return f"  {time.monotonic() - robot.started_s:6.1f} s  {robot.state_name}  {limbs}  {height}  {latency}  cycle {robot.state['cycle_p99_us']} us"


def up_and_down(operator, screen):
    """Until the time is up or it gives up. Held on the way it turns round."""
    next_way = {"top": "the top; back down", "dock": "at the bottom; up again"}
    down = False
    while True:
        end = operator.climb(down)
        screen.tell(next_way.get(end, f"held ({operator.robot.reason}); the other way"))
        screen.ways.append(end)
        down = not down


def stand(operator):
    """The robot climbs no more, the chain runs on, so that its memory is seen to the end."""
    try:
        while True:
            operator.look()
    except (TimeIsUp, GaveUp, KeyboardInterrupt):
        pass


def climb(operator, screen, options):
    """(end, reason)"""
    down = options.down
    try:
        screen.tell("arming: four claws grasp in the dock, then the dock lets go")
        operator.hang()
        screen.tell("climbing")
        if options.soak:
            up_and_down(operator, screen)
        end = operator.climb()
        if end == "top" and down:
            screen.tell("the top; back down")
            end = operator.climb(down=True)
            if end == "dock":
                operator.park()
        return end, operator.robot.reason if end == "held" else ""
    except TimeIsUp:
        failed = operator.robot.state_name in LATCHED
        return ("stopped", operator.robot.reason) if failed else ("time", "")
    except GaveUp as why:
        return "fallen" if operator.robot.has_fallen else "stopped", str(why)
    except KeyboardInterrupt:
        return "asked", ""


def read_json(path):
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def write_figures(robot, score_json, more, path):
    figures = {**read_json(score_json), **read_json(robot.log_of("figures")), **more}
    path.write_text(json.dumps(figures, indent=2) + "\n", encoding="utf-8")
    for name in FIGURES:
        value = figures.get(name)
        text = "; ".join(f"{s['state']} ({s['reason']}) at {s['at_s']} s" for s in value) or "none" if name == "stops" else value
        print(f"  {name:24}{text}")
    return figures


def advice(figures, was_starved, num_blind):
    """What to do when the computer, not the robot, was at fault."""
    factor = figures.get("real_time_factor") or 0.0
    if factor >= REAL_TIME and not was_starved and num_blind == 0:
        return
    print(f"This computer was too busy for real time (real_time_factor {factor}, it must be 1; perception was too late {num_blind} times; rungs up to "
          f"{figures.get('latency_ms_p99')} ms old): the controller then stops, as it must. End other programs, run as root or with LimitRTPRIO "
          "(docs/OPERATION.md, \"Rights\"), or climb in virtual time: ./scripts/climbs")


def main():
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # as Ctrl-C: no process is left behind
    options = arguments()
    try:
        faults = [robot_faults.parse(text) for text in options.fault]
    except ValueError as error:
        print(f"FAILED: {error}", file=sys.stderr)
        return 2
    overrides = [word for value in options.overrides for word in ("--set", value)]
    robot = LiveRobot(Setup(os.environ["LCM_DEFAULT_URL"], overrides=overrides, robot=robot_arguments(options), notifies=options.soak))
    score_json = robot.log_of("score")
    score_json.unlink(missing_ok=True)
    beside = [subprocess.Popen([robot.setup.bin / "ladder_score", "--live", "--json", score_json], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)]
    if options.spy:
        beside.append(subprocess.Popen([REPOSITORY / "scripts/spy"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
    screen = Screen(robot, robot_faults.FaultPlayer(faults, robot))
    until_s = None if options.seconds is None else time.monotonic() + options.seconds
    watch = soak.Soak(robot) if options.soak else None
    operator = ClimbOperator(robot, screen.look if watch is None else lambda: (screen.look(), watch.look()), until_s,
                             MAX_STOPS if watch is None else math.inf)
    try:
        robot.start_all()
        end, reason = climb(operator, screen, options)
        if watch is not None and end in ("held", "stopped"):
            screen.tell(f"{end}: {reason}; memory is watched to the end")
            stand(operator)
        died = set(robot.dead())
        watched = {} if watch is None else watch.figures()
    finally:
        unclean = robot.end()
        for process in beside:
            process.terminate()
            process.wait()
    if screen.is_terminal:
        print("\r\033[K", end="")
    more = {"end": end, "reason": reason, "stops": operator.stops, "faults": screen.faults}
    if watch is not None:
        more["soak"] = {"ways": screen.ways, **watched}
    figures = write_figures(robot, score_json, more, options.json)
    advice(figures, operator.was_starved, screen.num_blind)
    beyond = []
    if watch is not None:
        print(soak.table(watched))
        beyond = soak.excesses(watched)
    bad = died | set(unclean)
    if bad:
        print(f"FAILED: ended badly: {', '.join(sorted(bad))}; logs are in {robot.setup.folder}/climb-*.log", file=sys.stderr)
        return 1
    if beyond:
        print(f"FAILED: {'; '.join(beyond)}; samples are in {options.json}", file=sys.stderr)
        return 1
    reached = {"top": "the top is reached", "dock": "back in the dock, disarmed", "time": "the time is up", "asked": "asked to stop"}
    if end in reached:
        print(f"Done: {reached[end]}; figures are in {options.json}")
        return 0
    print(f"FAILED: {end}: {reason}; what happened is above and in {robot.setup.folder}/climb-*.log, figures are in {options.json}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
