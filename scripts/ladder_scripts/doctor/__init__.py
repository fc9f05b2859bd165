# SPDX-License-Identifier: BSD-3-Clause
"""Checks of the computer that the robot's services run on. Each returns findings; a fault names its fix."""
