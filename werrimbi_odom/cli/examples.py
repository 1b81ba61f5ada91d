# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Examples at the end of each --help; `werrimbi simulate --out drives` makes what they name."""

from __future__ import annotations

import argparse

_DRIVES = "--robot drives/robot.yaml drives/train/*"
_JUDGED = f"{_DRIVES} --holdout drives/holdout/*"

EXAMPLES = {
    "info": ("info my_bag", "info my_bag --out robot.yaml"),
    "odom": ("odom --robot drives/robot.yaml drives/train/square_ccw --out odom.csv",),
    "compare": (f"compare {_DRIVES}", f"compare {_DRIVES} --leg 0.5 --report compare.html"),
    "diagnose": (f"diagnose {_JUDGED}", "diagnose --fleet robots --json fleet.json"),
    "history": (f"history {_DRIVES} --report history.html",),
    "add": (f"add castor_kick {_JUDGED} --out better.yaml",),
    "draft": (f"draft {_DRIVES} --out my_effect",),
    "workbench": (f"workbench {_JUDGED} --open",),
    "calibrate": (f"calibrate fit {_DRIVES} --out calibrated.yaml",),
    "calibrate umbmark": (
        "calibrate umbmark squares.csv --side 4.0 --robot robot.yaml --out new.yaml",
    ),
    "calibrate noise": (
        "calibrate noise runs.csv --distance 10.0 --robot robot.yaml --out new.yaml",
    ),
    "calibrate fit": (f"calibrate fit {_JUDGED} --out calibrated.yaml",),
    "simulate": ("simulate --out drives --hide random --seed 6", "simulate --list"),
    "explain": ("explain", "explain eccentric_left_wheel"),
}
"""Words behind `werrimbi`, by verb and kind."""


def epilog_of(verb: str) -> str:
    """The examples of a verb, as they stand below its options."""
    return "\n".join(["example:", *(f"  werrimbi {words}" for words in EXAMPLES[verb])])


class Formatter(argparse.HelpFormatter):
    """Fills sentences; leaves examples as they are."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        if text.startswith("example"):
            return text
        return super()._fill_text(text, width, indent)
