# SPDX-License-Identifier: BSD-3-Clause
"""For check_tidy.  preprocessed.py COMPILE_COMMANDS: the sources of a build.  With SOURCE: what the compiler sees of it."""
import json
import pathlib
import shlex
import subprocess
import sys

entries = json.loads(pathlib.Path(sys.argv[1]).read_text())
if len(sys.argv) == 2:
    print(*sorted({entry["file"] for entry in entries}), sep="\n")
    sys.exit(0)
entry = next(entry for entry in entries if entry["file"] == sys.argv[2])
arguments = shlex.split(entry["command"])
while not arguments[0].endswith(("clang++-14", "clang++")):  # ccache
    arguments.pop(0)
output = arguments.index("-o")
del arguments[output:output + 2]
sys.exit(subprocess.run([*arguments, "-E"], cwd=entry["directory"], check=False).returncode)
