# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives that were measured at a few places, as by tape at both ends: what they tell together."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence

from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.splitting import held_of_few, poses_of
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS


def numbers_of(reference: Reference) -> int:
    """Measured numbers of the motion between the poses: three for each, with its heading.

    Without headings the one at the start is unknown.
    """
    places, headings = int(reference.has_position.sum()), int(reference.has_yaw.sum())
    steps = 2 * max(places - 1, 0) + max(headings - 1, 0)
    return max(steps - (1 if places > 1 and headings == 0 else 0), 0)


def tell_sizes(runs: Iterable[Run]) -> bool:
    """Whether drives tell base and radii, and whether these explain them: by more numbers."""
    references = [run.reference for run in runs if run.reference is not None]
    return sum(map(numbers_of, references)) > len(MULTIPLIERS)


def more_to_judge(runs: Iterable[Run]) -> int:
    """How many more drives like these have the legs that a comparison needs."""
    legs = [poses_of(run) - 1 for run in runs if poses_of(run) > 1]
    lacking = rules.FEWEST_LEGS - sum(legs)
    return max(math.ceil(lacking * len(legs) / sum(legs)), 0) if legs else 0


def more_to_diagnose(runs: Sequence[Run], *, all_fitted: bool) -> int:
    """How many more drives like these leave a diagnosis the legs to fit that it needs.

    0 where drives were measured often: these are parted, or too short. `all_fitted`: whether other
    drives are held out.
    """
    poses = [poses_of(run) for run in runs]
    if not all(1 < count < rules.FEWEST_LEGS for count in poses):
        return 0
    each = sum(poses) / len(poses) - 1.0

    def fitted(drives: int) -> int:
        return drives if all_fitted else drives - held_of_few(drives)

    enough = (
        more
        for more in itertools.count(1)
        if fitted(len(poses) + more) * each >= rules.LEGS_OF_A_PART
    )
    return next(enough)
