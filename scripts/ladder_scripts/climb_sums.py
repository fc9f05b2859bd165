# SPDX-License-Identifier: BSD-3-Clause
"""Adds the climbs of one run (one JSON object per line) to a file of climbs and sums them up. Exit 1 when a robot fell, or a plain
ladder's top was not reached."""
import collections
import json
import pathlib
import sys


def sums(climbs):
    ends = collections.Counter((c.get("damage", "?"), c["end"], c.get("reason", "")) for c in climbs)
    plain = [c for c in climbs if c.get("damage") == "plain"]
    return {
        "climbs": len(climbs),
        "plain": len(plain),
        "plain_tops": sum(c["end"] == "top" for c in plain),
        "tops": sum(c["end"] == "top" for c in climbs),
        "falls": sum(c.get("falls", 1) for c in climbs),
        "unsafe_grasps": sum(c.get("unsafe_grasps", 0) for c in climbs),
        "violations": sum(c.get("violations", 0) for c in climbs),
        "ends": [{"damage": d, "end": e, "reason": r, "climbs": n} for (d, e, r), n in sorted(ends.items())],
    }


def main():
    lines, target, seconds = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), int(sys.argv[3])
    before = json.loads(target.read_text()) if target.exists() else {"each": [], "minutes": 0.0}
    each = before["each"] + [json.loads(line) for line in lines.read_text().splitlines()]
    result = sums(each)
    result["minutes"] = round(before["minutes"] + seconds / 60, 1)
    print(json.dumps(result, indent=1))
    result["each"] = each
    target.write_text(json.dumps(result, indent=1) + "\n")
    lines.unlink()
    good = result["falls"] == 0 and result["plain_tops"] == result["plain"]
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
