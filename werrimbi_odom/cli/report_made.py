# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a report says of how it was made: the command as it was typed, and what it worked on."""

from __future__ import annotations

import argparse
import shlex
import sys
from collections.abc import Iterable
from datetime import datetime, timezone
from pathlib import Path


def made_of(arguments: argparse.Namespace) -> dict[str, str]:
    """Command, files and options, for `report.page`."""
    made = {"command": shlex.join(["werrimbi", *sys.argv[1:]])}
    for name, word in (
        ("robot", "robot file"),
        ("runs", "drives"),
        ("holdout", "held-out drives"),
        ("results", "results"),
        ("effects", "effects of your own"),
    ):
        value = getattr(arguments, name, None)
        if value:
            made[word] = ", ".join(map(str, _each(value)))
    if hasattr(arguments, "leg"):
        made["legs"] = f"{arguments.leg:g} m"
    if getattr(arguments, "reference_kind", None):
        made["reference"] = arguments.reference_kind
    made["made on"] = datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC")
    return made


def _each(value: Path | Iterable[Path]) -> Iterable[Path]:
    return [value] if isinstance(value, Path) else value
