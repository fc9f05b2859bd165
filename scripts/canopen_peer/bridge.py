#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Connects a program that speaks frames as text ("181#2706" per line on stdin and stdout) to a CAN line.
usage: bridge.py can0|unix:PATH COMMAND...    with unix: it listens at PATH and serves one controller after the other"""
import os
import selectors
import socket
import struct
import subprocess
import sys

FRAME = struct.Struct("=IB3x8s")  # struct can_frame


def text_of(packet):
    identifier, length, data = FRAME.unpack(packet)
    return f"{identifier & 0x1FFFFFFF:03X}#{data[:length].hex().upper()}\n"


def packet_of(line):
    identifier, data = line.strip().split("#")
    payload = bytes.fromhex(data)
    return FRAME.pack(int(identifier, 16), len(payload), payload)


class Bridge:
    def __init__(self, line, command):
        self.selector = selectors.DefaultSelector()
        self.controller = None
        self.rest = b""
        if line.startswith("unix:"):
            listener = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
            listener.bind(line[len("unix:"):])
            listener.listen(1)
            self.selector.register(listener, selectors.EVENT_READ, self.accept)
        else:
            self.controller = socket.socket(socket.PF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
            self.controller.bind((line,))
            self.selector.register(self.controller, selectors.EVENT_READ, self.from_line)
        self.peer = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0)
        self.selector.register(self.peer.stdout, selectors.EVENT_READ, self.from_peer)

    def accept(self, listener):
        if self.controller is not None:
            self.selector.unregister(self.controller)
            self.controller.close()
        self.controller, _ = listener.accept()
        self.selector.register(self.controller, selectors.EVENT_READ, self.from_line)

    def from_line(self, line):
        packet = line.recv(72)
        if len(packet) == FRAME.size:
            self.peer.stdin.write(text_of(packet).encode())
        elif not packet:
            self.selector.unregister(line)
            line.close()
            self.controller = None

    def from_peer(self, stream):
        chunk = os.read(stream.fileno(), 65536)
        if not chunk:
            sys.exit(self.peer.wait())
        *lines, self.rest = (self.rest + chunk).split(b"\n")
        for line in lines:
            if self.controller is not None:
                try:
                    self.controller.send(packet_of(line.decode()))
                except OSError:
                    pass  # the controller is going away; from_line will see it

    def run(self):
        try:
            while True:
                for key, _ in self.selector.select():
                    key.data(key.fileobj)
        finally:
            self.peer.kill()


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    Bridge(sys.argv[1], sys.argv[2:]).run()
