#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every script explains itself, and what it refuses it refuses with a message that says what to do. Nothing is built or started."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
# setup takes no options: it acts when called, so it is not called here.
EXPLAINED = sorted(path for path in SCRIPTS.iterdir() if path.is_file() and os.access(path, os.X_OK) and path.name != "setup")
NO_LCM = {"LCM_DEFAULT_URL": "memq://"}


def run(script, *arguments, **environment):
    return subprocess.run([SCRIPTS / script, *arguments], capture_output=True, text=True, timeout=60,
                          env={**os.environ, **NO_LCM, **environment}, check=False)


def options_of(text):
    """The options that a script's own argument loop or argparse knows."""
    in_shell = re.findall(r"^\s*((?:-{1,2}[\w-]+)(?: \| -{1,2}[\w-]+)*)\)", text, re.M)
    in_python = re.findall(r'add_argument\(\s*((?:"-{1,2}[\w-]+"(?:,\s*)?)+)', text)
    return {option for group in in_shell + in_python for option in re.findall(r"--[\w-]+", group)} - {"--help"}


class Help(unittest.TestCase):
    def test_scripts_are_found(self):
        self.assertGreaterEqual({path.name for path in EXPLAINED},
                                {"bench", "demo", "draw.py", "pcd_to_log.py", "record", "regress", "replay", "spy", "test"})

    def test_help_works_and_names_every_option(self):
        for path in EXPLAINED:
            result = run(path, "--help")
            with self.subTest(path.name):
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(result.stderr, "")
                self.assertIn("usage:", result.stdout)
                for option in options_of(path.read_text()):
                    if option != "--out":  # the long form of -o
                        self.assertIn(option, result.stdout)

    def test_unknown_option_is_named(self):
        for path in EXPLAINED:
            result = run(path, "--no-such-option")
            with self.subTest(path.name):
                self.assertNotEqual(result.returncode, 0)
                self.assertIn("usage:", result.stderr)
                if "import argparse" not in path.read_text():  # it complains about missing arguments first
                    self.assertIn("--no-such-option", result.stderr)

    def test_readme_lists_every_script(self):
        readme = (SCRIPTS / "README.md").read_text()
        for path in EXPLAINED:
            self.assertIn(f"`{path.name}`", readme)


class Refusals(unittest.TestCase):
    def refused(self, *arguments, **environment):
        result = run(*arguments, **environment)
        self.assertNotEqual(result.returncode, 0)
        self.assertLess(len(result.stderr.splitlines()), 20, "one message, not a flood")
        return result.stderr

    def test_spy_without_jar(self):
        self.assertIn("ninja -C build/none ladder_msgs_jar", self.refused("spy", "--preset", "none", LADDER_MSGS_JAR=""))

    def test_spy_without_display_or_java(self):
        with tempfile.NamedTemporaryFile(suffix=".jar") as jar:
            message = self.refused("spy", DISPLAY="", LADDER_MSGS_JAR=jar.name)
        self.assertRegex(message, "apt install|DISPLAY is not set")

    def test_record_needs_a_new_file(self):
        self.assertIn("which file", self.refused("record"))
        with tempfile.NamedTemporaryFile() as existing:
            self.assertIn("choose another name", self.refused("record", existing.name))

    def test_replay_needs_a_readable_log(self):
        self.assertIn("which log", self.refused("replay"))
        self.assertIn("/no/such.lcm cannot be read", self.refused("replay", "/no/such.lcm"))

    def test_options_without_value(self):
        for script, option in (("demo", "--seconds"), ("replay", "--json"), ("regress", "--log"), ("bench", "--json"), ("spy", "--url")):
            with self.subTest(script):
                self.assertIn(f"{option} needs", self.refused(script, option))

    def test_bench_needs_a_whole_sketch(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertIn("gen.cpp is missing", self.refused("bench", "--no-build", "--yardstick", folder))
        self.assertIn("whole number", self.refused("bench", "--no-build", "--repetitions", "0"))
        self.assertIn("whole number", self.refused("bench", "--no-build", "--latency", "a while"))


if __name__ == "__main__":
    unittest.main()
