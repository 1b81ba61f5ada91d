# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Each drive is judged by the noise of its own reference, as of satellites without corrections."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.driven import COMMON
from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.estimated_values import values_of
from werrimbi_odom.report.comparison.phrases import reference_words

GOOD, BAD = 0.03, 0.3  # [m]
NOISE = 3e-4
GIVEN = WhiteNoiseRobot(0.3, 0.05, 0.05, NOISE, NOISE).entered(0.05)


def driven(seed: int, noises: Sequence[float], ratio: float = 1.0) -> list[Run]:
    random = np.random.default_rng(seed)
    robot = WhiteNoiseRobot(0.3, 0.05, 0.05 * ratio, NOISE, NOISE)
    return [
        drive(robot, wandering(random, 40.0), random, sigma_xy=noise, sigma_yaw=2e-3, every=5)
        for noise in noises
    ]


def least_and_most(runs: Sequence[Run], **options: float) -> tuple[float, float] | None:
    compared = compare(runs, GIVEN, EvaluationOptions(**options))  # type: ignore[arg-type]
    [(_, noise)] = compared.prepared.noises
    return noise.of_runs and noise.of_runs[0]


def test_drives_of_unlike_noise_are_told_apart() -> None:
    runs = driven(5, [GOOD, BAD, GOOD])
    assert least_and_most(runs) == pytest.approx((GOOD, BAD), rel=0.15)
    assert least_and_most(runs, sigma_xy=0.1) is None, "as given"
    [words] = reference_words(compare(runs, GIVEN))
    assert "mm and 0.11° each pose in the best drive and " in words


def test_an_honest_covariance_stays_so_beside_a_drive_of_bad_positions() -> None:
    figures = compare(driven(6, [GOOD, BAD, GOOD]), GIVEN).main.all.figures
    assert figures.nees == pytest.approx(1.0, abs=0.25)
    assert figures.coverage_95 == pytest.approx(0.95, abs=0.06)


@pytest.mark.parametrize("seeds", [range(3), in_evidence(range(3, 8))])
@pytest.mark.parametrize("noise", [GOOD, BAD])
def test_drives_of_one_noise_have_one(noise: float, seeds: range) -> None:
    assert {least_and_most(driven(seed, [noise] * 3)) for seed in seeds} == {None}


@pytest.mark.parametrize("seed", [3, in_evidence(4)])
def test_unequal_wheels_are_named_beside_a_drive_of_bad_positions(seed: int) -> None:
    """It was unknown: "a clock that is off by a large part of a second ..."."""
    found = diagnose(driven(seed, [GOOD, BAD, GOOD], 0.99), GIVEN, COMMON)
    assert found.verdict == "named"
    ratio = values_of(found, "unequal_wheel_radii")["ratio"]
    assert ratio.std is not None
    assert ratio.std < 3e-4
    assert abs(ratio.value - 0.99) < 3.0 * ratio.std
