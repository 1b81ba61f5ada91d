# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Shared by several verbs: options, each declared once, examples, and the reading of drives."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from werrimbi_odom.effects.lookup import Collection
    from werrimbi_odom.files.recordings import DriveOptions, Recordings
    from werrimbi_odom.files.robot_files.robot_file import RobotFile
    from werrimbi_odom.progress import Show

N = TypeVar("N", int, float)
Found = TypeVar("Found")


def number(kind: type[N], low: float, high: float, otherwise: str) -> Callable[[str], N]:
    """Create a parser for an option's number; `otherwise`: message for other texts."""

    def read(text: str) -> N:
        with suppress(ValueError):
            value = kind(text)
            if low <= value <= high:
                return value
        raise argparse.ArgumentTypeError(f"{text!r} is {otherwise}")

    return read


# As DriveOptions has it, which this file does not wait for.
positive = number(float, 1e-9, 1e6, "not a number greater than zero (from 1e-9 to 1e6)")


def _file(says: str, metavar: str = "F", **more: Any) -> dict[str, Any]:
    return {"metavar": metavar, "type": Path, "help": says, **more}


_RUNS = "recorded drives: run folders or bags"
_TICKS = "topic of the wheels, in a bag with several; LEFT,RIGHT where each wheel has its own"
_REFERENCE = (
    "bag, or folder with reference.csv, that holds the reference of a drive whose RUN does not; "
    "once for each RUN"
)
_EFFECTS = "file with effects of your own, to try them; may be given again"

OPTIONS: dict[str, dict[str, Any]] = {
    "runs": _file(_RUNS, "RUN", nargs="+"),
    "--robot": _file("robot file", "R", required=True),
    "--ticks-topic": {"metavar": "T", "help": _TICKS},
    "--reference-topic": {"metavar": "T"},
    "--reference": _file(_REFERENCE, "RUN", action="append", default=[]),
    "--effects": _file(_EFFECTS, "FILE", action="append", default=[]),
    "--out": _file("robot file to write", "NEW", required=True),
    "--json": _file("write the numbers to this file, as JSON"),
    "--report": _file("write a page with plots (.html), or the plots (.pdf, .png)"),
    "--force": {"action": "store_true", "help": "overwrite --out if it exists"},
}
"""Options as most verbs use them."""


def declare(parser: argparse.ArgumentParser, *names: str, **otherwise: Any) -> None:
    """Add some of these options to a verb, optionally with other settings."""
    for name in names:
        parser.add_argument(name, **{**OPTIONS[name], **otherwise})


def add_recording_arguments(
    parser: argparse.ArgumentParser,
    holdout: bool = False,
    report: bool = True,
    required: bool = True,
    force: str = "",
) -> None:
    """Declare RUN..., --robot, the options for reading and evaluation, --json and --report.

    If RUN and --robot are not `required`, the verb checks them itself. `force` is what else --force
    means for the verb.
    """
    declare(parser, "runs", nargs="+" if required else "*")
    if holdout:
        parser.add_argument(
            "--holdout",
            metavar="RUN",
            nargs="+",
            default=[],
            type=Path,
            help="drives to judge on, which take no part in the fit",
        )
    declare(parser, "--robot", required=required)
    parser.add_argument(
        "--leg",
        metavar="M",
        type=positive,
        default=1.0,
        help="length of a leg [m], 1 if not given: drives are cut into legs of so much path (or a "
        "quarter turn on the spot), and each is judged by the pose at its end as seen from its "
        "start",
    )
    parser.add_argument(
        "--reference-kind",
        choices=("absolute", "incremental", "local_map"),
        help="absolute: each pose has noise of its own (motion capture); incremental: it adds up "
        "along the way (each scan matched with the last one); local_map: it also wanders slowly "
        "about the truth (a localiser, SLAM, satellites). If not given: incremental for a gyro, "
        "and for headings alone in a reference.csv (20 or more a drive, without sigma_yaw_rad), "
        "local_map for a localiser (map -> odom -> base_link, AMCL) and satellites, else absolute",
    )
    for part, unit, what in (
        ("xy", "M", "noise of the reference in x and in y [m], if known"),
        ("yaw", "RAD", "noise of the reference in heading [rad], if known"),
    ):
        parser.add_argument(f"--reference-sigma-{part}", metavar=unit, type=positive, help=what)
    declare(parser, "--ticks-topic")
    declare(
        parser,
        "--reference-topic",
        action="append",
        help="topic of the reference, in a bag with several; /tf:PARENT:CHILD among transforms; "
        "the scans of a lidar are matched with those of the last metres. "
        "Given twice, for poses or positions and for a gyro: the positions of the one with the "
        "headings of the other",
    )
    words = ", then once for each of --holdout" if holdout else ""
    declare(parser, "--reference", help=f"{OPTIONS['--reference']['help']}{words}")
    words = f"{force}{'; ' if force else ''}take a reference although it is made from the wheels"
    declare(parser, "--force", help=words)
    declare(parser, "--effects", "--json", *(["--report"] if report else []))


