# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Visual odometry by keyframes as a reference: its map errs anew at each keyframe, for good."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.evidence import in_evidence
from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.effects.lookup import all_effects
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.inference.calibration_parametrisation import (
    LOGARITHMS,
    calibration_deviation,
)
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

TRUE = WhiteNoiseRobot(left_noise=4e-4, right_noise=5.8e-4)
NEAR_KEYFRAME = 2e-3, 2e-3
"""Standard deviations of a pose against its keyframe [m, rad]."""
OF_KEYFRAME = np.array([5e-3, 5e-3, 3e-3])
"""Of a keyframe against the one before it, in its axes [m, m, rad]."""
EVERY = 0.4, np.radians(15.0)
"""A new keyframe after a way [m] or a turn [rad]."""


def keyframes(path: Floats) -> list[int]:
    """The rows of a path (n, 3) at which a new keyframe is made."""
    rows = [0]
    for row, (x, y, yaw) in enumerate(path):
        x_0, y_0, yaw_0 = path[rows[-1]]
        if np.hypot(x - x_0, y - y_0) > EVERY[0] or abs(yaw - yaw_0) > EVERY[1]:
            rows.append(row)
    return rows


def by_keyframes(run: Run, random: np.random.Generator) -> Run:
    """The run as keyframe odometry shows it: each keyframe turns and shifts all that follows."""
    reference = run.reference
    assert reference is not None
    place, yaw = reference.x + 1j * reference.y, np.unwrap(reference.yaw)
    path = np.column_stack([place.real, place.imag, yaw])
    for row in keyframes(path)[1:]:
        ahead, left, turn = OF_KEYFRAME * random.standard_normal(3)
        pivot = place[row]
        place[row:] = pivot + (place[row:] - pivot) * np.exp(1j * turn)
        place[row:] += (ahead + 1j * left) * np.exp(1j * yaw[row])
        yaw[row:] += turn
    return replace(run, reference=Reference(reference.time, place.real, place.imag, yaw))


def session(seed: int) -> list[Run]:
    """Three drives, each seen ten times a second."""
    found = []
    for number in range(3):
        random = np.random.default_rng([seed, number, 11])
        near = {"sigma_xy": NEAR_KEYFRAME[0], "sigma_yaw": NEAR_KEYFRAME[1]}
        run = drive(TRUE, wandering(random, 100.0), random, every=5, **near)
        found.append(replace(by_keyframes(run, random), name=f"run_{number}"))
    return found


RADII_OFF = (1.0, 0.995, 1.005)


def entered(off: tuple[float, float, float]) -> Robot:
    """The robot's file. `off`: its base and radii over the true ones."""
    true = TRUE.entered()
    return replace(
        true,
        **{name: share * getattr(true, name) for name, share in zip(MULTIPLIERS, off, strict=True)},
    )


@pytest.mark.parametrize(
    ("effect", "off"),
    [
        in_evidence(None, (1.0, 1.0, 1.0), id="nothing"),
        in_evidence("track_width", (1.03, 1.0, 1.0), id="base"),
        pytest.param("unequal_wheel_radii", RADII_OFF, id="radii"),
    ],
)
@pytest.mark.parametrize("seed", [1, in_evidence(2), in_evidence(3)])
def test_what_is_hidden_is_named_with_its_size(
    seed: int, effect: str | None, off: tuple[float, float, float]
) -> None:
    true = TRUE.entered()
    given = entered(off)
    options = EvaluationOptions(reference_kind="local_map")
    found = diagnose(session(seed), given, all_effects().effects, options)
    assert found.found == (() if effect is None else (effect,))
    assert found.verdict == ("none" if effect is None else "named")
    error = calibration_deviation(found.robot, given) - calibration_deviation(true, given)
    for name, by in zip(LOGARITHMS, error, strict=True):
        std = found.told.std_of_size(name)
        assert abs(by) < 3.0 * std
        assert std < 3e-3


@pytest.mark.evidence
@pytest.mark.parametrize("seed", [1, 2, 6])
def test_so_it_is_where_the_reference_is_not_said_to_wander(seed: int) -> None:
    """With independent errors nothing was seen of radii 1 % apart, and that stood: *none*."""
    found = diagnose(session(seed), entered(RADII_OFF), all_effects().effects)
    assert found.wander is not None
    assert (found.verdict, found.found) == ("named", ("unequal_wheel_radii",))
