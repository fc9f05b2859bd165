# SPDX-License-Identifier: BSD-3-Clause
"""Modules of the Python scripts: standard library only."""
