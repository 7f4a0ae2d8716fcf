# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""One thing that is wrong with a recording or a setup."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

Number = bool | int | float


@dataclass(frozen=True, slots=True)
class Trouble:
    """What is wrong, how that shows, and what to do."""

    code: str
    """for programs (docs/troubles.md)"""
    text: str
    """one sentence, without a stop at its end"""
    advice: str
    """what to do, likewise"""
    evidence: Mapping[str, Number] = field(default_factory=dict)
    """the figures behind it"""

    def __str__(self) -> str:
        """For people."""
        return f"{self.text}: {self.advice}"

    def to_dict(self) -> dict[str, Any]:
        """As report.json holds it."""
        return {"code": self.code, "text": self.text, "advice": self.advice, "evidence": dict(self.evidence)}
