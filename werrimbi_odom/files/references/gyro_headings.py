# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Headings alone in columns: a gyro's, whose errors add up, if nothing says otherwise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from werrimbi_odom.files.run import Reference, Run

FEWEST = 20
"""Least number of headings of a drive for a gyro's. Whoever measures by hand reads fewer, and errs
anew in each."""
WORDS = (
    "headings alone are taken as a gyro's, whose errors add up (--reference-kind incremental); "
    "give --reference-kind absolute where each errs by itself, as a compass's"
)


def as_of_a_gyro(runs: Sequence[Run], *, noise_known: bool = False) -> list[Run]:
    """Say of headings alone that their errors add up, where no reader knows what they are of.

    Taken as independent, the walk of a gyro has nowhere to go while the wheels stand, and looks
    like a robot that is turned there. Independent headings that are taken as adding up weigh less
    than they might, and do no harm. So they are a gyro's, unless they are few, as those of a tape,
    or the noise of each is stated, in a column or by the user (`noise_known`). All drives have one
    kind of reference, so one of another kind leaves all as they are.
    """
    references = [run.reference for run in runs]
    if noise_known or not all(reference and _of_a_gyro(reference) for reference in references):
        return list(runs)
    return [
        run
        if run.reference is None or run.reference.kind
        else replace(run, reference=replace(run.reference, kind="incremental"))
        for run in runs
    ]


def _of_a_gyro(reference: Reference) -> bool:
    if reference.kind is not None:
        return reference.kind == "incremental"
    unstated = reference.sigma_yaw is None and reference.covariance is None
    often = int(reference.has_yaw.sum()) >= FEWEST
    return unstated and often and not reference.has_position.any()
