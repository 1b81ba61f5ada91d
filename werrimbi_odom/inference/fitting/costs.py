# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a model costs, as a function of the noise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, laid_out
from werrimbi_odom.inference.fitting.design import Point
from werrimbi_odom.inference.fitting.likelihood import Innovations, Variances, innovations
from werrimbi_odom.inference.fitting.prediction import Prediction, predict_all
from werrimbi_odom.inference.legs.cutting import MatchedRun
from werrimbi_odom.model.pose import Floats


@dataclass(frozen=True, slots=True)
class Costs:
    """Minus two log-likelihood of sets of variances, the model being given."""

    runs: Sequence[MatchedRun] | Concatenated
    point: Point

    def prediction(self) -> Prediction:
        """Of all runs."""
        return predict_all(self.point.model, laid_out(self.runs))

    def innovations(self, sets: Variances, prediction: Prediction) -> Innovations:
        """For each set."""
        model = self.point.model
        return innovations(
            model.robot,
            laid_out(self.runs),
            prediction,
            sets,
            self.point.options.reference_kind,
            excluded=self.point.skip,
            start_yaws=model.start_yaws,
        )

    def __call__(self, sets: Variances, prediction: Prediction | None = None) -> Floats:
        """Cost of each set."""
        found = self.innovations(sets, prediction or self.prediction())
        return found.minus_two_log_likelihood()
