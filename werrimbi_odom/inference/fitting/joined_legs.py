# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Predictions of long legs from those of the short legs that they merge.

A leg's error is the sum of its parts' errors, each rotated into the frame of the whole and carried
to its end (`model.covariance.carried`). So any number of leg lengths costs one pass over the steps.
"""

from __future__ import annotations

import numpy as np

from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import NUISANCES, Model
from werrimbi_odom.inference.fitting.leg_loop import turn_into
from werrimbi_odom.inference.fitting.prediction import Prediction, predict_all
from werrimbi_odom.model.driven_motion import acts
from werrimbi_odom.model.effect import view_of, wiring_of
from werrimbi_odom.model.pose import Floats


def predict_joined(model: Model, runs: Concatenated) -> Prediction:
    """As `predict_all`, from the finer legs of `runs` where that is exact."""
    if runs.finer is None or not joins(model):
        return predict_all(model, runs)
    robot = model.robot
    effects = wiring_of(robot.effects), view_of(robot.effects)
    finer = runs.finer
    part = finer.cache.known(
        (robot.left_tick, robot.right_tick, robot.track, *effects),
        lambda: predict_all(model, finer),
    )
    begin, end = runs.parts()
    yaw = _sums(part.turn)
    place = _sums(np.exp(1j * yaw[:-1]) * (part.relative[:, 0] + 1j * part.relative[:, 1]))
    moved = np.exp(-1j * yaw[begin]) * (place[end] - place[begin])
    counts = end - begin
    bounds = np.concatenate([[0], np.cumsum(counts)])
    leg = np.repeat(np.arange(runs.count), counts)
    index = np.repeat(begin - bounds[:-1], counts) + np.arange(leg.size)
    lever = np.exp(-1j * yaw[begin[leg]]) * (place[end[leg]] - place[index + 1])
    carry = np.empty((leg.size, 3, 3))
    turn_into(carry, yaw[index] - yaw[begin[leg]])
    carry[:, 0, 2], carry[:, 1, 2] = -lever.imag, lever.real

    def whole(values: Floats) -> Floats:
        sums = _sums(values)
        return np.asarray(sums[bounds[1:]] - sums[bounds[:-1]])

    return Prediction(
        np.stack([moved.real, moved.imag, whole(part.relative[index, 2])], axis=-1),
        whole(carry @ part.per_left[index] @ carry.transpose(0, 2, 1)),
        whole(carry @ part.per_right[index] @ carry.transpose(0, 2, 1)),
        whole(part.length[index]),
        whole(part.along[index]),
        whole(part.turn[index]),
    )


def joins(model: Model) -> bool:
    """Whether legs are sums of their parts: no effect depends on where a leg begins."""
    own = any(name not in NUISANCES for mine in model.own for name in mine)
    view = view_of(model.robot.effects)
    timed = view.heading_delay != 0.0 or view.wander != 0.0
    return not (own or acts(model.robot) or timed or model.drifts.any())


def _sums(values: Floats) -> Floats:
    """Cumulative sum with a leading zero."""
    return np.concatenate([np.zeros_like(values[:1]), np.cumsum(values, axis=0)])
