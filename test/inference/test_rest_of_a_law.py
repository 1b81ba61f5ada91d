# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a held law leaves is no other effect, and no sign that another one is missing."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest

from werrimbi_odom.inference.diagnosis import diagnosis, misfit
from werrimbi_odom.inference.diagnosis.effect_support import Support
from werrimbi_odom.inference.diagnosis.misfit import Misfit, misfit_of_held_law

RUNS: Any = SimpleNamespace(data=2600)
PLAY = SimpleNamespace(name="right_backlash")


def dependence(gain: float, of: str = "direction") -> Any:
    return SimpleNamespace(
        channel="sideways", gain=gain, variable=SimpleNamespace(looks_at=(of,)), degrees=1
    )


def left_beside(monkeypatch: pytest.MonkeyPatch, explained: float, beyond: Any) -> Misfit | None:
    support = Support(frozenset({"right_since_reversal"}), frozenset({"right", "sideways"}))

    def laws(*_: Any) -> Iterator[Any]:
        yield PLAY, support, explained

    monkeypatch.setattr(misfit, "_laws", laws)
    this: Any = SimpleNamespace(before=None, dependences=())
    return misfit_of_held_law(this, None, beyond, RUNS)


def test_what_is_little_of_a_law_and_of_the_errors_is_put_down_to_the_law(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A wheel that coasts through its play: 32 of 2600 beside 1155, and that was *unknown*."""
    little = dependence(32.0)
    rest = left_beside(monkeypatch, 1155.0, little)
    assert rest == Misfit(None, little, 32.0 / 2600.0)
    assert left_beside(monkeypatch, 200.0, little) is None, "it is much of what the law explains"
    assert left_beside(monkeypatch, 9e4, dependence(400.0)) is None, "it is much of the errors"


def test_the_rest_of_a_law_is_no_sign_of_an_effect_that_the_parts_do_not_show(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A delay of a millisecond was named beside slip above a force: the curve of slip lasted."""
    rest = dependence(55.0, "right_since_reversal")
    delay: Any = SimpleNamespace(names=("coulomb_slip", "reference_delay"))
    this: Any = SimpleNamespace(before=None, number=60)
    monkeypatch.setattr(diagnosis, "_significant", lambda *_: delay)
    monkeypatch.setattr(diagnosis, "p_value_by_parts", lambda *_: 2e-3)
    monkeypatch.setattr(diagnosis, "disagreeing", lambda *_: False)
    monkeypatch.setattr(
        diagnosis, "_beyond_the_library", lambda _, best, __: rest if best is None else None
    )
    held = Misfit("coulomb_slip", rest, 0.002)
    monkeypatch.setattr(diagnosis, "misfit_of_held_law", lambda *_: held)
    assert diagnosis._chosen(this, RUNS) == (None, rest)
    monkeypatch.setattr(diagnosis, "misfit_of_held_law", lambda *_: None)
    assert diagnosis._chosen(this, RUNS) == (delay, None)
