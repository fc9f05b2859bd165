# SPDX-License-Identifier: BSD-3-Clause
"""Scores of single runs (the JSON of ladder_score and ladder_scene_run) pooled into one row: errors of all rungs together, not
means of means. What is measured is defined in simulator/score."""
import math

COLUMNS = {
    "runs": "runs", "rungs": "rungs_true", "recall": "recall", "precision": "precision", "axis": "axis_mm_p50", "p95": "axis_mm_p95",
    "depth": "depth_bias_mm", "angle": "angle_deg_p50", "p95 ": "angle_deg_p95", "end": "end_mm_p50", "p95  ": "end_mm_p95",
    "radius": "radius_error_p50", "p95   ": "radius_error_p95", "false": "false_ladders", "unsafe": "unsafe_grasps",
    "offers": "grasps_offered", "ids": "identity_switches", "first": "frames_to_first_p50", "all": "frames_to_all_p50",
    "gone s": "removal_noticed_s_max", "ms": "ms_p50", "p95    ": "ms_p95"}


def quantile(values, q):
    """The smallest value that at least q of them do not exceed, as in simulator/score."""
    values = sorted(values)
    return values[max(0, math.ceil(q * len(values)) - 1)] if values else None


def share(part, whole):
    return part / whole if whole else None


def summary(runs):
    """The metrics of these runs together; None where nothing was measured."""
    def pooled(key):
        return [value for run in runs for value in run.get(key, [])]

    def told(key):
        return [run[key] for run in runs if run.get(key) is not None]

    true = sum(run.get("rungs_true", 0) for run in runs)
    found = sum(round((run.get("recall") or 0.0) * run.get("rungs_true", 0)) for run in runs)
    wrong = sum(run.get("rungs_wrong", 0) for run in runs)
    depth = pooled("depth_errors_mm")
    removed = sum(run.get("rungs_removed", 0) for run in runs)
    noticed = pooled("removals_noticed_s")
    result = {
        "runs": len(runs), "rungs_true": true, "recall": share(found, true), "precision": share(found, found + wrong),
        "depth_bias_mm": sum(depth) / len(depth) if depth else None,
        "false_ladders": sum(run.get("false_ladders", 0) for run in runs),
        "runs_with_false_ladder": sum(1 for run in runs if run.get("false_ladders", 0)),
        "frames": sum(run["frames"] for run in runs),
        "grasps_offered": sum(run.get("grasps_offered", 0) for run in runs),
        "unsafe_grasps": sum(run.get("unsafe_grasps", 0) for run in runs),
        "identity_switches": sum(run.get("identity_switches", 0) for run in runs),
        "frames_to_first_p50": quantile(told("frames_to_first_rung"), 0.5),
        "frames_to_all_p50": quantile(told("frames_to_all_rungs"), 0.5),
        "runs_never_all": sum(1 for run in runs if run.get("rungs_true") and run.get("frames_to_all_rungs") is None),
        "removals_missed": removed - len(noticed), "removal_noticed_s_max": max(noticed, default=None)}
    for name, key in (("axis_mm", "axis_errors_mm"), ("angle_deg", "angle_errors_deg"), ("end_mm", "end_errors_mm"),
                      ("radius_error", "radius_errors"), ("ms", "compute_ms")):
        values = pooled(key)
        result[f"{name}_p50"], result[f"{name}_p95"] = quantile(values, 0.50), quantile(values, 0.95)
    return result


def badness(run):
    """For comparing runs: what is dangerous first, then what is missed, then how far off the worst rung is."""
    missed = run.get("rungs_true", 0) - round((run.get("recall") or 0.0) * run.get("rungs_true", 0))
    return (run.get("false_ladders", 0), run.get("unsafe_grasps", 0), run.get("rungs_wrong", 0), missed,
            run.get("identity_switches", 0), max(run.get("axis_errors_mm", []), default=0.0))


def went_wrong(run):
    return any(badness(run)[:-1])


def worst_runs(runs):
    """The worst run of each kind, in the order of the kinds."""
    worst = {}
    for run in runs:
        if run["has_truth"] and (run["kind"] not in worst or badness(run) > badness(worst[run["kind"]])):
            worst[run["kind"]] = run
    return list(worst.values())


def in_words(run):
    return (f"recall {text(run['recall'])} of {run['rungs_true']}, wrong {run['rungs_wrong']}, false {run['false_ladders']}, unsafe "
            f"{run['unsafe_grasps']}, ids {run['identity_switches']}, candidates {run['rungs_candidates']}")


def text(value):
    if value is None:
        return "-"
    return f"{value:.3f}".rstrip("0").rstrip(".") if isinstance(value, float) else str(value)


def heading():
    return f"{'':>12}" + "".join(f"{name.strip():>8}" for name in COLUMNS)


def line(name, row):
    return f"{name:>12}" + "".join(f"{text(row[key]):>8}" for key in COLUMNS.values())
