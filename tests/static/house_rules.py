#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The house rules that a machine can check: which room may include what, one SPDX line per file, no clock, file, thread, log or
message inside an algorithm library, no forbidden names. docs/ARCHITECTURE.md says why."""
import pathlib
import re
import subprocess
import sys

# room -> prefixes of quoted includes it may use. The standard library, Eigen and Debian's libraries are bracketed includes.
ALLOWED = {
    "runtime/base": ["base/"],
    "runtime": ["base/", "runtime/", "ladder_msgs/"],
    "sensor_service/tof": ["base/", "tof/"],
    "sensor_service/sources": ["base/", "sources/", "tof/"],
    "sensor_service": ["base/", "runtime/", "ladder_msgs/", "tof/", "sources/", "sensor_service/"],
    "gng_service/ddgng": ["base/", "ddgng/"],
    "gng_service": ["base/", "runtime/", "ladder_msgs/", "ddgng/", "gng_service/"],
    "ladder_service/ladder": ["base/", "ladder/"],
    "ladder_service": ["base/", "runtime/", "ladder_msgs/", "ladder/", "ladder_service/"],
    "climb_controller/climb": ["base/", "climb/"],
    "climb_controller/can": ["base/", "can/"],
    "climb_controller/gpio": ["base/", "gpio/"],
    "climb_controller": ["base/", "runtime/", "ladder_msgs/", "climb/", "can/", "gpio/", "climb_controller/"],
    "viewer": ["base/", "runtime/", "ladder_msgs/", "viewer/"],
    "relay": ["base/", "runtime/", "ladder_msgs/", "relay/"],
    "simulator": ["base/", "runtime/", "ladder_msgs/", "simulator/"],
    "robot_in_a_box": ["base/", "runtime/", "ladder_msgs/", "sensor_service/", "gng_service/", "ladder_service/", "simulator/",
                       "climb_controller/", "climb/", "can/", "gpio/", "robot_in_a_box/"],
}
PURE = ("sensor_service/tof", "gng_service/ddgng", "ladder_service/ladder", "climb_controller/climb")
# What an algorithm library may include in brackets besides the C++ standard library.
PURE_BRACKETED = {"sensor_service/tof": ("Eigen/", "hwy/"), "gng_service/ddgng": ("Eigen/", "hwy/"), "ladder_service/ladder": ("Eigen/",),
                   "climb_controller/climb": ("Eigen/",)}
IMPURE_STANDARD = {"chrono", "ctime", "fstream", "iostream", "thread", "mutex", "condition_variable", "future", "filesystem", "random",
                   "unordered_map", "unordered_set", "cstdio"}
INCLUDE = re.compile(r'^\s*#\s*include\s+(["<])([^">]+)[">]', re.MULTILINE)
SPDX = "SPDX-License-Identifier: BSD-3-Clause"
NEEDS_SPDX = {".h", ".cpp", ".py", ".sh", ".cmake", ".lcm", ".toml", ".java", ".in", ".js", ".mjs", ".css", ".html"}


def room_of(path):
    """The longest room that the file lies in, or None."""
    rooms = [room for room in ALLOWED if path.startswith(room + "/")]
    return max(rooms, key=len, default=None)


def check_includes(path, text):
    room = room_of(path)
    if room is None or not path.endswith((".h", ".cpp")):
        return
    for kind, name in INCLUDE.findall(text):
        if kind == '"' and not any(name.startswith(prefix) for prefix in ALLOWED[room]):
            yield f'{path}: {room} may not include "{name}"'
        if kind == "<" and room in PURE:
            standard = "/" not in name and "." not in name
            if standard and name in IMPURE_STANDARD:
                yield f"{path}: an algorithm library uses <{name}>"
            if not standard and not name.startswith(PURE_BRACKETED[room]):
                yield f"{path}: an algorithm library may not include <{name}>"


def check_file(path, text):
    file = pathlib.PurePath(path)
    if (file.suffix in NEEDS_SPDX or file.name == "CMakeLists.txt") and SPDX not in text[:300]:
        yield f"{path}: no line '{SPDX}' on top"
    if file.suffix in (".h", ".cpp") and re.search(r"\b(TODO|FIXME|XXX)\b", text):
        yield f"{path}: unfinished business (TODO, FIXME, XXX) belongs into an issue"
    if file.suffix == ".h" and "#pragma once" not in text:
        yield f"{path}: no #pragma once"
    if re.search(r"-ffast-math|-march=native", text) and file.name in ("CMakeLists.txt", "targets.cmake", "CMakePresets.json"):
        yield f"{path}: -ffast-math and -march=native change results between machines"
    yield from check_includes(path, text)


PARAMETERS = re.compile(r"struct (\w+Params|JointLimits|DriveKind) \{(.*?)\n\};", re.DOTALL)
PARAMETER = re.compile(r"^  (?:double|int|bool|std::int64_t) (\w+)(?: = [^;]+)?;", re.MULTILINE)
# Decided by other keys: the service derives them.
DERIVED = {"on_ladder", "power_off_holds"}


def check_climb_configuration(root):
    """Each parameter of the climbing library can be set: climb_controller/config.cpp reads a key of its name."""
    read = (root / "climb_controller/config.cpp").read_text()
    for header in sorted((root / "climb_controller/climb").glob("*.h")):
        for struct, body in PARAMETERS.findall(header.read_text()):
            for field in PARAMETER.findall(body):
                if field not in DERIVED and f'"{field}"' not in read:
                    yield f"{header.relative_to(root)}: {struct}.{field} is not read in climb_controller/config.cpp"


def main():
    root = pathlib.Path(__file__).resolve().parents[2]
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=root, capture_output=True, text=True, check=True)
    problems, checked = [], 0
    for path in listed.stdout.splitlines():
        file = root / path
        if not file.is_file():
            continue
        try:
            text = file.read_text()
        except UnicodeDecodeError:
            continue
        checked += 1
        problems.extend(check_file(path, text))
    problems.extend(check_climb_configuration(root))
    print("\n".join(problems) if problems else f"house rules hold in {checked} files")
    return 1 if problems or not checked else 0


if __name__ == "__main__":
    sys.exit(main())
