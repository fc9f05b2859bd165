# SPDX-License-Identifier: BSD-3-Clause
"""LCM over UDP multicast, as far as a script needs it: small messages (states, health, events) in, any bytes out.

A message that fits one datagram is "LC02", a number, the channel's name with a NUL, and the bytes; larger ones come in
fragments ("LC03") and are left out here: images and clouds are not for scripts."""

import select
import socket
import struct
import time
import urllib.parse

from ladder_scripts.doctor.listener import open_socket

SMALL = b"LC02"
MAX_BYTES = 65499


def address_of(url):
    """(group, port, ttl) of udpm://GROUP:PORT?ttl=N."""
    parts = urllib.parse.urlsplit(url)
    if parts.scheme != "udpm":
        raise ValueError(f"{url}: only udpm:// can be listened to")
    options = urllib.parse.parse_qs(parts.query)
    return parts.hostname, parts.port, int(options.get("ttl", ["0"])[0])


class Listener:
    def __init__(self, url):
        group, port, _ = address_of(url)
        self.socket = open_socket(group, port)

    def messages(self, until_s):
        """(channel, bytes) one after the other until this time.monotonic()."""
        while True:
            left_s = until_s - time.monotonic()
            if not select.select([self.socket], [], [], max(0.0, left_s))[0]:
                return
            try:
                datagram = self.socket.recv(8192)  # the rest of a fragment is thrown away
            except BlockingIOError:
                continue
            if datagram[:4] == SMALL:
                name, _, message = datagram[8:].partition(b"\0")
                yield name.decode("ascii", "replace"), message
            if left_s <= 0.0:
                return


class Sender:
    def __init__(self, url):
        group, port, ttl = address_of(url)
        self.target = (group, port)
        self.number = 0
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, ttl)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 1)

    def publish(self, channel, message):
        datagram = SMALL + struct.pack(">I", self.number) + channel.encode() + b"\0" + message
        if len(datagram) > MAX_BYTES:
            raise ValueError("too large for one datagram")
        self.number += 1
        self.socket.sendto(datagram, self.target)
