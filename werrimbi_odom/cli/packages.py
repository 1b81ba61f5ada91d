# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Python packages that not every robot has: which verb needs which, said before its work."""

from __future__ import annotations

import argparse
import importlib.util

from werrimbi_odom.errors import InputError

EXTRAS = {
    "scipy": "tools",
    "plotly": "tools",
    "kaleido": "tools",
    "rosbags": "tools",
    "rclpy": "ros",
    "threadpoolctl": "tools",
    "rich": "tools",
    "nicegui": "workbench",
    "distributed": "cluster",
    "mujoco": "simulation",
}
"""Of the packages that are not always there, the extra that brings each."""

_FITS = ("scipy",)
NEEDED = {
    "info": _FITS,
    "compare": _FITS,
    "diagnose": _FITS,
    "history": _FITS,
    "add": _FITS,
    "draft": _FITS,
    "calibrate": _FITS,
    "workbench": (*_FITS, "plotly", "nicegui"),
    "simulate": ("mujoco",),
}
"""By verb; what an option needs besides is said where that option is looked at."""


def refuse_lacking(arguments: argparse.Namespace) -> None:
    """Whether everything that a verb will import is there.

    Raises
    ------
    InputError
        When it is not; the message says how to get it.
    """
    needed = NEEDED.get(arguments.verb, ())
    for name in reversed(needed):  # the last is of the extra that brings the others too
        refuse_without(name, arguments.verb)
    if getattr(arguments, "fleet", None) is not None:
        refuse_without("threadpoolctl", "--fleet")


def refuse_without(name: str, who: str) -> None:
    """Whether one package is there.

    Raises
    ------
    InputError
        When it is not.
    """
    if importlib.util.find_spec(name) is None:
        raise InputError(lacking(name, who))


def lacking(name: str, who: str) -> str:
    """What to say where a package is not there."""
    extra = EXTRAS.get(name.partition(".")[0])
    wanted = f"'werrimbi_odom[{extra}]'" if extra else name
    return f"{who} needs the Python package {name}: pip install {wanted}"
