#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/spy says what is missing, and with everything there finds each type and each plugin once.

    spy_test.py SPY LADDER_MSGS_JAR NUM_TYPES

The start of the real window needs xvfb-run; without it that part is skipped (exit code 77).
"""

import os
import shutil
import signal
import subprocess
import sys
import time

SPY, JAR, NUM_TYPES = sys.argv[1], sys.argv[2], int(sys.argv[3])
START_LIMIT_S = 60


def expect(said, code, arguments=(), **environment):
    """The spy ends with this code and says these words."""
    clean = {key: value for key, value in os.environ.items() if not key.startswith("LADDER_")}
    environment = {**clean, "LADDER_MSGS_JAR": JAR, **environment}
    result = subprocess.run([SPY, *arguments], env=environment, capture_output=True, text=True, timeout=30)
    assert result.returncode == code and said in result.stdout + result.stderr, (said, result)


def test_messages():
    expect("usage: scripts/spy", 0, ["--help"])
    expect("unknown argument '--fast'", 2, ["--fast"])
    expect("--url needs a value", 2, ["--url"])
    expect("ninja -C build/release ladder_msgs_jar", 3, LADDER_MSGS_JAR="/nowhere/a.jar")
    expect("apt install liblcm-java", 3, LADDER_LCM_JAR="/nowhere/lcm.jar")
    expect("apt install libjchart2d-java", 3, LADDER_CHART_JAR="/nowhere/chart.jar")
    expect("no display", 3, DISPLAY="")


def test_start():
    """Types and plugins would be found twice if the class path were given twice."""
    command = ["xvfb-run", "-a", SPY, "--url", "udpm://239.255.76.67:7792?ttl=0"]
    environment = {**os.environ, "LADDER_MSGS_JAR": JAR, "CLASSPATH": JAR}
    spy = subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True
    )
    wanted = {f"Found {NUM_TYPES} LCM types", "Found 4 plugins"}
    said = []
    deadline = time.monotonic() + START_LIMIT_S
    while not wanted <= set(said) and time.monotonic() < deadline:
        line = spy.stdout.readline()
        if not line:
            break
        said.append(line.strip())
    os.killpg(spy.pid, signal.SIGTERM)
    spy.wait(timeout=30)
    assert wanted <= set(said), said


if __name__ == "__main__":
    test_messages()
    if shutil.which("xvfb-run") is None:
        print("SKIPPED: the window (install xvfb)")
        sys.exit(77)
    test_start()
