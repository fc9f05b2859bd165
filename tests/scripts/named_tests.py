# SPDX-License-Identifier: BSD-3-Clause
"""The names of all tests of the repository, for documents that promise them."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]


def cases():
    """Every GoogleTest case as "Suite.Name"."""
    names = set()
    for path in (ROOT / "tests").rglob("*.cpp"):
        for suite, name in re.findall(r"^\s*TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", path.read_text(), re.M):
            names.add(f"{suite}.{name}")
    return names


def programs():
    """Every test that ctest knows by name."""
    names = set()
    for path in [*(ROOT / "tests").rglob("CMakeLists.txt"), *(ROOT / "tests").rglob("*.cmake")]:
        text = path.read_text()
        names.update(re.findall(r"^\s*(?:ladder|hardware)_test\(\s*(\w+)", text, re.M))
        names.update(re.findall(r"add_test\(\s*NAME (\w+)", text))
    return names
