# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The best that can be had: the model with what truly was hidden, fitted, judged on held-out runs.

What is known here and nowhere else is which effect it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from test.hidden.right_laws import RIGHT_LAWS
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import ReferenceKind, Run
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration
from werrimbi_odom.inference.diagnosis.holdout import Judge, judge_of
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted, fitted, refined
from werrimbi_odom.inference.fitting.candidate_starts import with_candidate
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION, Model
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.fitting.score_tests import candidates, parameters_with, scores
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.encoder_online import EncoderLimits
from werrimbi_odom.model.robot import Robot

LEG = 1.0
"""Of the legs that are judged [m]."""

SHAPES = 3
"""Shapes of one effect (thresholds, phases of each run or of all) that are fitted in full."""


class Floor:
    """Fits true models to the runs of a set, and judges them.

    Parameters
    ----------
    runs, holdout
        Read with the robot file.
    robot : Robot
        As the robot file has it.
    kind : "absolute" or "incremental"
    """

    def __init__(
        self,
        runs: Sequence[Run],
        holdout: Sequence[Run],
        robot: Robot,
        kind: ReferenceKind = "absolute",
        limits: EncoderLimits | None = None,
    ) -> None:
        self.given = robot
        self.options = EvaluationOptions(reference_kind=kind, leg=LEG, limits=limits)
        self.judge: Judge = judge_of(runs, holdout, robot, self.options)
        self.laid: Concatenated = concatenated(match_for_fit(runs, robot, LEG, limits))

    def as_given(self) -> float:
        """Held-out error of the robot file [m]."""
        nothing = self.judge.nothing_of_own
        return self.judge.of(Model(self.given, nothing)).holdout

    def of(self, names: Sequence[str]) -> float:
        """Held-out error of the model with these effects, calibration and all fitted [m]."""
        mistakes = tuple(find(name).using() for name in names if _is_mistake(name))
        robot = replace(self.given, effects=(*self.given.effects, *mistakes))
        if len(mistakes) == len(names):
            return self.judge.of(Model(robot, self.judge.nothing_of_own)).holdout
        fit = fit_calibration(self.laid, robot, self.options)
        for name in names:
            if name not in CALIBRATED and not _is_mistake(name):
                laws = RIGHT_LAWS.get(name) or (find(name),)
                fit = min((self._with(fit, law, robot) for law in laws), key=lambda one: one.cost)
        return self.judge.of(fit.point.model).holdout

    def of_law(self, law: Effect) -> float:
        """Held-out error of the model with one more law, calibration and all fitted [m]."""
        fit = fit_calibration(self.laid, self.given, self.options)
        return self.judge.of(self._with(fit, law, self.given).point.model).holdout

    def _with(self, fit: Fitted, effect: Effect, robot: Robot) -> Fitted:
        """One effect more, whatever it is worth."""
        held = {applied.name for applied in fit.point.model.robot.effects}
        channels = set.intersection(*(set(run.counters.channels) for run in self.laid.runs))
        shapes = candidates([effect], held, channels, len(self.laid.runs))
        numbers = (*CALIBRATION, *fit.numbers)
        found = scores(self.laid, fit.point, numbers, shapes)
        best = sorted(found, key=lambda score: -score.gain)[:SHAPES]
        fits = []
        for score in best:
            start = replace(fit.point, model=with_candidate(fit.point.model, score))
            own = parameters_with(fit.numbers, score.candidate)
            names = (*fit.names, effect.name)
            fit_of_it = fitted(self.laid, start, names, own, robot, rounds=3)
            fits.append(refined(self.laid, fit_of_it, robot))
        # A weak phase may differ from run to run or be one for all: the price tells.
        return min(fits, key=lambda one: one.total) if fits else fit


def _is_mistake(name: str) -> bool:
    return name not in RIGHT_LAWS and find(name).is_mistake
