# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi calibrate`: a robot file with better numbers in it, from drives and measurements."""

from __future__ import annotations

import argparse
from importlib import import_module

from werrimbi_odom.cli.examples import Formatter, epilog_of

HELP = "better numbers for the robot file, with error bars"

KINDS = {
    "umbmark": "wheel base and radii from squares in both senses (the paper's section 3)",
    "noise": "noise of the wheels from drives out and back (the paper's section 5.2)",
    "fit": "all of them from any driving with a reference",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the three ways of calibrating and their options."""
    kinds = parser.add_subparsers(dest="kind", metavar="KIND", required=True)
    for kind, says in KINDS.items():
        below = kinds.add_parser(
            kind,
            help=says,
            allow_abbrev=False,
            epilog=epilog_of(f"calibrate {kind}"),
            formatter_class=Formatter,
        )
        import_module(_module(kind)).add_arguments(below)


def run(arguments: argparse.Namespace) -> int:
    """Calibrate; 0 on success.

    Raises
    ------
    InputError
        When something given cannot be used.
    """
    return int(import_module(_module(arguments.kind)).run(arguments))


def _module(kind: str) -> str:
    return f"werrimbi_odom.cli.calibrate_{kind}"
