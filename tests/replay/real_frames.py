# SPDX-License-Identifier: BSD-3-Clause
"""Runs recordings of real sensors (folder LADDER_DATA, or the repository's sibling shared/data) through the chain."""

import os
import pathlib
import subprocess
import sys
import typing

sys.dont_write_bytecode = True
REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "scripts"))
from ladder_scripts import codecs, lcm_log  # noqa: E402

FRAMES = 30


class Frame(typing.NamedTuple):
    """The messages of one frame."""

    cloud: object
    topology: object
    ladder: object


class Missing(Exception):
    """A recording or a program is not there; says which."""


def recording(name):
    """The path of a recording, or Missing."""
    folder = pathlib.Path(os.environ.get("LADDER_DATA") or REPOSITORY.parent / "shared" / "data")
    if not (folder / name).exists():
        raise Missing(f"{name} is not there: LADDER_DATA names the folder of recordings")
    return folder / name


def understand(name, folder, *options):
    """Each Frame of a recording repeated FRAMES times."""
    replay = REPOSITORY / "build/release/bin/ladder_replay"
    if not replay.exists():
        raise Missing("ladder_replay is not built")
    raw, understood = pathlib.Path(folder) / "raw.lcm", pathlib.Path(folder) / "understood.lcm"
    subprocess.run([REPOSITORY / "scripts/pcd_to_log.py", recording(name), "-o", raw, "--frames", str(FRAMES), *options],
                   check=True, stdout=subprocess.DEVNULL)
    subprocess.run([replay, raw, "-o", understood, "--config", REPOSITORY / "config/robot.toml"],
                   check=True, stderr=subprocess.DEVNULL)
    messages = codecs.load_messages()
    types = {"LADDER_CLOUD": messages.point_cloud_t, "LADDER_TOPOLOGY": messages.topology_t, "LADDER_RUNGS": messages.ladder_t}
    newest, frames = {}, []
    for _, channel, data in lcm_log.read_events(understood.read_bytes()):
        if channel in types:
            newest[channel] = types[channel].decode(data)
        if channel == "LADDER_RUNGS":
            frames.append(Frame(*(newest[name] for name in types)))
    return frames
