# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Every report by axe-core's rules, in light and dark, on a wide screen and on a telephone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
from browser import Visit

from test.axe import COUNT, RUN, axe_script

TOO_WIDE = "Math.max(0, document.documentElement.scrollWidth - window.innerWidth)"
ALL_OPEN = "document.querySelectorAll('details').forEach(item => { item.open = true; })"


def rules() -> list[str]:
    """Scripts that ask for them, with all of a page open; their answers are for `assert_obeyed`."""
    return [ALL_OPEN, axe_script(), COUNT, RUN, TOO_WIDE]


def assert_obeyed(answers: Sequence[Any]) -> None:
    _, _, passed, broken, too_wide = answers
    assert passed > 10
    assert broken == []
    assert too_wide == 0


@pytest.mark.evidence
@pytest.mark.parametrize(("dark", "width"), [(False, 1280), (True, 390)])
@pytest.mark.parametrize("name", ["compare", "diagnose", "add", "fit"])
def test_no_rule_is_broken_and_nothing_is_too_wide(
    page: Callable[[str], Path], look: Callable[..., Visit], name: str, dark: bool, width: int
) -> None:
    """A comparison in the light and a diagnosis in the dark are asked in `test_pages` too."""
    visit = look(page(name), *rules(), dark=dark, width=width)
    assert_obeyed(visit.answers)
    assert visit.complaints == []
