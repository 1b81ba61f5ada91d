# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Short drives by a gyro: three turns that err alike by chance are no effect of the robot.

An error of a turn (scrubbing wheels) lasts for all of it, so its legs are one piece of evidence.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.driven import of_headings
from test.model.drives import ROBOT, read
from werrimbi_odom.effects import LIBRARY, find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run, Ticks
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.model.effect import Effect

RATE, DELAY, BASE = 50.0, 0.07, 1.04
SCRUB, SPIN_SCRUB = 0.06, 0.012
"""Standard deviations of a turn's error, as a share of it: of an arc, and of a spin."""


def driven(random: np.random.Generator, name: str, more: float | None = None) -> Run:
    """Two straight lines, two spins and an arc, in any order, with stops between them.

    Each arc turns by its own share less than the wheels say, or by `more` of its yaw rate's size.
    """
    speed, rate, share = ([np.zeros(100)] for _ in range(3))
    for kind in random.permutation(["spin", "straight", "arc", "straight", "spin"]):
        if kind == "straight":
            count, now, turning, error = int(RATE * random.uniform(2, 5)), 0.25, 0.0, 0.0
        elif kind == "spin":
            count, now = int(RATE * random.uniform(2, 3.5)), 0.0
            turning, error = random.choice([-0.6, 0.6]), random.normal(0.0, SPIN_SCRUB)
        else:
            count, now = int(RATE * random.uniform(1.5, 3)), 0.25
            turning, error = random.choice([-0.2, 0.2]), random.normal(0.0, SCRUB)
            error = error if more is None else -more
        stop = np.zeros(40)
        speed += [np.full(count, now), stop]
        rate += [np.full(count, turning), stop]
        share += [np.full(count, error), stop]
    smooth = np.ones(10) / 10.0
    driven, turned = (np.convolve(np.concatenate(part), smooth, "same") for part in (speed, rate))
    ticks = read(ROBOT, RATE, driven, turned)
    heading = np.cumsum(np.append(0.0, turned * (1.0 + np.concatenate(share)))) / RATE
    time = np.arange(0.0, ticks.time[-1], 0.01)
    walk = np.cumsum(random.normal(0.0, 2e-5, time.size))
    yaw = np.interp(time - DELAY, ticks.time, heading) / BASE + walk
    return Run(
        name,
        Path(name),
        Ticks(ticks.time, ticks.left, ticks.right),
        of_headings(time, yaw, "incremental"),
    )


SOME = [
    find(name)
    for name in (
        *("reference_delay", "track_width", "turn_dependent_track", "load_transfer"),
        *("lateral_slip", "left_backlash", "encoder_skew", "reference_scale"),
    )
]


def diagnosed(
    seed: int, drives: int, more: float | None = None, effects: Sequence[Effect] = SOME
) -> Diagnosis:
    random = np.random.default_rng(seed)
    runs = [driven(random, f"drive_{each}", more) for each in range(drives)]
    return diagnose(runs, ROBOT, effects, EvaluationOptions(reference_kind="incremental"))


@pytest.mark.evidence
@pytest.mark.parametrize(
    ("seed", "effects"),
    [
        (6, SOME),
        *(in_evidence(seed, LIBRARY) for seed in (6, 10, *range(15, 24))),
    ],
)
def test_three_arcs_are_too_few_to_name_an_effect(seed: int, effects: Sequence[Effect]) -> None:
    found = diagnosed(seed, 3, effects=effects)
    assert found.verdict != "none"
    assert set(found.found) <= {"reference_delay", "track_width"}
    assert "reference_delay" in found.found


@pytest.mark.evidence
@pytest.mark.parametrize("seed", [0, in_evidence(1)])
def test_what_the_arcs_of_many_drives_have_in_common_is_named(seed: int) -> None:
    found = diagnosed(seed, 8, 0.07)
    assert {"turn_dependent_track", "load_transfer"} & {*found.found, *found.rivals}
    assert "reference_delay" in found.found
