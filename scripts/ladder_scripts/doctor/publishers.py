# SPDX-License-Identifier: BSD-3-Clause
"""Channels with more senders than one, and the same service running twice."""

import socket
import struct

from ladder_scripts.doctor.processes import name_of, owner_of_port

# Each sender counts its own messages there.
SHARED = {"LADDER_HEALTH", "LADDER_EVENT", "LADDER_CONFIG", "LADDER_COMMAND"}
SERVICES = {1: "sensor_service", 2: "gng_service", 3: "ladder_service", 4: "climb_controller", 5: "ladder_simulator", 6: "viewer"}
HEALTH_HEAD = struct.Struct(">8xqqbbi")  # fingerprint, utime, seq, service, state, pid


def is_interleaved(senders):
    """A, then B, then A again: both send. A restarted sender comes from a new port and the old one is silent."""
    return any(senders[i] in senders[i + 2 :] for i in range(len(senders)))


def described(sender):
    address, port = sender
    local = {"127.0.0.1"} | {info[4][0] for info in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)} if _has_name() else {"127.0.0.1"}
    pid = owner_of_port(port)
    if pid is not None:
        return f"{name_of(pid)} (pid {pid})"
    return f"port {port} of " + ("this computer" if address in local else address)


def _has_name():
    try:
        socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)
    except OSError:
        return False
    return True


def check_publishers(report, channels):
    """channels: of listener.listen()."""
    heard = {name: state for name, state in channels.items() if name.startswith("LADDER_")}
    for name, state in sorted(heard.items()):
        if name not in SHARED and is_interleaved(state.senders):
            who = sorted({described(sender) for sender in state.senders})
            report.fault(f"{name} has {len(set(state.senders))} senders: {', '.join(who)}", "end all but one of them")
    for service, pids in sorted(_services(heard).items()):
        if len(pids) > 1:
            report.fault(f"{SERVICES.get(service, f'service {service}')} runs {len(pids)} times: pids {', '.join(map(str, sorted(pids)))}",
                         "end all but one of them (a replay or a demo beside the robot's own services?)")
    if not heard:
        report.warning("no message was heard", "start the services, or look at the findings on route and sockets")
    elif not report.findings:
        report.fine(f"{len(heard)} channels, each with one sender")


def _services(heard):
    """Service number -> pids that told their health and still run or came last."""
    services = {}
    health = heard.get("LADDER_HEALTH")
    for message in health.first_messages.values() if health else ():
        if len(message) >= HEALTH_HEAD.size:
            _, _, service, _, pid = HEALTH_HEAD.unpack_from(message)
            services.setdefault(service, set()).add(pid)
    return services
