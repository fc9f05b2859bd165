# SPDX-License-Identifier: BSD-3-Clause
"""lcm-gen's Python codecs of our messages, generated into build/python when they are missing or old."""

import importlib
import pathlib
import shutil
import subprocess
import sys

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent.parent


class CodecError(Exception):
    """The codecs cannot be made; says what to do."""


def load_messages(folder=None):
    """The module ladder_msgs. folder: where it was generated already (build/<preset>/lcmtypes/python)."""
    folder = pathlib.Path(folder) if folder else _generate(REPOSITORY / "build" / "python")
    if not (folder / "ladder_msgs" / "__init__.py").exists():
        raise CodecError(f"{folder} holds no ladder_msgs")
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(folder))
    return importlib.import_module("ladder_msgs")


def _generate(folder):
    types = sorted((REPOSITORY / "lcmtypes").glob("*.lcm"))
    made = folder / "ladder_msgs" / "__init__.py"
    if made.exists() and made.stat().st_mtime >= max(file.stat().st_mtime for file in types):
        return folder
    if shutil.which("lcm-gen") is None:
        raise CodecError("lcm-gen is not installed: run scripts/setup")
    shutil.rmtree(folder, ignore_errors=True)  # lcm-gen appends to __init__.py
    subprocess.run(["lcm-gen", "--python", "--ppath", str(folder), *map(str, types)],
                   check=True, stdout=subprocess.DEVNULL)
    return folder
