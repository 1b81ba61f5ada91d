# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where a sensor sits, by what was found and the transform that its poses were freed of."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from werrimbi_odom.files.mount import Mount
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.estimated_values import values_of
from werrimbi_odom.model.pose import Floats

PARTS = {
    "reference_lever_arm.x": "x",
    "reference_lever_arm.y": "y",
    "reference_yaw_offset.angle": "yaw",
}
"""Parameters that are a deviation from the transform, and which part of it they are."""
OF_MOUNT = tuple(dict.fromkeys(name.partition(".")[0] for name in PARTS))
"""Their effects."""


class MendedMount(NamedTuple):
    """What a transform says, and what it should say."""

    entered: Mount
    mended: Mount
    std: dict[str, float]
    """Standard deviations by part [m, rad]; NaN where the effect of that part was not found."""
    effects: tuple[str, ...]
    """The effects that need not be added if it is mended."""


def mended_mount(diagnosis: Diagnosis) -> MendedMount | None:
    """The transform that leaves no deviation; None if there is none, or its values are not one.

    The deviation is the pose of what the reference shows on the robot. So the mended transform is
    the composition of both.
    """
    entered, effects = diagnosis.runs.mount, tuple(e for e in OF_MOUNT if e in diagnosis.found)
    told = {
        f"{name}.{parameter}": value
        for name in effects
        for parameter, value in values_of(diagnosis, name).items()
    }
    held = {applied.name for applied in diagnosis.given.effects} & set(OF_MOUNT)
    unclear = any(not value.reported or value.or_else for value in told.values())
    if entered is None or not told or held or unclear or "reference_mirrored" in diagnosis.found:
        return None
    x, y, yaw = (told[name].value if name in told else 0.0 for name in PARTS)
    mended = entered.with_base_at(x, y, yaw)
    swings = np.eye(3)
    swings[:2, 2] = y - mended.y, mended.x - x  # the place goes round the base as it turns
    variances = np.diag(swings @ _covariance(diagnosis) @ swings.T)
    std = {
        part: math.sqrt(variance) if name in told else math.nan
        for (name, part), variance in zip(PARTS.items(), variances.tolist(), strict=True)
    }
    return MendedMount(entered, mended, std, effects)


def _covariance(diagnosis: Diagnosis) -> Floats:
    """That of the deviation, as reported, shape (3, 3); zero where it was not fitted."""
    fit = diagnosis.told
    at = {number.name: row for row, (number, run) in enumerate(fit.design.columns) if run < 0}
    fitted = [(place, at[name]) for place, name in enumerate(PARTS) if name in at]
    places, rows = ([pair[side] for pair in fitted] for side in (0, 1))
    found = np.zeros((3, 3))
    found[np.ix_(places, places)] = fit.covariance[np.ix_(rows, rows)]
    return found
