# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Second act: an effect is hidden by the physics engine, found, and added; all by the verbs."""

from __future__ import annotations

import json
import os
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import werrimbi_odom as wo
from werrimbi_odom.cli.main import main as werrimbi
from werrimbi_odom.cli.progress import share_done
from werrimbi_odom.demo.pictures import save_and_tell
from werrimbi_odom.errors import InputError
from werrimbi_odom.report.adding.words import value_told
from werrimbi_odom.report.document import Table
from werrimbi_odom.report.terminal import as_text

if TYPE_CHECKING:
    from werrimbi_odom.api.result import Result
    from werrimbi_odom.inference.adding.added import Added

HIDE = ("--hide", "random", "--seed", "6")


def second_act(out: Path) -> None:
    """Hide an effect, compare, diagnose, add, and show the error before and after.

    Parameters
    ----------
    out
        Folder for the drives, the new robot file and the picture. Drives of an earlier demo that
        are there are taken.

    Raises
    ------
    InputError
        When something cannot be written.
    """
    print("\nSecond act: why does odometry err?\n")
    place = out / "drives"
    print("A physics engine drives another robot for eleven minutes, and hides an effect in it.")
    if (place / "truth.json").exists():
        print(f"It did so before: {place}")
    else:
        words = ["simulate", "--out", str(place), *HIDE]
        _command(words)
        if werrimbi(words) != 0:
            raise InputError(f"the drives were not made; {place} must be new or empty")
    found_in(place, out)


def found_in(place: Path, out: Path) -> None:
    """What the verbs say of simulated drives, shortened, and the error before and after."""
    file = place / "robot.yaml"
    robot = wo.read_robot(file)
    train, holdout = (
        [wo.read_run(path, robot) for path in sorted((place / name).iterdir())]
        for name in ("train", "holdout")
    )
    given = ["--robot", str(file), f"{place / 'train'}/*"]
    judged = [*given, "--holdout", f"{place / 'holdout'}/*"]

    _command(["compare", *given])
    with share_done("comparing") as show:
        _tell(wo.compare(robot, train, show=show), "- The covariance")
    _command(["diagnose", *judged])
    with share_done("diagnosing") as show:
        diagnosed = wo.diagnose(robot, train, holdout=holdout, show=show)
    _tell(diagnosed, "Check it:")
    names = diagnosed.found.diagnosis.found
    if not names:
        print("\nNothing was named, so nothing is added.")
        return
    better = out / "better.yaml"
    _command(["add", ",".join(names), *judged, "--out", str(better)])
    with share_done("fitting") as show:
        added = wo.add(names, robot, train, holdout=holdout, show=show)
    _tell(added, "\n\n")
    added.write_robot(better, force=True)
    print(f"\n{_in_short(added.found, place, len(holdout))}")
    figure = added.figures()["falling"]
    heading = {"text": f"Error before and after {', '.join(names)}", "x": 0.02, "y": 0.97}
    figure.update_layout(title=heading, width=1000, margin_t=100)
    save_and_tell(figure, out / "error")
    print("\nThe same by clicking:")
    _command(["workbench", *judged, "--open"])


def _in_short(added: Added, place: Path, drives: int) -> str:
    """The truth, what was found, and what that gained where it was not fitted."""
    hidden = json.loads((place / "truth.json").read_text(encoding="utf-8"))["hidden"]
    was = (
        f"{each['effect']}, {each['strength']:.3g} {each['unit']}: {each['says']}"
        for each in hidden
    )
    seen = {name: item for name, item in added.parameters.items() if item.remark != "null"}
    sizes = ", ".join(f"{name} {value_told(item)}" for name, item in seen.items())
    side = added.holdout
    errors = (side.error("before"), side.error("after"), added.noise_alone(side))
    before, after, noise = (f"{1e3 * error:.2f} mm" for error in errors)
    rows = [
        ("hidden", f"{'; '.join(was)} ({place / 'truth.json'})"),
        ("found", f"{added.name}: {sizes}"),
        ("error", f"{before} before, {after} after, over legs of {side.after.leg:g} m of "
         f"{drives} drives that took no part; noise alone makes {noise}"),
    ]  # fmt: skip
    return as_text([Table("In short", (), rows)])


def _command(words: Sequence[str]) -> None:
    """A command as one would type it here; a pattern is left to the shell."""
    beside = Path(sys.executable).with_name("werrimbi")
    name = os.path.relpath(beside) if beside.exists() else "werrimbi"
    line = " ".join(word if word.endswith("/*") else shlex.quote(word) for word in words)
    print(f"\n$ {name} {line}")


def _tell(result: Result[Any], end: str) -> None:
    """The words of a verb up to some of them."""
    print(result.summary().partition(end)[0].rstrip())
