#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/score with the real programs: a log scores as the scene it was recorded from, with truth, without, damaged; pictures.
usage: test_score.py FOLDER_OF_PROGRAMS"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
sys.path.insert(0, str(SCRIPTS))
from ladder_scripts import lcm_log, quality_table  # noqa: E402

PROGRAMS = pathlib.Path(sys.argv.pop(1))
FRAMES = 8
SCENE = ["--scene", "bent", "--seed", "3", "--sway_m", "0.02", "--sway_hz", "0.5", "--frames", str(FRAMES)]
TIMES = ("compute_ms", "compute_ms_p50", "compute_ms_p95", "messages", "messages_lost_by_channel", "kind", "command")


def run(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)


class Logs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="ladder_test_score_")
        cls.log, direct = cls.path("scene.lcm"), cls.path("direct.json")
        done = run(PROGRAMS / "ladder_scene_run", *SCENE, "-c", SCRIPTS.parent / "config/robot.toml", "--log", cls.log, "--json", direct)
        assert done.returncode == 0, done.stderr
        cls.direct = json.loads(direct.read_text())

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def path(cls, name):
        return pathlib.Path(cls.folder.name) / name

    def score(self, log):
        """The one run of scripts/score --log, with its table."""
        told = self.path("told.json")
        done = run(SCRIPTS / "score", "--bin", PROGRAMS, "--log", log, "--json", told)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(told.read_text())["runs"][0], done.stdout

    def test_a_log_scores_as_the_scene_it_was_recorded_from(self):
        told, _ = self.score(self.log)
        self.assertGreater(told["recall"], 0.5)
        self.assertEqual(told["messages"]["LADDER_TRUTH"], FRAMES)
        for key, value in self.direct.items():
            if key not in TIMES:
                self.assertEqual(told[key], value, key)

    def test_a_log_without_truth_has_no_errors_but_frames(self):
        bare = self.path("bare.lcm")
        with bare.open("wb") as file:
            writer = lcm_log.LogWriter(file)
            for utime_us, channel, message in lcm_log.read_events(self.log.read_bytes()):
                if channel != "LADDER_TRUTH":
                    writer.write(utime_us, channel, message)
        told, table = self.score(bare)
        self.assertFalse(told["has_truth"])
        self.assertEqual((told["frames"], told["rungs_confirmed"]), (FRAMES, self.direct["rungs_confirmed"]))
        self.assertNotIn("recall", told)
        self.assertIn("total", table)

    def test_a_log_cut_short_is_scored_as_far_as_it_goes(self):
        cut, whole = self.path("cut.lcm"), self.log.read_bytes()
        cut.write_bytes(whole[:len(whole) * 2 // 3])
        told, _ = self.score(cut)
        self.assertTrue(0 < told["frames"] < FRAMES, told["frames"])
        self.assertTrue(told["has_truth"])

    def test_what_is_no_log_is_refused_in_words(self):
        noise = self.path("noise.lcm")
        noise.write_bytes(bytes(range(256)) * 400)
        done = run(SCRIPTS / "score", "--bin", PROGRAMS, "--log", noise)
        self.assertEqual(done.returncode, 1)
        self.assertIn("holds no LADDER_TOF", done.stderr)
        self.assertNotIn("Traceback", done.stderr)

    def test_pictures_show_the_truth_beside_what_was_found(self):
        pictures = self.path("pictures")
        done = run(SCRIPTS / "score", "--bin", PROGRAMS, "--scenes", "bent,free_bar", "--every", "15", "--frames", FRAMES, "--pictures", pictures)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual({file.name for file in pictures.iterdir()}, {"bent.svg", "free_bar.svg"})
        lines = [element for element in xml.etree.ElementTree.parse(pictures / "bent.svg").iter() if element.tag.endswith("}line")]
        dashed = [element.get("stroke") for element in lines if element.get("stroke-dasharray")]
        self.assertEqual(dashed.count("#1f5fd6"), 2 + 7)  # rails, sound rungs
        self.assertEqual(dashed.count("#a020c0"), 1)  # the bent one
        self.assertIn("--scene bent", (pictures / "bent.svg").read_text())


class Worst(unittest.TestCase):
    def test_danger_is_worse_than_a_miss_and_a_miss_worse_than_an_error(self):
        fine = {"kind": "a", "has_truth": True, "rungs_true": 4, "recall": 1.0, "axis_errors_mm": [1.0]}
        runs = [fine, {**fine, "axis_errors_mm": [9.0]}, {**fine, "recall": 0.75}, {**fine, "unsafe_grasps": 1}, {**fine, "false_ladders": 1}]
        for i in range(1, len(runs)):
            self.assertEqual(quality_table.worst_runs(runs[:i + 1]), [runs[i]])
        self.assertEqual([quality_table.went_wrong(one) for one in runs], [False, False, True, True, True])
        self.assertEqual(quality_table.worst_runs([{"kind": "a", "has_truth": False}]), [])


if __name__ == "__main__":
    unittest.main()
