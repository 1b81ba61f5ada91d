# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Steps in which all that a robot turns may be the noise of its counts.

A robot that is kept straight by a gyro, or by whoever steers it, turns by its wheels all the same:
their noise is in the counts. By headings alone that turn is an error of its own size, and any law
by which a turn is worth nothing on straight stretches explains it (errors in variables). So turns
there are no evidence: they are left out of the patterns, and what they feign is a nuisance. With
positions, travel says on the same stretches that the wheels roll as they should.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.step_jacobians import Amount
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.leg_noise import DrivenPath
from werrimbi_odom.inference.fitting.quantisation import quantisation_variance
from werrimbi_odom.inference.fitting.whitened_innovations import Point

TURN = Amount("heading", "turn")


def straight_steps(runs: Concatenated, point: Point, path: DrivenPath) -> NDArray[np.bool_]:
    """Steps around which the robot turned by no more than noise does, (n,); none by positions."""
    turn = path.motion.turn
    if np.isfinite(runs.start[:, 0]).any():
        return np.zeros(turn.size, dtype=np.bool_)
    robot, variances = point.model.robot, point.variances
    left, right = (np.abs(side) for side in path.travel)
    noise = (variances.left[0] * left + variances.right[0] * right) / robot.track**2
    duration = float(np.median(runs.drive(robot).duration))
    window = np.ones(min(max(round(rules.STRAIGHT_WINDOW / duration), 1), turn.size))
    turned = np.convolve(turn, window, "same")
    about = np.convolve(noise, window, "same") + 2.0 * quantisation_variance(robot)[2]
    return np.asarray(np.abs(turned) <= rules.STRAIGHT_SIGMAS * np.sqrt(about))


def is_turn(amount: Amount) -> bool:
    """Whether the error that headings see is in proportion to the turn of the step."""
    return amount == TURN or (amount.channel == "along" and amount.of_wheels)