def read_recordings(arguments: argparse.Namespace) -> Recordings:
    """Read robot file, effects and runs, with a progress bar.

    InputError if an input is not usable, or a run is given twice.
    """
    from werrimbi_odom.api.drives import refuse_circles, told_apart
    from werrimbi_odom.cli.progress import share_done
    from werrimbi_odom.files.recordings import Asked, read
    from werrimbi_odom.files.references.gyro_headings import WORDS
    from werrimbi_odom.files.run_checks import words_about

    holdout = tuple(getattr(arguments, "holdout", None) or ())
    asked = Asked(arguments.robot, tuple(arguments.runs), holdout, how_of(arguments))
    collection = read_effects(arguments)
    with share_done("reading") as show:
        found = told_apart(read(asked, collection, show))
    circles = refuse_circles(found)
    wanders = any(
        run.reference is not None and run.reference.kind == "local_map"
        for run in (*found.runs, *found.holdout)
    )
    if arguments.reference_kind is None and wanders:
        circles.append(
            "the reference is a localiser (or satellites, or a gyro laid upon positions), whose "
            "errors wander: it is taken as "
            "--reference-kind local_map (absolute takes each pose's error as new)"
        )
    of_columns = not any(run.of_bag for run in (*found.runs, *found.holdout))
    if (
        arguments.reference_kind is None
        and of_columns
        and found.how.reference_kind == "incremental"
    ):
        circles.append(WORDS)
    remark(found.source, *words_about((*found.runs, *found.holdout)), *circles)
    return found


def on_recordings(
    arguments: argparse.Namespace, words: str, work: Callable[[Recordings, Show], Found]
) -> tuple[Recordings, Found]:
    """Read the recordings and process them, both with a progress bar named `words`."""
    from werrimbi_odom.cli.progress import share_done

    given = read_recordings(arguments)
    with share_done(words) as show:
        return given, work(given, show)


def remark(source: RobotFile, *more: str) -> None:
    """Print what is not used of a robot file, and similar remarks, on stderr."""
    warn(*(f"{source.path}: {each}" for each in source.remarks), *more)


def warn(*words: str) -> None:
    """Print warnings on stderr, each in a line."""
    for each in words:
        print(f"warning: {each}", file=sys.stderr)


def how_of(arguments: argparse.Namespace) -> DriveOptions:
    """Options for reading and evaluating drives."""
    from werrimbi_odom.files.recordings import DriveOptions

    topics = tuple(arguments.reference_topic or ())
    return DriveOptions(
        reference_kind=arguments.reference_kind,
        leg=arguments.leg,
        reference_sigma_xy=arguments.reference_sigma_xy,
        reference_sigma_yaw=arguments.reference_sigma_yaw,
        ticks_topic=arguments.ticks_topic,
        reference_topic=topics if len(topics) > 1 else next(iter(topics), None),
        effects=tuple(arguments.effects),
        references=tuple(arguments.reference),
        force_reference=arguments.force,
    )


def read_effects(arguments: argparse.Namespace) -> Collection:
    """Find all effects, including those of --effects; warnings go to stderr.

    InputError if a file of --effects is not usable.
    """
    from werrimbi_odom.effects.lookup import all_effects

    collection = all_effects(arguments.effects)
    warn(*collection.warnings)
    return collection


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
"""Words after `werrimbi`, by verb and kind."""


def add_verb(parsers: Any, name: str, says: str, words: str = "") -> argparse.ArgumentParser:
    """Declare a verb, or a kind of one (`words`: the verb and the kind), with its examples."""
    shown = (f"  werrimbi {example}" for example in EXAMPLES[words or name])
    made: argparse.ArgumentParser = parsers.add_parser(
        name,
        help=says,
        allow_abbrev=False,
        epilog="\n".join(["example:", *shown]),
        formatter_class=Formatter,
    )
    return made


class Formatter(argparse.HelpFormatter):
    """Wraps sentences; keeps the examples' line breaks."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        if text.startswith("example"):
            return text
        return super()._fill_text(text, width, indent)
