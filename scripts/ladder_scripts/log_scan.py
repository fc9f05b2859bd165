# SPDX-License-Identifier: BSD-3-Clause
"""Walks through an LCM log that may be damaged anywhere: yields what is whole and names what is not.

A log has no checksums: 28 bytes of head (magic, number, time, two lengths), channel, message, and so on to the end. What
gives damage away is the chain of lengths, from head to head, and the messages of our own types. After a break the scan
goes on at the next head that proves itself: another head, or the end, follows it, or its message is whole."""

from dataclasses import dataclass

from ladder_scripts import messages
from ladder_scripts.lcm_log import HEAD, MAGIC

MAGIC_BYTES = MAGIC.to_bytes(4, "big")
MAX_CHANNEL_BYTES = 63  # LCM's own limit
MAX_MESSAGE_BYTES = 1 << 28  # longer ones do not go through LCM
MAX_LEAP_US = 60_000_000  # a time so far outside of its neighbours' is a damaged one
NAME_BYTES = frozenset(range(0x21, 0x7F))


@dataclass
class Event:
    begin: int  # byte of its head in the log
    number: int
    utime_us: int
    channel: str
    message: memoryview
    whole: memoryview  # head, channel and message, as they stand in the log
    end: int  # one behind its last byte


@dataclass
class Damage:
    begin: int
    end: int
    reason: str


def scan(log, types):
    """Yields Event and Damage in the order of the file; together they cover every byte once.
    log: the whole file (bytes, mmap); types: of messages.load_types()."""
    return _join_damages(_judge_neighbours(_walk(log, types)))


def _walk(log, types):
    walk = _Walk(log, types)
    at = 0
    while at < walk.size:
        event = walk.head_at(at)
        reason = walk.doubt(event) if event else walk.why_no_head(at)
        if not reason:
            yield event
            at = event.end
            continue
        resumed = walk.next_proven(at + 1)
        # A message that breaks its type's rules in an unbroken chain costs only itself.
        if event and walk.is_followed(event):
            resumed = event.end
        yield Damage(at, resumed, reason)
        at = resumed


class _Walk:
    """Judges single places of one log."""

    def __init__(self, log, types):
        self._log = log
        self._view = memoryview(log)
        self._types = types
        self._sizes_of_channel = {}
        self.size = len(log)

    def _fields_at(self, at):
        """(number, time, channel, end) of a head that could be one, the end perhaps beyond the file; or None."""
        if at + HEAD.size > self.size:
            return None
        magic, number, utime_us, channel_bytes, message_bytes = HEAD.unpack_from(self._log, at)
        if magic != MAGIC or not 1 <= channel_bytes <= MAX_CHANNEL_BYTES or message_bytes > MAX_MESSAGE_BYTES:
            return None
        name = self._log[at + HEAD.size : at + HEAD.size + channel_bytes]
        if not NAME_BYTES.issuperset(name):
            return None
        return number, utime_us, name.decode("ascii"), at + HEAD.size + channel_bytes + message_bytes

    def head_at(self, at):
        """The event of which a head lies here, whole within the file; nothing is proven yet."""
        fields = self._fields_at(at)
        if fields is None or fields[3] > self.size:
            return None
        number, utime_us, channel, end = fields
        return Event(at, number, utime_us, channel, self._view[at + HEAD.size + len(channel) : end], self._view[at:end], end)

    def why_no_head(self, at):
        if self.size - at < HEAD.size and MAGIC_BYTES.startswith(self._log[at : min(at + 4, self.size)]):
            return "cut short in the head of an event"
        return "cut short within an event" if self._fields_at(at) else "no event begins here"

    def is_followed(self, event):
        """The chain goes on behind it: by a head, a cut one too, or by the end of the file."""
        if event.end == self.size or self._fields_at(event.end) is not None:
            return True
        left = self.size - event.end
        return left < HEAD.size + MAX_CHANNEL_BYTES and self._log[event.end : event.end + min(left, 4)] == MAGIC_BYTES[: min(left, 4)]

    def doubt(self, event):
        """'' for a whole event, else why it is not believed."""
        message_type = messages.type_of(self._types, event.message)
        fault = messages.fault_of(message_type, event.message) if message_type else ""
        if fault:
            return fault
        fault = "" if self.is_followed(event) else self._doubt_of_last(event, bool(message_type))
        if not fault:
            self._sizes_of_channel.setdefault(event.channel, set()).add(len(event.message))
        return fault

    def _doubt_of_last(self, event, is_ours):
        """Something else than a head follows it. Is that damaged, or was this one longer or shorter? Its number tells: the
        event after the damage has the next number only if nothing stood between."""
        following = self.next_proven(event.begin + HEAD.size)
        if following < event.end:
            return "its length is damaged, or bytes are missing in it"
        next_number = self.head_at(following).number if following < self.size else None
        if next_number == event.number + 1:
            return "there are bytes too many, in it or behind it"
        if is_ours or (next_number or 0) > event.number or len(event.message) in self._sizes_of_channel.get(event.channel, ()):
            return ""
        return "its length may be damaged"

    def next_proven(self, at):
        """Where the next event that proves itself begins; the file's size where none does."""
        while (at := self._log.find(MAGIC_BYTES, at)) >= 0:
            event = self.head_at(at)
            if event:
                message_type = messages.type_of(self._types, event.message)
                if messages.fault_of(message_type, event.message) == "" if message_type else self.is_followed(event):
                    return at
            at += 1
        return self.size


def _judge_neighbours(parts):
    """Turns an event whose number or time contradicts both neighbours into damage: its head is not what was written."""
    before = held = None
    for part in parts:
        if held is not None:
            yield Damage(held.begin, held.end, "its number or its time is damaged") if _is_outlier(before, held, part) else held
            before = held if isinstance(held, Event) else None
        held = part
    if held is not None:
        yield held


def _is_outlier(before, event, after):
    if not all(isinstance(part, Event) for part in (before, event, after)):
        return False
    if before.number < after.number and not before.number < event.number < after.number:
        return True
    return before.utime_us <= after.utime_us and not (
        before.utime_us - MAX_LEAP_US <= event.utime_us <= after.utime_us + MAX_LEAP_US)


def _join_damages(parts):
    """One place of damage is told once."""
    held = None
    for part in parts:
        if isinstance(part, Damage) and held and held.end == part.begin:
            held.end = part.end
            continue
        if held:
            yield held
            held = None
        if isinstance(part, Damage):
            held = part
        else:
            yield part
    if held:
        yield held
