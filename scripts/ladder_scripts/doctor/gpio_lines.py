# SPDX-License-Identifier: BSD-3-Clause
"""The GPIO chip of touch switches and E-stop: found by its label, each line by its name, and nobody else holds it."""

import fcntl
import os
import pathlib
import struct

CHIP_INFO = 0x8044B401  # GPIO_GET_CHIPINFO_IOCTL, struct gpiochip_info
LINE_INFO = 0xC100B405  # GPIO_V2_GET_LINEINFO_IOCTL, struct gpio_v2_line_info
IS_USED = 1  # GPIO_V2_LINE_FLAG_USED
OUR_CONSUMER = "climb_controller"
NAMES = ("touch_fl", "touch_fr", "touch_rl", "touch_rr", "estop")


def text(raw):
    return raw.split(b"\0", 1)[0].decode("ascii", "replace")


def read_chip(path):
    """(label, {line name: consumer or ''}) of a GPIO chip."""
    chip = os.open(path, os.O_RDWR | os.O_CLOEXEC)
    try:
        info = fcntl.ioctl(chip, CHIP_INFO, bytes(68))
        lines = {}
        for offset in range(struct.unpack_from("I", info, 64)[0]):
            line = fcntl.ioctl(chip, LINE_INFO, bytes(64) + struct.pack("I", offset) + bytes(188))
            if text(line[:32]):
                is_used = struct.unpack_from("Q", line, 72)[0] & IS_USED
                lines[text(line[:32])] = (text(line[32:64]) or "the kernel") if is_used else ""
        return text(info[32:64]), lines
    finally:
        os.close(chip)


def check_lines(report, settings, folder=pathlib.Path("/dev")):
    """settings: the table climb.lines of the configuration."""
    wanted = settings["chip"]
    if wanted.startswith("unix:"):
        report.warning(f"climb.lines.chip is {wanted}: lines of a simulation", "on the robot: the label of a chip, as gpiodetect shows it")
        return
    chips, closed = {}, []
    for path in sorted(folder.glob("gpiochip*")):
        try:
            label, lines = read_chip(path)
            chips[label] = lines
        except OSError:
            closed.append(str(path))
    if wanted not in chips:
        others = ", ".join(sorted(chips)) or "none"
        hint = f"; {', '.join(closed)} cannot be read: run this as root" if closed else ""
        report.fault(f"no GPIO chip '{wanted}' (there: {others}){hint}", "load its driver, or name the right label in climb.lines.chip (gpiodetect lists them)")
        return
    for key in NAMES:
        consumer = chips[wanted].get(settings[key])
        if consumer is None:
            report.fault(f"chip '{wanted}' has no line '{settings[key]}' (climb.lines.{key})", "gpioinfo lists the names; they come from the device tree's gpio-line-names")
        elif consumer and consumer != OUR_CONSUMER:
            report.fault(f"line '{settings[key]}' is held by '{consumer}'", "end that program, or unbind that driver")
    if not report.findings:
        report.fine(f"chip '{wanted}' has all {len(NAMES)} lines")
