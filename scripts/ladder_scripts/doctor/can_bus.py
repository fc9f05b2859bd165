# SPDX-License-Identifier: BSD-3-Clause
"""The CAN interface of the drives: there, up, its controller's state, and the settings that safety relies on."""

import json
import subprocess

MAX_QUEUE = 100
BROKEN = {"BUS-OFF": "mend the wire (both ends terminated?), then: sudo ip link set {0} type can restart",
          "ERROR-PASSIVE": "frames go wrong: look at wires, termination and bit rate; a drive without power cannot acknowledge",
          "STOPPED": "sudo ip link set {0} up"}


def check_can(report, interface):
    if interface.startswith("unix:"):
        report.warning(f"climb.can.interface is {interface}: drives of a simulation", "on the robot: climb.can.interface = \"can0\"")
        return
    got = subprocess.run(["ip", "-json", "-details", "link", "show", interface], capture_output=True, text=True, check=False)
    set_up = f"sudo ip link set {interface} txqueuelen 40 type can bitrate 1000000 restart-ms 0 && sudo ip link set {interface} up"
    try:
        link = json.loads(got.stdout)[0]
    except (ValueError, LookupError):
        report.fault(f"there is no interface {interface}", f"plug in the adapter and load its driver (dmesg), or name another one in climb.can.interface; then: {set_up}")
        return
    kind = link.get("linkinfo", {}).get("info_kind", "")
    data = link.get("linkinfo", {}).get("info_data", {})
    if link.get("link_type") != "can":
        report.fault(f"{interface} is no CAN interface but {link.get('link_type')}", "name the right one in climb.can.interface")
        return
    state = data.get("state", "")
    if "UP" not in link.get("flags", []):
        report.fault(f"{interface} is down", f"sudo ip link set {interface} up" if kind == "vcan" else set_up)
    elif state in BROKEN:
        report.fault(f"{interface} is {state}", BROKEN[state].format(interface))
    if data.get("restart_ms", 0) > 0:
        report.fault(f"{interface} restarts by itself after {data['restart_ms']} ms of bus-off: drives would be spoken to unasked",
                     f"sudo ip link set {interface} down && {set_up}")
    if kind == "can" and link.get("txqlen", 0) > MAX_QUEUE:
        report.warning(f"{interface} queues up to {link['txqlen']} frames: late ones would be sent after a stall", f"sudo ip link set {interface} txqueuelen 40")
    if not any(finding.level == "FAULT" for finding in report.findings):
        report.fine(f"{interface} is up" + (f", {state}" if state else ""))
