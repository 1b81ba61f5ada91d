# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives recorded with another set-up than the rest: a plug swapped, a clock set, a file edited.

The set-up is estimated from the fitted drives alone. A drive with far larger errors under it is
examined by itself. If its own data show another set-up, it tells nothing about the robot of the
other drives.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.judged_legs import judged_legs
from werrimbi_odom.inference.comparison.prepared_runs import PreparedRuns
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.set_up.findings import SetUpFinding
from werrimbi_odom.inference.set_up.search import look_for_mistakes
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True)
class RecordedOtherwise:
    """A drive whose set-up differs from that of the fitted drives."""

    run: str
    path: Path
    held_out: bool
    findings: tuple[SetUpFinding, ...]
    """Differences from the set-up of the fitted drives."""

    @property
    def effects(self) -> tuple[str, ...]:
        """Names of the differences."""
        return tuple(finding.effect for finding in self.findings)


def recorded_otherwise(
    fitted: PreparedRuns, held_out: PreparedRuns, mended: Robot, options: EvaluationOptions
) -> tuple[RecordedOtherwise, ...]:
    """Fitted and held-out drives that were recorded with another set-up than most fitted ones.

    `mended`: Robot with the set-up mistakes common to the fitted drives corrected.
    """
    own = typical_errors(fitted, mended)
    known = [error for error in own if math.isfinite(error)]  # headings alone have none of position
    usual = float(np.median(known)) if known else math.inf
    found = []
    for prepared, errors in ((fitted, own), (held_out, typical_errors(held_out, mended))):
        for run, error in zip(prepared.runs, errors, strict=True):
            if not error > rules.GROSS * usual:
                continue
            findings = _differing(run, mended, options)
            if findings:
                found.append(RecordedOtherwise(run.name, run.path, prepared is held_out, findings))
    return tuple(found)


def _differing(run: Run, mended: Robot, options: EvaluationOptions) -> tuple[SetUpFinding, ...]:
    try:
        findings = look_for_mistakes([run], mended, options).findings
    except InputError:
        return ()
    clear = max((finding.gain for finding in findings), default=0.0)
    return findings if clear > rules.OWN_GAIN else ()


def typical_errors(prepared: PreparedRuns, robot: Robot) -> Sequence[float]:
    """Median error of each drive's legs, of position [m], or of heading [rad] where that is all."""
    model = Model(robot, tuple({} for _ in prepared.runs))
    legs = judged_legs(prepared, model, prepared.options.leg)
    by_position = np.isfinite(legs.errors.distance).any()
    size = legs.errors.distance if by_position else np.abs(legs.errors.error[:, 2])
    medians = []
    for index in range(len(prepared.runs)):
        own = size[(legs.run == index) & np.isfinite(size)]
        medians.append(float(np.median(own)) if own.size else float("nan"))
    return medians
