# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which code runs here, so that a worker with another one is told, not averaged in."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from functools import cache
from importlib.metadata import PackageNotFoundError, entry_points, version

from werrimbi_odom.effects.collection import GROUP
from werrimbi_odom.files.content_hash import code_mark

PACKAGE = "werrimbi_odom"
EFFECTS = "installed effects"
_DECIDES = (PACKAGE, EFFECTS)
"""What must be the same; of the rest the last digits may depend."""


@cache
def code_here() -> Mapping[str, str]:
    """Names and versions: of this package with a digest of its code, of all that it counts with."""
    offered = (
        f"{point.name} ({point.dist.name} {point.dist.version})" if point.dist else point.name
        for point in entry_points(group=GROUP)
    )
    return {
        PACKAGE: f"{_version(PACKAGE)} (code {code_mark()})",
        EFFECTS: ", ".join(sorted(offered)) or "none",
        "Python": platform.python_version(),
        "numpy": _version("numpy"),
        "scipy": _version("scipy"),
    }


def refusal(here: Mapping[str, str], there: Mapping[str, str]) -> str:
    """Why results from there would be other ones; empty if they are not."""
    return "; ".join(
        f"{name} {there.get(name, 'none')}, here {here[name]}"
        for name in _DECIDES
        if there.get(name) != here[name]
    )


def doubts(here: Mapping[str, str], there: Mapping[str, str]) -> str:
    """What last digits may depend on; empty where it is the same."""
    return "; ".join(
        f"{name} {there.get(name, 'none')}, here {value}"
        for name, value in here.items()
        if name not in _DECIDES and there.get(name) != value
    )


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed" if name != PACKAGE else "from a checkout"
