# SPDX-License-Identifier: BSD-3-Clause
"""LCM event logs, read and written without LCM. Same events, same bytes."""

import struct

MAGIC = 0xEDA1DA01
HEAD = struct.Struct(">IqqII")  # magic, event number, time [us], bytes of channel, bytes of message


class LogError(Exception):
    """The file is not a whole log."""


class LogWriter:
    """Appends events; numbers them from 0."""

    def __init__(self, file):
        self._file = file
        self.num_events = 0

    def write(self, utime_us, channel, message):
        name = channel.encode("ascii")
        self._file.write(HEAD.pack(MAGIC, self.num_events, utime_us, len(name), len(message)))
        self._file.write(name)
        self._file.write(message)
        self.num_events += 1


def read_events(data):
    """Yields (utime_us, channel, message bytes) of each event; raises LogError at damage."""
    at = 0
    while at < len(data):
        if len(data) - at < HEAD.size:
            raise LogError(f"cut short in the head of the event at byte {at}")
        magic, _, utime_us, channel_bytes, message_bytes = HEAD.unpack_from(data, at)
        if magic != MAGIC:
            raise LogError(f"no event begins at byte {at}")
        start = at + HEAD.size
        end = start + channel_bytes + message_bytes
        if end > len(data):
            raise LogError(f"cut short in the event at byte {at}")
        channel = data[start : start + channel_bytes].decode("ascii")
        yield utime_us, channel, data[start + channel_bytes : end]
        at = end
