# SPDX-License-Identifier: BSD-3-Clause
"""The configuration, judged by the services themselves (--check), and the devices that it names."""

import pathlib
import subprocess
import tomllib

SERVICES = ("sensor_service", "gng_service", "ladder_service", "climb_controller")


def resolved(programs, files, services=SERVICES):
    """Service -> (resolved configuration or None, what it says)."""
    results = {}
    for service in services:
        program = pathlib.Path(programs) / service
        if not program.exists():
            results[service] = (None, f"{program} is not there")
            continue
        arguments = [str(program), "--check"]
        for file in files:
            arguments += ["--config", str(file)]
        got = subprocess.run(arguments, capture_output=True, text=True, check=False, timeout=60)
        if got.returncode:
            results[service] = (None, got.stderr.strip())
            continue
        results[service] = (tomllib.loads(got.stdout), "")
    return results


def check_configuration(report, results):
    """results: of resolved(). Several services say the same of a file that none can read: it is told once."""
    told = set()
    for service, (values, problem) in results.items():
        problem = problem.partition("configuration: ")[2] or problem
        if values is None and problem not in told:
            told.add(problem)
            fix = "reinstall the package" if problem.endswith("is not there") else "mend that line; a restart will not help (exit code 2)"
            report.fault(f"{service}: {problem}", fix)
    if not told:
        report.fine("every service accepts it")
    sensor = results.get("sensor_service", (None, ""))[0]
    if sensor and sensor["sensor"].get("source", "lcm") != "lcm":
        _check_heads(report, sensor["sensor"])


def _check_heads(report, sensor):
    for i in range(4):
        device = sensor.get(f"head_{i}", {}).get("device", "")
        if device.startswith("/") and not pathlib.Path(device).exists():
            report.fault(f"head {i}: there is no {device}", f"plug the head in, or name another device in sensor.head_{i}.device")
