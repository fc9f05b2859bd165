# SPDX-License-Identifier: BSD-3-Clause
"""What the compiler sees of a source, for check_tidy:  preprocessed.py COMPILE_COMMANDS SOURCE"""
import json
import pathlib
import shlex
import subprocess
import sys

source = pathlib.Path(sys.argv[2]).resolve()
for entry in json.loads(pathlib.Path(sys.argv[1]).read_text()):
    if pathlib.Path(entry["directory"], entry["file"]).resolve() != source:
        continue
    arguments = shlex.split(entry["command"])
    while not arguments[0].endswith(("clang++-14", "clang++")):  # ccache
        arguments.pop(0)
    output = arguments.index("-o")
    del arguments[output:output + 2]
    sys.exit(subprocess.run([*arguments, "-E"], cwd=entry["directory"], check=False).returncode)
print(f"{source}: not part of this build", file=sys.stdout)  # checked with clang-tidy's guess of flags; changes change its text
sys.stdout.write(source.read_text())
