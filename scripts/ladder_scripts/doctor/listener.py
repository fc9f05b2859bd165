# SPDX-License-Identifier: BSD-3-Clause
"""Listens to LCM's datagrams without LCM, because LCM does not tell who sent what. Sends nothing."""

import os
import select
import socket
import struct
import time
from dataclasses import dataclass, field

SHORT, FRAGMENT = 0x4C433032, 0x4C433033
MAX_CHANNEL_BYTES = 63


@dataclass
class Heard:
    """One channel."""

    senders: list = field(default_factory=list)  # (address, port) of each message, runs of the same one only once
    first_messages: dict = field(default_factory=dict)  # sender -> the first 64 bytes of its newest message
    heard_us: dict = field(default_factory=dict)  # sender -> when that came, by this computer's clock


def open_socket(group, port):
    """Joined to the group where the kernel's route leads; OSError where there is none."""
    listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
    listener.bind(("", port))
    listener.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(group) + socket.inet_aton("0.0.0.0"))
    listener.setblocking(False)
    return listener


def begin_of_message(datagram):
    """(channel, first bytes of the message) of a datagram that begins a message, else None."""
    if len(datagram) < 8:
        return None
    magic = struct.unpack_from(">I", datagram)[0]
    if magic == FRAGMENT and len(datagram) >= 20 and struct.unpack_from(">H", datagram, 16)[0] == 0:
        at = 20
    elif magic == SHORT:
        at = 8
    else:
        return None
    end = datagram.find(b"\0", at, at + MAX_CHANNEL_BYTES + 1)
    return None if end < 0 else (datagram[at:end].decode("ascii", "replace"), datagram[end + 1 : end + 65])


def listen(listener, seconds):
    """Channel -> Heard."""
    channels = {}
    until = time.monotonic() + seconds
    while (left := until - time.monotonic()) > 0:
        if not select.select([listener], [], [], left)[0]:
            break
        datagram, sender = listener.recvfrom(65536)
        begun = begin_of_message(datagram)
        if begun is None:
            continue
        heard = channels.setdefault(begun[0], Heard())
        if not heard.senders or heard.senders[-1] != sender:
            heard.senders = (heard.senders + [sender])[-64:]
        heard.first_messages[sender] = begun[1]
        heard.heard_us[sender] = time.time_ns() // 1000
    return channels


def inode_of(listener):
    return os.fstat(listener.fileno()).st_ino
