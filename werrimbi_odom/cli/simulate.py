# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi simulate`: drives of a robot in a physics engine, with a hidden effect."""

from __future__ import annotations

import argparse
import json
import os
import shlex
import shutil
import tempfile
import zlib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from werrimbi_odom.errors import InputError

if TYPE_CHECKING:
    from werrimbi_odom.simulation import FieldDrive, Hidden, Peculiarity, Recording, TrueRobot

HELP = "make drives of a robot in a physics engine, with a hidden effect"
_KINDS = {
    "effect": "Effects of the library (`random` takes one of these)",
    "mistake": "Mistakes of set-up",
    "outside": "Effects that the library does not hold",
    "robot": "Another kind of robot",
    "event": "What happens at an instant",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi simulate`."""
    parser.description = (
        "Drives a robot through a physics engine and writes DIR/robot.yaml, eleven runs below "
        "DIR/train and DIR/holdout, and what was hidden in DIR/truth.json. Read that last."
    )
    parser.add_argument("--out", metavar="DIR", type=Path, help="new or empty folder to write")
    parser.add_argument(
        "--hide",
        metavar="EFFECT[=STRENGTH]",
        action="append",
        default=[],
        help="effect to hide, nothing if not given; several times for several; STRENGTH in the "
        "effect's own unit, else drawn from a realistic range; `random` takes any effect of the "
        "library",
    )
    parser.add_argument(
        "--seed",
        metavar="N",
        type=int,
        default=1,
        help="the same seed, the same drives (default 1)",
    )
    parser.add_argument(
        "--counters-keep-zero",
        action="store_true",
        help="a counter's zero always belongs to the same angle of its wheel (absolute encoders); "
        "by default counters start anywhere, as after switching on",
    )
    parser.add_argument(
        "--like",
        choices=("laboratory", "field"),
        default="laboratory",
        help="laboratory: counters and motion capture, in run folders; field: bags (rosbag2) with "
        "joint states, a gyro, a lidar, /odom and /tf of a localiser, and the robot held and "
        "carried in between (truth.json says when)",
    )
    parser.add_argument(
        "--list", action="store_true", help="list what can be hidden, with units, and stop"
    )


def run(arguments: argparse.Namespace) -> int:
    """Write the session; return 0."""
    from werrimbi_odom import simulation
    from werrimbi_odom.cli.progress import share_done

    if arguments.list:
        width = max(len(entry.name) for entry in simulation.CATALOGUE)
        kind = ""
        for entry in simulation.CATALOGUE:
            if entry.kind != kind:
                kind = entry.kind
                print(_KINDS[kind])
            print(f"  {entry.name:{width}}  {entry.range_in_words:28}  {entry.says}")
        return 0
    if arguments.out is None:
        raise InputError("--out DIR is missing")
    if arguments.seed < 0:
        raise InputError("--seed must not be negative")
    hidden = _chosen(arguments.hide, arguments.seed)
    robot = simulation.TrueRobot(
        left_wheel_noise=4.0e-4,
        right_wheel_noise=5.8e-4,
        counters_keep_zero=arguments.counters_keep_zero,
    )
    odd = [each.peculiarity for each in hidden]
    seen: dict[str, dict[str, object]] = {}
    events: dict[str, list[dict[str, object]]] = {}
    with _new_folder(arguments.out) as folder, share_done("driving") as show:
        written = robot
        for each in odd:
            written = each.written(written)
        simulation.write_robot_file(written, folder / "robot.yaml")
        count = len(simulation.drives(arguments.seed))
        runs = simulation.session(robot, arguments.seed, hidden=odd)
        try:
            for number, (name, recording) in enumerate(runs, start=1):
                show(number / count, name)
                happened = recording.happened
                if arguments.like == "field":
                    drive = _in_the_field(recording, written, odd, arguments.seed, folder / name)
                    seen[name], happened = drive.truth, drive.happened
                else:
                    simulation.write_run(recording, folder / name)
                if happened:
                    events[name] = [asdict(each) for each in happened]
        except (simulation.UnstableError, ValueError) as error:
            raise InputError(f"no such robot can be built: {str(error).splitlines()[0]}") from error
        truth = _truth(hidden, arguments.seed, robot)
        if seen:
            truth["field"] = seen
        if events:
            truth["events"] = events
        (folder / "truth.json").write_text(json.dumps(truth, indent=2) + "\n", encoding="utf-8")
    out = arguments.out
    print(f"{out}: robot.yaml, 7 runs in train, 4 in holdout; what is hidden is in truth.json")
    words = ["werrimbi", "compare", "--robot", str(out / "robot.yaml")]
    words += ["--reference-topic", "/tf:map:base_link"] if arguments.like == "field" else []
    print(f"next: {shlex.join([*words, str(out / 'train')])}/*")
    return 0


def _in_the_field(
    recording: Recording, robot: TrueRobot, odd: Sequence[Peculiarity], seed: int, folder: Path
) -> FieldDrive:
    """Write a drive as a bag; return it, with its ground truth for truth.json."""
    from werrimbi_odom import simulation

    number = zlib.crc32(folder.name.encode() + folder.parent.name.encode())
    drive = simulation.as_in_the_field(
        recording, robot, seed=1000 * seed + number, robot_seed=seed, hidden=odd
    )
    simulation.write_field_bag(drive, robot, folder)
    return drive


def _chosen(wishes: Sequence[str], seed: int) -> list[Hidden]:
    """Effects of --hide; strengths that are not given are drawn at random."""
    from werrimbi_odom.simulation import WishError, wished

    try:
        return wished(wishes, seed=seed)
    except WishError as error:
        raise InputError(f"--hide: {error} (all: werrimbi simulate --list)") from error


def _truth(hidden: Sequence[Hidden], seed: int, robot: object) -> dict[str, object]:
    return {
        "hidden": [
            {
                "effect": each.entry.name,
                "strength": each.strength,
                "unit": each.entry.unit,
                "says": each.entry.says,
                "kind": each.entry.kind,
                "parameters": asdict(each.peculiarity),
            }
            for each in hidden
        ],
        "seed": seed,
        "robot_before_hiding": asdict(robot),  # type: ignore[call-overload]
    }


@contextmanager
def _new_folder(out: Path) -> Iterator[Path]:
    """Yield a temporary folder beside `out`; it is renamed to `out` on success, else deleted."""
    target = out.absolute()
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        folder = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    except OSError as error:
        raise InputError(f"{out} cannot be written: {error.strerror}") from error
    try:
        yield folder
        umask = os.umask(0)
        os.umask(umask)
        folder.chmod(0o777 & ~umask)  # mkdtemp's folders are private to their owner
        folder.replace(target)
    except OSError as error:
        raise InputError(f"{out} cannot be written: {error.strerror}") from error
    finally:
        shutil.rmtree(folder, ignore_errors=True)
