# SPDX-License-Identifier: BSD-3-Clause
"""What a check has to say."""

from dataclasses import dataclass

FINE, WARNING, FAULT = "ok", "warning", "FAULT"


@dataclass
class Finding:
    level: str
    check: str  # its name on the command line
    what: str
    fix: str = ""


class Report:
    """Collects the findings of one check."""

    def __init__(self, check):
        self._check = check
        self.findings = []

    def fine(self, what):
        self.findings.append(Finding(FINE, self._check, what))

    def warning(self, what, fix):
        self.findings.append(Finding(WARNING, self._check, what, fix))

    def fault(self, what, fix):
        self.findings.append(Finding(FAULT, self._check, what, fix))
