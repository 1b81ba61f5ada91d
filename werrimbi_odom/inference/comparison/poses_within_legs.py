# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Whether the poses of a reference within the usual short legs of a fit tell anything more."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.reference_group import ReferenceGroup
from werrimbi_odom.inference.comparison.reference_noise import independent_for
from werrimbi_odom.inference.fitting.quantisation import quantisation_variance
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


def parts_for_fit(
    groups: Sequence[ReferenceGroup], robot: Robot, options: EvaluationOptions
) -> int:
    """How many short legs of a fit there are to a judged one.

    More than usual where drives are short and poses are independent over the way of a usual one: an
    error that lasts longer than a pose would pass there for the model's.
    """
    ways = [group.ways(robot, options.leg) for group in groups]
    legs = sum(float(way[-1]) for own in ways for way in own)
    parts = min(int(rules.LEGS_OF_A_FIT / max(legs, 1.0)), rules.MOST_PARTS_OF_A_LEG)
    if options.reference_kind != "absolute" or parts <= rules.PARTS_OF_A_LEG:
        return rules.PARTS_OF_A_LEG
    independent = (_independent(*each, robot) for each in zip(groups, ways, strict=True))
    return parts if all(independent) else rules.PARTS_OF_A_LEG


def _independent(group: ReferenceGroup, ways: Sequence[Floats], robot: Robot) -> bool:
    """Whether poses err independently over the way of a usual short leg.

    The step of a counter errs alike in all poses until the next one. Stamps that scatter err by
    speed and turn rate, which last.
    """
    noise = group.own.noise
    seen = np.array([noise.sigma_xy, noise.sigma_xy, noise.sigma_yaw]) ** 2
    counted = bool(np.any(quantisation_variance(robot) > rules.COUNTS_UNSEEN * seen))
    steps = np.concatenate([np.diff(way) for way in ways])
    moving = steps[steps > 0.0]
    if group.measure != "pose" or group.every.has_stamp_noise or counted or not moving.size:
        return False
    span = round(1.0 / (rules.PARTS_OF_A_LEG * float(np.median(moving))))
    return span > 1 and independent_for(group.plain, span)
