# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi odom`: dead reckoning of a run, with pose and covariance per row of ticks."""

from __future__ import annotations

import argparse
import json
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from werrimbi_odom.cli.options import declare, remark
from werrimbi_odom.progress import Show

if TYPE_CHECKING:
    from werrimbi_odom.api.odom import Reckoned

HELP = "dead reckoning of a recorded run, with its covariance"
COLUMNS = "t_s,x_m,y_m,yaw_rad,xx,xy,xyaw,yy,yyaw,yawyaw"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi odom`."""
    parser.description = (
        "Dead reckoning of a run, started where the reference shows its first pose. Writes a row "
        f"for each row of ticks: {COLUMNS} (the covariance in m², m·rad and rad²; a row of ticks "
        "that could not be used repeats the latest estimate). An existing --out is replaced."
    )
    parser.add_argument("run", metavar="RUN", type=Path, help="run folder or bag")
    declare(parser, "--robot")
    declare(parser, "--out", metavar="CSV", help="file to write")
    declare(parser, "--json", metavar="FILE")
    declare(parser, "--ticks-topic")
    declare(
        parser,
        "--reference-topic",
        help="topic of the reference, in a bag with several; /tf:PARENT:CHILD among transforms; "
        "`none` for no reference",
    )
    parser.add_argument(
        "--reference",
        metavar="RUN",
        type=Path,
        help="what holds the reference of this drive, where RUN does not: another bag, or a folder "
        "with reference.csv",
    )
    parser.add_argument(
        "--as-reference",
        action="store_true",
        help="write what the reference is predicted to show (its lever arm, yaw offset, delays and "
        "mirror, as the robot file has them) instead of the axle's midpoint",
    )
    words = "file with effects of your own, which the robot file may name; may be given again"
    declare(parser, "--effects", help=words)


def run(arguments: argparse.Namespace) -> int:
    """Read, compute, write, report; return 0."""
    from werrimbi_odom.api.drives import read_robot, read_run
    from werrimbi_odom.api.odom import odom
    from werrimbi_odom.cli.progress import share_done

    with share_done("reading") as show:
        robot = read_robot(arguments.robot, arguments.effects)
        run = read_run(
            arguments.run,
            robot,
            ticks_topic=arguments.ticks_topic,
            reference_topic=arguments.reference_topic,
            reference=arguments.reference,
            progress=lambda share: show(0.5 * share, "reading"),
        )
        show(0.5, "reckoning")
        result = odom(robot, run)
        _write(arguments, result, lambda share, words: show(0.5 + 0.5 * share, words))
    remark(robot, *(f"{run.path}: {words}" for words in run.damage))
    print(result.summary())
    written = [arguments.out, *([arguments.json] if arguments.json else [])]
    print(f"written: {', '.join(map(str, written))}")
    return 0


def _write(arguments: argparse.Namespace, result: Reckoned, show: Show) -> None:
    """Write both files, or neither."""
    with ExitStack() as files:
        if arguments.json is not None:
            from werrimbi_odom.files.text_files import replacing

            file = files.enter_context(replacing(arguments.json))
            json.dump(result.to_dict(), file, indent=2, allow_nan=False)
            file.write("\n")
        result.write_rows(arguments.out, as_reference=arguments.as_reference, show=show)
