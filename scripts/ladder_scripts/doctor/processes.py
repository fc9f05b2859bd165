# SPDX-License-Identifier: BSD-3-Clause
"""Who has which socket, from /proc. Processes of other users are invisible without root."""

import os
import pathlib

PROC = pathlib.Path("/proc")


def owner_of_socket(inode):
    """The pid of a process that has this socket open, or None."""
    wanted = f"socket:[{inode}]"
    for process in PROC.iterdir():
        if not process.name.isdigit():
            continue
        try:
            for entry in os.scandir(process / "fd"):
                if os.readlink(entry.path) == wanted:
                    return int(process.name)
        except OSError:
            continue
    return None


def owner_of_port(port):
    """The pid of a process that sends from this local UDP port, or None."""
    for line in (PROC / "net/udp").read_text().splitlines()[1:]:
        words = line.split()
        if int(words[1].split(":")[1], 16) == port:
            return owner_of_socket(int(words[9]))
    return None


def name_of(pid):
    try:
        return (PROC / str(pid) / "comm").read_text().strip()
    except OSError:
        return "a process that has ended"


def state_of(pid):
    """R, S, D, T (stopped), ...; '?' where the process is gone."""
    try:
        return (PROC / str(pid) / "stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return "?"
