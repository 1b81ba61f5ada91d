# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is suspect about a reference, in words and as JSON: told alike by compare and diagnose."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from werrimbi_odom.inference.comparison.suspect import ReferenceRemark
from werrimbi_odom.report.phrases import told_from_start

_MOST = 3  # stretches that are told one by one


def remark_words(remark: ReferenceRemark) -> str:
    """A sentence or two: what is odd, where, and what it may be."""
    if remark.what == "short":
        elsewhere = ""
        if abs(remark.usual) > 0.05:
            elsewhere = f" Elsewhere it is {_share(remark.usual)} than the wheels' way."
        return (
            f"The reference's path is {_share(remark.size)} than elsewhere, against the wheels, in "
            f"{_places(remark)}: it is wrong there (a scan matcher in a corridor), or the wheels "
            f"slipped there.{elsewhere}"
        )
    if remark.what == "another_drive":
        return (
            "Wheels and reference have nothing in common: whatever is put right, the errors are as "
            "large as the way itself. It is the reference of another robot or another drive, its "
            "clock is far off, or its topic is not where the robot is."
        )
    if remark.what == "metre":
        return (
            f"The reference's path is {_share(remark.size)} than the wheels' way, and its turns "
            "are right: its metre is none, or radius and base were both entered wrongly by that. "
            "Lay a tape beside it."
        )
    angle = f"{math.degrees(abs(remark.size)):.1f}°"
    if remark.what == "sideways":
        return (
            f"The reference goes sideways to its own heading by {angle}, all along: its sensor is "
            "mounted askew, the robot crabs, or heading and path are of two sources."
        )
    if remark.what == "apart":
        return (
            f"The reference's heading and its path drift apart, by {angle} in one drive: they do "
            "not belong together. Leave the one out that you trust less (an empty column)."
        )
    return (
        f"The reference goes sideways to its own heading by {angle} in {_places(remark)}: nothing "
        "that rolls does so; its heading or its path is wrong there."
    )


def remarks_json(remarks: Sequence[ReferenceRemark]) -> list[dict[str, Any]]:
    """Field for field; sizes are shares of the path, or angles [rad]."""
    return [
        {
            "what": remark.what,
            "size": remark.size,
            "unit": "" if remark.what in ("short", "metre") else "rad",
            "usual": remark.usual,
            "stretches": [
                {"run": str(part.run), "from_s": part.begin, "to_s": part.end, "size": part.size}
                for part in remark.stretches
            ],
            "words": remark_words(remark),
        }
        for remark in remarks
    ]


def _share(size: float) -> str:
    return f"{100.0 * abs(size):.0f} % {'shorter' if size < 0.0 else 'longer'}"


def _places(remark: ReferenceRemark) -> str:
    told = [
        f"{part.run.name} from {begin:.0f} s to {end:.0f} s"
        for part in remark.stretches[:_MOST]
        for begin, end in [told_from_start(part)]
    ]
    more = ", ..." if len(remark.stretches) > _MOST else ""
    return f"{len(remark.stretches)} stretches ({', '.join(told)}{more})"
