# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference with positions in some rows and headings in others: poses, or headings alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import Reference
from werrimbi_odom.model.pose import Floats, wrap_all

FEW = 10
"""Up to so many positions beside more headings, those are judged alone: by tape at the ends of a
drive, legs between them would leave nothing of the headings."""
NEAR = 3.0
"""Median intervals of the headings that may lie between those on both sides of a position: none, or
one that was lost."""


def one_kind_of_row(reference: Reference) -> tuple[Reference, str]:
    """Rows that all measure alike, where most headings have rows of their own; and what was done.

    Each position gets the heading of its instant: its own, or that between its neighbours. Headings
    without a position are left out then. Unchanged, without words, if half of the rows are poses,
    or positions come more than twice as often as headings.
    """
    place, yaw = reference.has_position, reference.has_yaw
    positions, headings = int(place.sum()), int(yaw.sum())
    poses = int((place & yaw).sum())
    if (
        not 0 < positions <= 2 * headings
        or headings <= FEW
        or 2 * poses >= max(positions, headings)
    ):
        return reference, ""
    told = f"positions stand in {positions} of its {reference.time.size} rows, headings in "
    if positions <= FEW:
        nothing = np.full(headings, np.nan)
        alone = replace(reference.chosen(yaw), x=nothing, y=nothing, sigma_xy=None)
        return alone, (
            f"{told}{headings}: the headings alone are judged. To judge by the positions, make a "
            "copy of the folder with their rows alone in reference.csv"
        )
    filled = _filled(reference, place, yaw)
    without = positions - int(filled.has_yaw.sum())
    but = f" (but {without}, where none is near)" if without else ""
    return filled, (
        f"{told}{headings}: the positions are judged, each with the heading of its instant{but}; "
        "headings between them are left out"
    )


def _filled(reference: Reference, place: NDArray[np.bool_], yaw: NDArray[np.bool_]) -> Reference:
    """Rows with positions; headings that they lack are those between the nearest two."""
    seen = np.flatnonzero(yaw)
    seen = seen[np.argsort(reference.time[seen], kind="stable")]
    time, heading = reference.time[seen], np.unwrap(reference.yaw[seen])
    kept = reference.chosen(place)
    after = np.clip(np.searchsorted(time, kept.time), 1, time.size - 1)
    apart = time[after] - time[after - 1]
    near = (kept.time >= time[after - 1]) & (kept.time <= time[after])
    near &= apart <= NEAR * float(np.median(np.diff(time)))
    lacking = ~kept.has_yaw & near
    between: Floats = wrap_all(np.interp(kept.time, time, heading))
    same = kept.time == time[after]
    between[same] = reference.yaw[seen][after][same]
    sigma = kept.sigma_yaw
    if reference.sigma_yaw is not None and sigma is not None:
        sigma = np.where(lacking, reference.sigma_yaw[seen][after], sigma)
    return replace(kept, yaw=np.where(lacking, between, kept.yaw), sigma_yaw=sigma)
