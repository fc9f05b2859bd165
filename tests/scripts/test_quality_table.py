#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How scripts/score pools runs into rows, and which scenes it makes."""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
from ladder_scripts import quality_scenes, quality_table  # noqa: E402


def run(**values):
    return {"frames": 30, "rungs_true": 4, "recall": 1.0, "rungs_wrong": 0, "false_ladders": 0, "axis_errors_mm": [1.0, 2.0, 3.0, 4.0],
            "frames_to_first_rung": 3, "frames_to_all_rungs": 4, "grasps_offered": 10, "unsafe_grasps": 0, **values}


class Summary(unittest.TestCase):
    def test_errors_are_pooled_not_averaged(self):
        row = quality_table.summary([run(), run(axis_errors_mm=[100.0])])
        self.assertEqual(row["axis_mm_p50"], 3.0)
        self.assertEqual(row["axis_mm_p95"], 100.0)

    def test_recall_weighs_rungs_and_precision_counts_wrong_ones_anywhere(self):
        negative = {"frames": 30, "rungs_true": 0, "recall": None, "rungs_wrong": 2, "false_ladders": 5}
        row = quality_table.summary([run(), run(rungs_true=1, recall=0.0), negative])
        self.assertEqual(row["recall"], 0.8)
        self.assertAlmostEqual(row["precision"], 4 / 6)
        self.assertEqual((row["false_ladders"], row["runs_with_false_ladder"]), (5, 1))

    def test_what_was_not_measured_is_none(self):
        row = quality_table.summary([{"frames": 30, "rungs_true": 0, "recall": None}])
        for key in ("recall", "precision", "axis_mm_p50", "depth_bias_mm", "frames_to_first_p50", "removal_noticed_s_max", "ms_p95"):
            self.assertIsNone(row[key], key)
        self.assertEqual(len(quality_table.line("x", row).split()), 1 + len(quality_table.COLUMNS))

    def test_runs_that_never_confirm_are_counted(self):
        row = quality_table.summary([run(frames_to_all_rungs=None), run()])
        self.assertEqual((row["runs_never_all"], row["frames_to_all_p50"]), (1, 4))

    def test_a_removal_that_nobody_notices_is_missed(self):
        row = quality_table.summary([run(rungs_removed=2, removals_noticed_s=[0.4])])
        self.assertEqual((row["removals_missed"], row["removal_noticed_s_max"]), (1, 0.4))

    def test_quantiles_by_nearest_rank(self):
        self.assertEqual([quality_table.quantile([3, 1, 2], q) for q in (0.0, 0.5, 0.95)], [1, 2, 3])
        self.assertIsNone(quality_table.quantile([], 0.5))


class Scenes(unittest.TestCase):
    def test_tuning_and_reporting_seeds_never_meet(self):
        seeds = {name: {run.words[-1] for run in quality_scenes.runs_of(["wall"], first, 100, 30)}
                 for name, first in quality_scenes.FIRST_SEED.items()}
        self.assertFalse(seeds["tune"] & seeds["report"])

    def test_each_place_has_its_own_seed_and_every_head_dies_in_turn(self):
        runs = quality_scenes.runs_of(["head_dead"], 1, 1, 30)
        self.assertEqual(len({run.words[-1] for run in runs}), len(runs))
        self.assertEqual({run.words[run.words.index("--dead_heads") + 1] for run in runs}, {0, 1, 2, 3})

    def test_what_is_held_out_is_not_in_the_grid(self):
        self.assertFalse(set(quality_scenes.HELD_OUT) & set(quality_scenes.KINDS))
        places = {run.words[-4:-2] for run in quality_scenes.runs_of(quality_scenes.KINDS, 1, 1, 30)}
        held_out = {run.words[-4:-2] for run in quality_scenes.runs_of(quality_scenes.HELD_OUT, 1, 1, 30)}
        self.assertEqual(len(held_out), len(quality_scenes.HELD_OUT_PLACES))
        self.assertFalse(places & held_out)

    def test_every_nth_place_keeps_its_seed(self):
        everything = quality_scenes.runs_of(["wall"], 1, 1, 30)
        self.assertEqual(quality_scenes.runs_of(["wall"], 1, 1, 30, every=4), everything[::4])


if __name__ == "__main__":
    unittest.main()
