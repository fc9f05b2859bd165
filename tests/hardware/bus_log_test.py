#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A candump log of the real bus, read by decoders that this project did not write: for tshark every frame is CANopen and none is
malformed, and canmatrix with the DBC reads the same values as the controller's own codec.
usage: bus_log_test.py LOG FRAME_TOOL leg_servos.dbc"""
import collections
import contextlib
import io
import pathlib
import re
import subprocess
import sys

LINE = re.compile(r"\(\d+\.\d{6}\) \S+ ([0-9A-F]{3})#((?:[0-9A-F]{2})*)")
# Service data has no place in a DBC: its meaning depends on the object.
SERVICE_DATA = range(0x580, 0x680)


def tshark_rows(log):
    command = ["tshark", "-r", str(log), "-d", "can.subdissector,canopen", "-T", "fields"]
    for field in ("_ws.col.Protocol", "_ws.malformed", "_ws.col.Info"):
        command += ["-e", field]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return [line.split("\t") for line in done.stdout.splitlines()]


def own_values(tool, lines):
    """What the controller's codec reads in each line: {name: raw value}."""
    done = subprocess.run([tool, "decode"], input="\n".join(lines) + "\n", capture_output=True, text=True, check=True)
    for line in done.stdout.splitlines():
        yield {name: int(value) for name, value in (pair.split("=") for pair in line.split()[1:])}


def load_matrix(dbc):
    import canmatrix.formats  # noqa: PLC0415  (Debian's module says much on import)
    return canmatrix.formats.loadp_flat(str(dbc))


def differences(matrix, lines, values):
    """Yields (line, problem) where the DBC disagrees; counts the frames of each kind in `seen`."""
    frames = {frame.arbitration_id.id: frame for frame in matrix.frames}
    for line, own in zip(lines, values, strict=True):
        identifier, payload = LINE.fullmatch(line).groups()
        identifier = int(identifier, 16)
        if identifier in SERVICE_DATA:
            continue
        if identifier not in frames:
            yield line, "not in the DBC"
            continue
        decoded = frames[identifier].decode(bytes.fromhex(payload)) if payload else {}
        read = {name: signal.raw_value for name, signal in decoded.items()}
        if read != own:
            yield line, f"DBC {read}, codec {own}"


def main():
    log, tool, dbc = pathlib.Path(sys.argv[1]), sys.argv[2], pathlib.Path(sys.argv[3])
    lines = log.read_text().splitlines()
    odd = [line for line in lines if not LINE.fullmatch(line)]
    assert not odd, f"not candump lines: {odd[:3]}"
    rows = tshark_rows(log)
    assert len(rows) == len(lines) > 1000, (len(rows), len(lines))
    strange = [row for row in rows if row[0] != "CANopen" or row[1] or "alformed" in row[2]]
    assert not strange, f"{len(strange)} frames, the first: {strange[0]}"
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        matrix = load_matrix(dbc)
    wrong = list(differences(matrix, lines, own_values(tool, lines)))
    assert not wrong, f"{len(wrong)} frames, the first: {wrong[0]}"
    kinds = collections.Counter(int(line.rsplit(" ", 1)[1].split("#")[0], 16) & 0x780 for line in lines)
    print(f"{log.name}: {len(lines)} frames, 0 malformed, DBC and codec agree;",
          ", ".join(f"{kind:03X}h: {count}" for kind, count in sorted(kinds.items())))


if __name__ == "__main__":
    main()
