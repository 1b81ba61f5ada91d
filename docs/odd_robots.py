# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The diagnosis on robots and drives unlike those of the evidence: the table in diagnose.md.

Nothing, and ten effects of usual strength, hidden in each kind by the physics engine; fixed seeds.

    python docs/odd_robots.py [KIND...]
"""

from __future__ import annotations

import contextlib
import io
import json
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from werrimbi_odom.cli.main import main as werrimbi
from werrimbi_odom.simulation import (
    Manoeuvre,
    MoveLimits,
    Nominal,
    ReferenceSensor,
    TrueRobot,
    chain,
    drives,
    free,
    hide,
    out_and_back,
    record,
    square,
    write_robot_file,
    write_run,
)

HIDDEN = (
    "",
    "eccentric_left_wheel",
    "lateral_slip",
    "reference_delay",
    "right_backlash",
    "castor_kick",
    "longitudinal_slip",
    "left_missed_ticks",
    "encoder_skew",
    "floor_slope",
    "radius_drift",
)
USUAL = TrueRobot(left_wheel_noise=4.0e-4, right_wheel_noise=5.8e-4)


@dataclass(frozen=True)
class Kind:
    """A robot, what measures it, and what it drives."""

    says: str
    drives: dict[str, Manoeuvre]
    robot: TrueRobot = USUAL
    reference: ReferenceSensor = field(default_factory=ReferenceSensor)
    ticks_rate_hz: float = 50.0


def wandering(train: int, seconds: float, speed: float, turning: float) -> dict[str, Manoeuvre]:
    """Free drives, two of them held out."""
    names = [f"train/{n}" for n in range(train)] + ["holdout/10", "holdout/11"]
    return {
        name: free(seconds, seed=int(name.split("/")[1]), speed=speed, yaw_rate=turning)
        for name in names
    }


def six(drive: Callable[[int], Manoeuvre]) -> dict[str, Manoeuvre]:
    """Four drives and two held out."""
    return {f"{'train' if n < 4 else 'holdout'}/{n}": drive(n) for n in range(6)}


def sized(base: float, radius: float, ticks: float, mass: float, noise: float) -> TrueRobot:
    """A robot of another size."""
    return TrueRobot(
        wheel_separation=base,
        left_wheel_radius=radius,
        right_wheel_radius=radius,
        left_ticks_per_revolution=ticks,
        right_ticks_per_revolution=ticks,
        left_wheel_noise=noise,
        right_wheel_noise=noise,
        mass=mass,
        nominal=Nominal(base, radius),
    )


def _squares(number: int) -> Manoeuvre:
    return square(2.0, "ccw" if number % 2 else "cw", pace=MoveLimits(speed=0.4))


def _short(names: dict[str, int]) -> dict[str, Manoeuvre]:
    return {
        name: free(60.0 if len(names) == 1 else 40.0, seed=seed, speed=0.5, yaw_rate=1.5)
        for name, seed in names.items()
    }


SLOW = MoveLimits(speed=0.12, acceleration=0.2, yaw_rate=2.0, yaw_acceleration=4.0)
KINDS = {
    "squares": Kind("squares alone", six(_squares)),
    "lines": Kind("lines to and fro alone", six(lambda number: out_and_back(3.0, laps=3))),
    "one": Kind("a single drive of a minute", _short({"train/a": 1})),
    "two": Kind("two drives of 40 s", _short({"train/a": 0, "train/b": 1})),
    "slow_reference": Kind(
        "a pose a second, 2 cm and 1.1° of noise",
        drives(5),
        reference=ReferenceSensor(rate_hz=1.0, sigma_xy=0.02, sigma_yaw=0.02),
    ),
    "slow_ticks": Kind("counters read at 10 Hz", drives(5), ticks_rate_hz=10.0),
    "coarse": Kind(
        "60 counts a turn (5 mm)",
        drives(5),
        replace(USUAL, left_ticks_per_revolution=60.0, right_ticks_per_revolution=60.0),
    ),
    "coarsest": Kind(
        "20 counts a turn (16 mm)",
        drives(5),
        replace(USUAL, left_ticks_per_revolution=20.0, right_ticks_per_revolution=20.0),
    ),
    "tiny": Kind(
        "12 cm wide, 0.8 kg, 0.1 m/s",
        wandering(4, 60.0, 0.1, 1.5)
        | {"train/square": chain("s", square(0.4, pace=SLOW), square(0.4, "cw", pace=SLOW))},
        sized(0.12, 0.025, 1000.0, 0.8, 2.0e-4),
        ReferenceSensor(rate_hz=30.0, sigma_xy=5.0e-4, sigma_yaw=2.0e-3),
    ),
    "big": Kind(
        "90 cm wide, 60 kg, 1.4 m/s; poses of 2 cm",
        wandering(4, 90.0, 1.4, 1.0),
        sized(0.9, 0.16, 4096.0, 60.0, 1.0e-3),
        ReferenceSensor(rate_hz=10.0, sigma_xy=0.02, sigma_yaw=0.01),
    ),
}


def judged(kind: Kind, effect: str, folder: Path) -> str:
    """What the diagnosis makes of an effect in a kind: first, found, among rivals, none, WRONG."""
    odd = [hide(effect, None, seed=3).peculiarity] if effect else []
    written = kind.robot
    for each in odd:
        written = each.written(written)
    robot = write_robot_file(written, folder / "robot.yaml")
    for number, (name, drive) in enumerate(kind.drives.items()):
        run = record(
            kind.robot,
            drive,
            seed=77 + number,
            reference=kind.reference,
            ticks_rate_hz=kind.ticks_rate_hz,
            hidden=odd,
        )
        write_run(run, folder / name)
    runs, held = (sorted(folder.glob(f"{part}/*")) for part in ("train", "holdout"))
    words = ["diagnose", "--robot", robot, *runs, "--json", folder / "found.json"]
    words += ["--holdout", *held] if held else []
    with contextlib.redirect_stdout(io.StringIO()):
        assert werrimbi([str(word) for word in words]) == 0
    told = json.loads((folder / "found.json").read_text(encoding="utf-8"))
    verdict, found = told["verdict"], [each["effect"] for each in told["found"]]
    if not effect:
        return "clean" if verdict == "none" else f"WRONG: {verdict} {found}"
    if verdict == "named" and effect in found:
        return "first" if found[0] == effect else "found"
    if verdict == "ambiguous" and effect in (*told["rivals"], *found):
        return "among rivals"
    return "none" if verdict == "none" else f"WRONG: {verdict} {found}"


def main() -> None:
    """Print the table."""
    print("| kind | nothing hidden | named first | among rivals | none | else |")
    print("| --- | --- | --- | --- | --- | --- |")
    for name in sys.argv[1:] or KINDS:
        told: Counter[str] = Counter()
        for effect in HIDDEN:
            with tempfile.TemporaryDirectory() as folder:
                told[judged(KINDS[name], effect, Path(folder))] += 1
        clean = "none" if told.pop("clean", 0) else "WRONG"
        shown = [told.pop(word, 0) for word in ("first", "among rivals", "none")]
        rest = ", ".join(f"{word} {count}" for word, count in told.items()) or "0"
        print(
            f"| {KINDS[name].says} | {clean} | {' | '.join(map(str, shown))} | {rest} |", flush=True
        )


if __name__ == "__main__":
    main()
