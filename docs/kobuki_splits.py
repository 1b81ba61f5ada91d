# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What `diagnose` says of a Kobuki by any of its drives and at any rate of its gyro.

    python docs/kobuki_splits.py [ROBOT...]

Prints a line for each set of drives (all, all but one, one alone), kind of reference (incremental,
absolute) and share of the gyro's readings (all, every second, every tenth). Some seconds a line.
"""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Literal

import numpy as np

from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.estimated_values import values_of

ROOT = Path(__file__).parents[1]
ROBOTS = Path(os.environ.get("WERRIMBI_DATA", ROOT / "recordings")) / "robots"
KINDS: tuple[Literal["incremental", "absolute"], ...] = ("incremental", "absolute")
EVERY = (1, 2, 10)


def thinned(run: Run, every: int) -> Run:
    """A drive with one of so many readings of its reference."""
    assert run.reference is not None
    rows = np.arange(run.reference.time.size) % every == 0
    return replace(run, reference=run.reference.chosen(rows))


def splits(count: int) -> list[tuple[int, ...]]:
    """All drives, all but each, and each alone."""
    every = tuple(range(count))
    but_one = [tuple(k for k in every if k != left) for left in every if count > 1]
    return list(dict.fromkeys([every, *but_one, *((k,) for k in every)]))


def told(name: str) -> None:
    """Prints the lines of a robot."""
    robot_file = read_robot_file(ROBOTS / name / "robot.yaml")
    drives = [read_run(path, robot_file) for path in sorted((ROBOTS / name).glob("part_*"))]
    for chosen, kind, every in product(splits(len(drives)), KINDS, EVERY):
        found = diagnose(
            [thinned(drives[k], every) for k in chosen],
            robot_file.robot,
            LIBRARY,
            EvaluationOptions(reference_kind=kind),
            holdout=[thinned(run, every) for k, run in enumerate(drives) if k not in chosen],
        )
        sizes = "; ".join(
            f"{effect} "
            + ", ".join(f"{key} {x.value:.5g} ± {x.std:.2g}" for key, x in values.items())
            for effect in found.found
            for values in [values_of(found, effect)]
        )
        rivals = f"; rivals {', '.join(found.rivals)}" if found.rivals else ""
        whose = "+".join(str(k) for k in chosen)
        print(f"{name} {whose} {kind} {every}: {found.verdict}: {sizes}{rivals}", flush=True)


if __name__ == "__main__":
    for name in sys.argv[1:] or ("kobuki_sound", "kobuki_left_taped", "kobuki_right_taped"):
        told(name)
