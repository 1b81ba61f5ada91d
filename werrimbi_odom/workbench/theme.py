# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Light and dark: figures in the page's colours, told apart by the colour-blind in both."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any

from werrimbi_odom.report.style import IN_THE_DARK, KEPT_HERE

if TYPE_CHECKING:
    import plotly.graph_objects as go

_COLOURS = re.compile("|".join(IN_THE_DARK), re.IGNORECASE)

BUTTONS = ["select2d", "lasso2d", "autoScale2d", "toImage"]
"""Of plotly's tool bar, that nobody needs here."""


def shown(figure: go.Figure | str, dark: bool) -> dict[str, Any]:
    """A figure (or its JSON) as the page draws it; in the dark every colour has its twin."""
    words = figure if isinstance(figure, str) else str(figure.to_json())
    if dark:
        words = _COLOURS.sub(lambda found: IN_THE_DARK[found.group().upper()], words)
    drawn: dict[str, Any] = json.loads(words)
    if dark:
        for name, axis in drawn["layout"].items():
            if name.startswith("coloraxis") and not axis.get("meta"):
                axis["reversescale"] = True  # much stands out from the page
    drawn["config"] = {
        "displaylogo": False,
        **KEPT_HERE,
        "responsive": True,
        "modeBarButtonsToRemove": BUTTONS,
        "scrollZoom": True,
    }
    return drawn
