# SPDX-License-Identifier: BSD-3-Clause
"""Adds climbs (one JSON object per line) to a file of climbs and sums up all of them. A climb that is climbed again (the same ladder:
plain or damaged, seed, number of rungs) takes the place of the one before. The lines are taken away once they are in the file.
Exit 1 when a robot fell, a claw closed on an unsafe rung, an invariant was violated, a climb crashed or was not ended, a plain
ladder's top was not reached, or from there, where it was asked for, the dock."""
import collections
import json
import pathlib
import sys

UNFINISHED = ("crashed", "too long")


def ladder_of(climb):
    return (climb["damage"] != "plain", climb["seed"], climb["rungs"])


def merge(before, after):
    """Both in the order of their ladders; of one ladder only the last climb."""
    climbs = {ladder_of(c): c for c in before + after}
    return [climbs[ladder] for ladder in sorted(climbs)]


def sums(climbs):
    ends = collections.Counter((c["damage"], c["end"], c.get("reason", "")) for c in climbs)
    plain = [c for c in climbs if c["damage"] == "plain"]

    def total(key):
        return sum(c.get(key, 0) for c in climbs)

    def most(key):
        return max((c.get(key, 0) for c in climbs), default=0)

    return {
        "climbs": len(climbs),
        "plain": len(plain),
        "plain_tops": sum(c["end"] == "top" for c in plain),
        "plain_down": sum("down" in c for c in plain),
        "plain_docks": sum(c.get("down") == "dock" for c in plain),
        "damaged": len(climbs) - len(plain),
        "damaged_tops": sum(c["end"] == "top" for c in climbs if c["damage"] != "plain"),
        "damaged_holds": sum(c["end"] == "held" for c in climbs if c["damage"] != "plain"),
        "damaged_docks": sum(c.get("down") == "dock" for c in climbs if c["damage"] != "plain"),
        "unfinished": sum(c["end"] in UNFINISHED or c.get("down") in UNFINISHED for c in climbs),
        "falls": total("falls"),
        "unsafe_grasps": total("unsafe_grasps"),
        "violations": total("violations"),
        "grasps_tried": total("grasps_tried"),
        "grasps_failed": total("grasps_failed"),
        "most_torque_Nm": most("peak_joint_torque_Nm"),
        "most_grip_N": most("peak_grip_N"),
        "most_drift_mm": most("pose_drift_mm"),
        "minutes": round(total("wall_s") / 60.0, 1),
        "ends": [{"damage": d, "end": e, "reason": r, "climbs": n} for (d, e, r), n in sorted(ends.items())],
    }


def is_good(result):
    nothing_bad = not any(result[key] for key in ("falls", "unsafe_grasps", "violations", "unfinished"))
    all_there = result["plain_tops"] == result["plain"] and result["plain_docks"] == result["plain_down"]
    return nothing_bad and all_there and result["climbs"] > 0


def main():
    lines, target = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    before = json.loads(target.read_text())["each"] if target.exists() else []
    new = [json.loads(line) for line in lines.read_text().splitlines()] if lines.exists() else []
    each = merge(before, new)
    result = sums(each)
    print(json.dumps(result, indent=1))
    whole = target.with_suffix(target.suffix + ".new")  # a file that is half written takes the place of none
    whole.write_text(json.dumps(result | {"each": each}, indent=1) + "\n")
    whole.replace(target)
    lines.unlink(missing_ok=True)
    return 0 if is_good(result) else 1


if __name__ == "__main__":
    sys.exit(main())
