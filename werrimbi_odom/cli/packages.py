# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Optional Python packages: which verb needs which, checked before its work."""

from __future__ import annotations

import argparse
import importlib.util
import sys
import sysconfig
from pathlib import Path

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
"""Extra of this package that installs each optional package."""

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
"""Packages by verb; those of an option are checked where the option is."""


def refuse_lacking(arguments: argparse.Namespace) -> None:
    """Check that all packages of a verb are installed.

    InputError if one is missing; the message says how to install it.
    """
    needed = NEEDED.get(arguments.verb, ())
    for name in reversed(needed):  # the extra of the last one installs the others too
        refuse_without(name, arguments.verb)
    if getattr(arguments, "fleet", None) is not None:
        refuse_without("threadpoolctl", "--fleet")


def refuse_without(name: str, who: str) -> None:
    """Check that a package is installed; InputError if it is missing."""
    if importlib.util.find_spec(name) is None:
        raise InputError(lacking(name, who))


def lacking(name: str, who: str) -> str:
    """Message about a missing package."""
    extra = EXTRAS.get(name.partition(".")[0])
    wanted = f"'werrimbi_odom[{extra}]'" if extra else name
    # Where the system's own Python is managed by its distribution (PEP 668), pip refuses without.
    managed = (
        sys.prefix == sys.base_prefix
        and Path(sysconfig.get_path("stdlib"), "EXTERNALLY-MANAGED").exists()
    )
    pip = "pip install --user --break-system-packages" if managed else "pip install"
    return f"{who} needs the Python package {name}: {pip} {wanted}"
