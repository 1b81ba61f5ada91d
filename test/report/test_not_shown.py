# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What drives cannot show is not what they were just said to show."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from werrimbi_odom.report.diagnosis.remarks import not_shown


def test_what_was_named_is_not_among_what_the_drives_cannot_show() -> None:
    """A base that is 9 % off is seen where one of the usual 2 % would not be."""
    sights = tuple(
        SimpleNamespace(effect=name, hidden=True, shown_by="arcs", needs_more=False)
        for name in ("track_width", "tyre_squash")
    )
    told: Any = SimpleNamespace(diagnosis=SimpleNamespace(found=("track_width",)), sights=sights)
    (said,) = not_shown(told)
    assert "tyre_squash (arcs would show it)" in said
    assert "track_width" not in said
