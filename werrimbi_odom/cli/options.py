# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Options that several verbs have, each declared once."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any


def positive(text: str) -> float:
    """A number greater than zero."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value > 0.0):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number greater than zero")
    return value


def _file(says: str, metavar: str = "F", **more: Any) -> dict[str, Any]:
    return {"metavar": metavar, "type": Path, "help": says, **more}


_RUNS = "recorded drives: run folders or bags"
_TICKS = "topic of the ticks, in a bag with several; LEFT,RIGHT for one a wheel"
_EFFECTS = "file with effects of your own, to try them; may be given again"

OPTIONS: dict[str, dict[str, Any]] = {
    "runs": _file(_RUNS, "RUN", nargs="+"),
    "--robot": _file("robot file", "R", required=True),
    "--ticks-topic": {"metavar": "T", "help": _TICKS},
    "--reference-topic": {"metavar": "T"},
    "--effects": _file(_EFFECTS, "FILE", action="append", default=[]),
    "--out": _file("robot file to write", "NEW", required=True),
    "--json": _file("write the numbers to this file"),
    "--report": _file("write a page with plots (.html), or the plots (.pdf, .png)"),
    "--force": {"action": "store_true", "help": "overwrite --out if it exists"},
}
"""As most verbs have them."""


def declare(parser: argparse.ArgumentParser, *names: str, **otherwise: Any) -> None:
    """Give a verb some of these options, where wanted with other words."""
    for name in names:
        parser.add_argument(name, **{**OPTIONS[name], **otherwise})
