# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives recorded with another set-up than the rest: a plug swapped, a clock set, a file edited.

The set-up is estimated from the fitted drives alone. A drive with far larger errors under it is
examined by itself. If its own data show another set-up, it tells nothing about the robot of the
other drives.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.judged_legs import judged_legs
from werrimbi_odom.inference.comparison.prepared_runs import PreparedRuns
from werrimbi_odom.inference.comparison.typical_errors import far_beyond, typical_errors
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
    own, others = (_typical(some, mended) for some in (fitted, held_out))
    found = []
    for prepared, errors in ((fitted, own), (held_out, others)):
        for index in far_beyond(errors, own):
            run = prepared.runs[index]
            findings = _differing(run, mended, options)
            if findings:
                found.append(RecordedOtherwise(run.name, run.path, prepared is held_out, findings))
    return tuple(found)


def _typical(prepared: PreparedRuns, robot: Robot) -> Sequence[float]:
    model = Model(robot, tuple({} for _ in prepared.runs))
    return typical_errors(judged_legs(prepared, model, prepared.options.leg), len(prepared.runs))


def _differing(run: Run, mended: Robot, options: EvaluationOptions) -> tuple[SetUpFinding, ...]:
    try:
        findings = look_for_mistakes([run], mended, options).findings
    except InputError:
        return ()
    clear = max((finding.gain for finding in findings), default=0.0)
    return findings if clear > rules.OWN_GAIN else ()
