#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""ladder-log on whole, empty, odd and damaged logs. Damage is made at 1, 10 and 100 places of a log whose every event is known.

    test_ladder_log.py [FOLDER_OF_ladder_msgs]    with the folder, its reader of messages is also held against lcm-gen's codecs
"""

import csv
import io
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from ladder_scripts import codecs, lcm_log, lcm_types, log_scan, messages  # noqa: E402

CODECS = sys.argv.pop(1) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else None
TYPES = messages.load_types(ROOT / "lcmtypes")
BY_NAME = {message_type.name: message_type for message_type in TYPES.values()}
START_US = 1_700_000_000_000_000
CHANNELS = [("LADDER_TOF_0", "tof_frame_t"), ("LADDER_IMU", "imu_t"), ("LADDER_TOF_1", "tof_frame_t"), ("LADDER_CLIMB", "climb_state_t"),
            ("LADDER_RUNGS", "ladder_t"), ("LADDER_EVENT", "event_t"), ("OTHER_FIXED", None), ("OTHER_TEXT", None)]


def random_message(message_type, seq, rng):
    """A message of the type: each count up to 400 or its bound, elements of random bytes, texts of letters."""
    out = [lcm_types.fingerprint(message_type).to_bytes(8, "big")]
    counts = {}
    for index, field in enumerate(message_type.fields):
        if field.kind == "string":
            text = bytes(rng.choice(b"abc xyz") for _ in range(rng.randrange(min(field.limit, 60)))) + b"\0"
            out.append(struct.pack(">i", len(text)) + text)
        elif message_type.arrays_of(index):
            counts[index] = rng.randrange(min(field.limit, 400) + 1)
            out.append(struct.pack(">i", counts[index]))
        elif field.name == "seq":
            out.append(struct.pack(">q", seq))
        else:
            elements = counts[field.count_index] if field.count_index >= 0 else field.fixed
            out.append(rng.randbytes(elements * lcm_types.SIZE_BYTES[field.kind]))
    return b"".join(out)


def foreign_message(channel, rng):
    return rng.randbytes(200 if channel == "OTHER_FIXED" else rng.randrange(8, 300))


def whole_log(num_events, seed):
    """The bytes of each event."""
    rng = random.Random(seed)
    events = []
    for number in range(num_events):
        channel, name = CHANNELS[number % len(CHANNELS)]
        message = random_message(BY_NAME[name], number, rng) if name else foreign_message(channel, rng)
        out = io.BytesIO()
        writer = lcm_log.LogWriter(out)
        writer.num_events = number
        writer.write(START_US + 1000 * number, channel, message)
        events.append(out.getvalue())
    return events


def overwritten_head(event, rng):
    """Random bytes somewhere in magic, lengths or channel."""
    at = rng.choice([0, 1, 2, 3, 20, 21, 22, 23, 24, 25, 26])
    return event[:at] + bytes([event[at] ^ rng.randrange(1, 256)]) + event[at + 1 :]


def inserted(event, rng):
    at = rng.randrange(len(event))
    return event[:at] + rng.randbytes(rng.randrange(1, 40)) + event[at:]


def removed(event, rng):
    at = rng.randrange(28, len(event) - 8)
    return event[:at] + event[at + rng.randrange(1, min(40, len(event) - at)) :]


def emptied(event, rng):
    """A sector of zeros over the head and what follows."""
    size = min(len(event), rng.choice([16, 128, 512]))
    return bytes(size) + event[size:]


DAMAGES = [overwritten_head, inserted, removed, emptied]


def damage(events, places, seed):
    """(bytes of the damaged log, indices of the events that were touched, offset of each of them)."""
    rng = random.Random(seed)
    touched = set(rng.sample(range(1, len(events)), places))
    out, offsets = [], {}
    at = 0
    for index, event in enumerate(events):
        if index in touched:
            offsets[index] = at
            event = rng.choice(DAMAGES)(event, rng)
        out.append(event)
        at += len(event)
    return b"".join(out), touched, offsets


def tool(*arguments):
    return subprocess.run([str(ROOT / "scripts" / "ladder-log"), *map(str, arguments)], capture_output=True, text=True, check=False)


def raw_events(data):
    """The events of a whole log, byte by byte; LogError where it is not whole."""
    out, at = [], 0
    for _, channel, message in lcm_log.read_events(data):
        size = lcm_log.HEAD.size + len(channel) + len(message)
        out.append(data[at : at + size])
        at += size
    return out


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def file(self, data, name="in.lcm"):
        path = self.folder / name
        path.write_bytes(data)
        return path


class Damaged(InFolder):
    def repaired(self, data):
        """Events of the repaired log, and what check said; the damaged log itself must stay as it was."""
        path, out = self.file(data), self.folder / "out.lcm"
        out.unlink(missing_ok=True)
        found = tool("check", path)
        fixed = tool("repair", path, "-o", out)
        self.assertEqual(fixed.returncode, 0, fixed.stderr)
        self.assertEqual(path.read_bytes(), data, "the log that was read has changed")
        self.assertEqual(tool("check", out).returncode, 0, "the repaired log is not whole")
        return raw_events(out.read_bytes()), found

    def test_damage_at_1_10_and_100_places(self):
        """At least 99 % of the untouched events come back, byte by byte and in order; every damaged place is reported with its offset."""
        events = whole_log(2000, seed=1)
        for places in (1, 10, 100):
            for seed in range(3):
                data, touched, offsets = damage(events, places, seed)
                kept, found = self.repaired(data)
                untouched = [event for i, event in enumerate(events) if i not in touched]
                known, returned = set(events), set(kept)
                back = sum(event in returned for event in untouched)
                with self.subTest(places=places, seed=seed):
                    self.assertEqual(found.returncode, 1)
                    self.assertGreaterEqual(back, 0.99 * len(untouched))
                    self.assertLessEqual(len(kept) - back, places // 50, "events that nobody wrote")
                    self.assertEqual([e for e in kept if e in known], [e for e in events if e in returned], "another order")
                    reported = [tuple(map(int, line.split()[2:5:2])) for line in found.stderr.replace(",", "").splitlines()
                                if line.startswith("damaged: bytes")]
                    reported = [(int(a), int(b)) for a, b in reported]
                    missed = [at for index, at in offsets.items() if not any(a <= at + len(events[index]) + 40 and at <= b for a, b in reported)]
                    self.assertLessEqual(len(missed), places // 50, f"not reported: {missed}")

    def test_lengths_that_swallow_or_cut_off(self):
        """A length that reaches over other events costs only its own event, as does one that is too short."""
        events = whole_log(64, seed=2)
        for channel_index in range(len(CHANNELS)):
            for change in (-5, -1, 1, 5, 900, 1 << 20, 1 << 31):
                index = 24 + channel_index
                head = bytearray(events[index][:28])
                length = (int.from_bytes(head[24:28], "big") + change) % (1 << 32)
                head[24:28] = length.to_bytes(4, "big")
                data = b"".join(events[:index]) + bytes(head) + events[index][28:] + b"".join(events[index + 1 :])
                parts = list(log_scan.scan(data, TYPES))
                kept = [bytes(part.whole) for part in parts if isinstance(part, log_scan.Event)]
                with self.subTest(channel=CHANNELS[channel_index][0], change=change):
                    self.assertEqual(kept, events[:index] + events[index + 1 :])
                    self.assertEqual([part.begin for part in parts if isinstance(part, log_scan.Damage)], [sum(map(len, events[:index]))])

    def test_stray_bytes_between_events(self):
        """Bytes between two events cost at most the one before them, since they could belong into it."""
        events = whole_log(32, seed=3)
        for index in range(8, 16):
            parts = list(log_scan.scan(b"".join(events[:index]) + b"abc" + b"".join(events[index:]), TYPES))
            self.assertEqual([bytes(part.whole) for part in parts if isinstance(part, log_scan.Event)], events[: index - 1] + events[index:])
            self.assertEqual(len(parts), len(events))

    def test_cut_short(self):
        """Whatever length a log is cut to, all whole events come back, and a cut within an event is damage."""
        events = whole_log(17, seed=4)
        data, whole_at = b"".join(events), len(b"".join(events[:-1]))
        for end in [whole_at + extra for extra in (1, 3, 4, 27, 28, 29, 40)] + [len(data) - 1]:
            kept, found = self.repaired(data[:end])
            with self.subTest(end=end):
                self.assertEqual(kept, events[:-1])
                self.assertEqual(found.returncode, 1)

    def test_numbers_and_times_against_both_neighbours(self):
        """A head whose number or time contradicts its neighbours is damaged, though every length is right."""
        events = whole_log(24, seed=5)
        for at in (4, 12):  # the highest byte but a few of number and time
            changed = bytearray(events[9])
            changed[at + 2] ^= 0x40
            kept, found = self.repaired(b"".join(events[:9]) + bytes(changed) + b"".join(events[10:]))
            self.assertEqual(kept, events[:9] + events[10:])
            self.assertIn("its number or its time", found.stderr)

    def test_a_count_that_lies(self):
        """A message of a known type with an impossible count is damage; the chain goes on behind it."""
        events = whole_log(16, seed=6)
        message_type = BY_NAME["tof_frame_t"]
        fields = dict.fromkeys(range(len(message_type.fields)))
        index = next(i for i in fields if message_type.arrays_of(i))
        at = 28 + len("LADDER_TOF_0") + 8 + sum(lcm_types.SIZE_BYTES[f.kind] * f.fixed for f in message_type.fields[:index])
        changed = events[8][:at] + struct.pack(">i", -1) + events[8][at + 4 :]
        kept, found = self.repaired(b"".join(events[:8]) + changed + b"".join(events[9:]))
        self.assertEqual(kept, events[:8] + events[9:])
        self.assertIn("is -1", found.stderr)

    def test_nothing_but_noise(self):
        """A file that is no log at all, and magic numbers alone, are damage from the first to the last byte."""
        for noise in (random.Random(7).randbytes(5000), lcm_log.MAGIC.to_bytes(4, "big") * 500, bytes(5000), b"x"):
            path = self.file(noise)
            found = tool("check", path)
            self.assertEqual(found.returncode, 1)
            self.assertIn(f"damaged: bytes 0 to {len(noise)} ", found.stderr)
            self.assertEqual(list(log_scan.scan(noise, TYPES)), [log_scan.Damage(0, len(noise), unittest.mock.ANY)])


class Whole(InFolder):
    def test_whole_log(self):
        """A whole log is said to be whole, and repair copies it byte by byte."""
        data = b"".join(whole_log(500, seed=8))
        path, out = self.file(data), self.folder / "out.lcm"
        found = tool("check", path)
        self.assertEqual((found.returncode, found.stderr), (0, ""))
        self.assertIn("500 whole events, 0 damaged places", found.stdout)
        self.assertIn("messages on OTHER_TEXT are of no type known here", found.stdout)
        self.assertEqual(tool("repair", path, "-o", out).returncode, 0)
        self.assertEqual(out.read_bytes(), data)

    def test_empty_missing_and_existing_files(self):
        """An empty log holds nothing (1); a missing one, and an output that exists already, are told apart from damage (3)."""
        empty, out = self.file(b""), self.file(b"mine", "taken.lcm")
        self.assertEqual(tool("check", empty).returncode, 1)
        self.assertEqual(tool("info", empty).returncode, 1)
        self.assertEqual(tool("info", self.folder / "none.lcm").returncode, 3)
        self.assertEqual(tool("info", self.folder).returncode, 3)
        self.assertEqual(tool("repair", self.folder / "none.lcm", "-o", self.folder / "new.lcm").returncode, 3)
        self.assertFalse((self.folder / "new.lcm").exists())
        refused = tool("repair", empty, "-o", out)
        self.assertEqual(refused.returncode, 3)
        self.assertIn("choose another name", refused.stderr)
        self.assertEqual(out.read_bytes(), b"mine")
        self.assertEqual(tool("repair", out, "-o", out).returncode, 3, "the input is never the output")
        self.assertEqual(tool("cut", empty, "-o", self.folder / "x", "--channel", "(").returncode, 2)
        self.assertEqual(tool().returncode, 2)

    def test_info(self):
        """Events, rate, losses by gaps in seq and the longest gap, per channel."""
        events = whole_log(800, seed=9)
        del events[80:240:8]  # 20 of LADDER_TOF_0
        said = tool("info", self.file(b"".join(events)))
        self.assertEqual(said.returncode, 0)
        self.assertIn("780 events, 0.799 s from 2023-11-14 22:13:20 UTC", said.stdout)
        row = next(line.split() for line in said.stdout.splitlines() if line.startswith("LADDER_IMU"))
        self.assertEqual(row[1:4], ["imu_t", "100", "125.00"])
        row = next(line.split() for line in said.stdout.splitlines() if line.startswith("LADDER_TOF_0"))
        self.assertEqual((row[2], row[5]), ("80", "168.0"))

    def test_cut(self):
        """Only the time and the channels asked for, byte by byte; the end is left out."""
        events = whole_log(400, seed=10)
        out = self.folder / "out.lcm"
        cut = tool("cut", self.file(b"".join(events)), "-o", out, "--from", "0.1", "--to", "0.2", "--channel", "LADDER_TOF_.*")
        self.assertEqual(cut.returncode, 0, cut.stderr)
        self.assertEqual(raw_events(out.read_bytes()), [event for event in events[100:200] if b"LADDER_TOF_" in event[:60]])
        self.assertEqual(tool("check", out).returncode, 0, "gaps in the numbers are no damage")

    def test_csv(self):
        """A row per message, or per element of the arrays of one count."""
        events = whole_log(80, seed=11)
        path = self.file(b"".join(events))
        rows = list(csv.DictReader(io.StringIO(tool("csv", path, "LADDER_CLIMB").stdout)))
        self.assertEqual([int(row["seq"]) for row in rows], list(range(3, 80, 8)))
        first = messages.decode(BY_NAME["climb_state_t"], events[3][28 + len("LADDER_CLIMB") :])
        self.assertEqual([int(rows[0][f"drive_state_{i}"]) for i in range(16)], list(first["drive_state"]))
        rows = list(csv.DictReader(io.StringIO(tool("csv", path, "LADDER_RUNGS", "--per", "num_rungs").stdout)))
        first = messages.decode(BY_NAME["ladder_t"], events[4][28 + len("LADDER_RUNGS") :])
        self.assertEqual([int(row["rung_id"]) for row in rows if row["seq"] == "4"], list(first["rung_id"]))
        wrong = tool("csv", path, "LADDER_RUNGS", "--per", "num_eggs")
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("num_rungs", wrong.stderr)
        self.assertEqual(tool("csv", path, "NO_SUCH_CHANNEL").returncode, 1)


@unittest.skipUnless(CODECS, "no generated codecs were named")
class AgainstCodecs(unittest.TestCase):
    def test_decoded_values(self):
        """Every type reads the same through lcm-gen's own codec."""
        package = codecs.load_messages(CODECS)
        rng = random.Random(12)
        for name, message_type in BY_NAME.items():
            message = random_message(message_type, 5, rng)
            theirs = getattr(package, name).decode(message)
            for key, value in messages.decode(message_type, message).items():
                other = getattr(theirs, key)
                other = tuple(other) if isinstance(other, (list, tuple, bytes)) else other
                with self.subTest(f"{name}.{key}"):
                    self.assertEqual(repr(value), repr(other))


if __name__ == "__main__":
    unittest.main()
