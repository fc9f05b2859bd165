# SPDX-License-Identifier: BSD-3-Clause
"""Socket buffers, the route that multicast takes, and sockets that lose datagrams."""

import json
import pathlib
import subprocess

from ladder_scripts.doctor.processes import name_of, owner_of_socket, state_of

RMEM_MAX, RMEM_DEFAULT = 8_388_608, 4_194_304
NEEDED_BYTES = 4_194_304


def check_buffers(report, proc=pathlib.Path("/proc")):
    """The services ask for 4 MiB in their URL, Java tools take the default."""
    fix = f"sudo sysctl -w net.core.rmem_max={RMEM_MAX} net.core.rmem_default={RMEM_DEFAULT}; for good: /etc/sysctl.d/60-ladder.conf"
    for key, reason in (("rmem_max", "point clouds will be lost"), ("rmem_default", "lcm-spy and other Java tools will show rates too low")):
        value = int((proc / "sys/net/core" / key).read_text())
        if value >= NEEDED_BYTES:
            report.fine(f"net.core.{key} is {value}")
        else:
            report.fault(f"net.core.{key} is {value}, {NEEDED_BYTES} are needed: {reason}", fix)


def check_route(report, group, interface):
    """The group must leave through `interface`, which is there whatever happens to cables: lo, unless two hosts share the work."""
    pin = f"sudo ip link set {interface} up && sudo ip route replace {group}/32 dev {interface}" + (" src 127.0.0.1" if interface == "lo" else "")
    got = subprocess.run(["ip", "-json", "route", "get", group], capture_output=True, text=True, check=False)
    try:
        route = json.loads(got.stdout)[0]
        device, source = route["dev"], route.get("prefsrc", "0.0.0.0")
    except (ValueError, LookupError):
        report.fault(f"no route to {group}: LCM cannot start (exit code 3)", f"{pin}; for good: ladder-net.service")
        return
    if device == "lo" == interface and not source.startswith("127."):
        report.fault(f"{group} goes through lo, but from the address {source}: the address filter of the services drops it", f"{pin}; for good: ladder-net.service")
        return
    if device == interface:
        report.fine(f"{group} goes through {device} from {source}")
        return
    report.fault(f"{group} goes through {device}, not {interface}: when its cable or address goes, messages on this computer stop too",
                 f"{pin}; for good: ladder-net.service")


def udp_sockets(port, proc=pathlib.Path("/proc")):
    """inode -> (bytes waiting, datagrams dropped) of the UDP sockets bound to the port."""
    sockets = {}
    for line in (proc / "net/udp").read_text().splitlines()[1:]:
        words = line.split()
        if int(words[1].split(":")[1], 16) == port:
            sockets[int(words[9])] = (int(words[4].split(":")[1], 16), int(words[12]))
    return sockets


def check_sockets(report, before, after):
    """before, after: udp_sockets() some seconds apart. Drops of long ago are worth a word, present ones are a fault."""
    for inode, (waiting, drops) in sorted(after.items()):
        pid = owner_of_socket(inode)
        who = f"{name_of(pid)} (pid {pid})" if pid else f"a process of another user (socket {inode})"
        lost = drops - before.get(inode, (0, drops))[1]
        if lost > 0:
            stopped = f"; it is stopped: kill -CONT {pid}" if pid and state_of(pid) in "Tt" else ""
            report.fault(f"the socket of {who} is full ({waiting} bytes wait): {lost} datagrams lost just now",
                         f"a program that does not read, or not fast enough: end or mend it, or raise the buffers{stopped}")
        elif drops > 0:
            report.warning(f"{who} has lost {drops} datagrams since its start", "if the number grows: buffers, or too much work for this computer")
    if not after:
        report.warning("nobody listens: no service runs", "sudo systemctl start ladder.target")
    elif not report.findings:
        report.fine(f"{len(after)} sockets, none has lost a datagram")
