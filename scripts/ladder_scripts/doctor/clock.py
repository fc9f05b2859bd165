# SPDX-License-Identifier: BSD-3-Clause
"""The wall clock: set at all, steady, and the same as that of who sends."""

import ctypes
import time

OLDEST_S = 1_704_067_200  # 2024: a board without battery clock starts long before
MAX_STEP_S = 0.01
MAX_AGE_S = 1.0
TIME_ERROR = 5  # adjtimex(2): not synchronised
FIX = "sudo apt install systemd-timesyncd (or chrony) and give it a time server; without a network: sudo date --set '...'"
SENSED = ("LADDER_TOF_0", "LADDER_TOF_1", "LADDER_TOF_2", "LADDER_TOF_3", "LADDER_IMU")


def now():
    """(wall clock, steady clock) [s]."""
    return time.time(), time.monotonic()


def is_synchronised():
    """What the kernel was told by a time service; None where it does not say."""
    try:
        state = ctypes.CDLL(None).adjtimex(ctypes.create_string_buffer(512))
    except (OSError, AttributeError):
        return None
    return None if state < 0 else state != TIME_ERROR


def check_clock(report, before, after, channels, needs_synchronisation):
    if after[0] < OLDEST_S:
        report.fault(f"the clock says {time.strftime('%Y-%m-%d', time.gmtime(after[0]))}: it was never set", FIX)
    step_s = (after[0] - before[0]) - (after[1] - before[1])
    if abs(step_s) > MAX_STEP_S:
        report.fault(f"the clock was set by {step_s:.3f} s while this ran: messages seem late or lost", "let a time service slew it, and start it before the services")
    for name in SENSED:
        for sender, message in channels[name].first_messages.items() if name in channels else ():
            age_s = (channels[name].heard_us[sender] - int.from_bytes(message[8:16], "big", signed=True)) / 1e6
            if len(message) >= 16 and abs(age_s) > MAX_AGE_S:
                report.warning(f"{name} is {age_s:.1f} s old when it comes", "a replay or a simulation is so; a sensor computer needs the same clock as this one")
    if needs_synchronisation and is_synchronised() is False:
        report.fault("no time service keeps this clock, and two computers share the work", FIX)
    if not report.findings:
        report.fine("set and steady" + ("" if is_synchronised() is not False else "; no time service keeps it, which one computer alone does not need"))
