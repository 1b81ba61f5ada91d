# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A candidate begins where its formula still predicts something."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from test.inference.driven import run_of
from test.model.drives import ROBOT
from werrimbi_odom.files.evaluation import EvaluationOptions
from werrimbi_odom.inference.fitting.candidates import (
    candidates,
    scores,
    started_with,
    with_candidate,
)
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import start_point
from werrimbi_odom.inference.fitting.prediction import predicted_legs, turns_over
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, body_effect
from werrimbi_odom.model.motion import BodyMotion, Number


@body_effect(size=Parameter("", null=0.0, typical=0.01, bounds=(-1.0, 1.0), says="of the trouble"))
def explodes(motion: BodyMotion[Number], drive: Drive[Number], size: float) -> BodyMotion[Number]:
    """A turn that is linear in a small size, and grows without limit in a large one."""
    return motion._replace(turn=motion.turn * (1.0 + size + (4.0 * size) ** 12))


def test_a_score_that_leads_to_nonsense_is_followed_part_of_the_way() -> None:
    runs = concatenated(match_for_fit([run_of(ROBOT, 3, 60)], ROBOT, 1.0))
    point = start_point(runs, ROBOT, EvaluationOptions())
    (score,) = scores(runs, point, (), candidates([explodes], (), (), 1))
    far = replace(score, coefficients=np.array([5e2]))
    before = predicted_legs(point.model, runs)
    assert turns_over(before, predicted_legs(with_candidate(point.model, far), runs))
    start = started_with(runs, point, far)
    assert not turns_over(before, predicted_legs(start.model, runs))
    (effect,) = start.model.robot.effects
    assert 0.0 < effect.values["size"] < 1.0
