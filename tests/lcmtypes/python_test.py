#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Each sample in a log (publish_samples) decodes with the Python codecs and encodes again to the same bytes.

    python_test.py FOLDER_OF_ladder_msgs SAMPLES_LOG
"""

import pathlib
import struct
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
import ladder_msgs  # noqa: E402

EVENT_HEAD = struct.Struct(">IqqII")  # magic, number, time, lengths of channel and message
MAGIC = 0xEDA1DA01


def events(log):
    """(channel, message) of each event."""
    at = 0
    while at < len(log):
        magic, _, _, channel_bytes, message_bytes = EVENT_HEAD.unpack_from(log, at)
        assert magic == MAGIC
        start = at + EVENT_HEAD.size + channel_bytes
        yield log[at + EVENT_HEAD.size : start].decode(), log[start : start + message_bytes]
        at = start + message_bytes


def main():
    types = [getattr(ladder_msgs, name) for name in dir(ladder_msgs) if name.endswith("_t")]
    types = {kind._get_packed_fingerprint(): kind for kind in types if isinstance(kind, type)}
    found = set()
    for channel, message in events(pathlib.Path(sys.argv[2]).read_bytes()):
        kind = types[message[:8]]
        assert kind.decode(message).encode() == message, f"{channel} does not encode to the same bytes"
        found.add(kind)
    assert found == set(types.values()), "a type has no sample"
    print(f"{len(found)} types")


if __name__ == "__main__":
    main()
