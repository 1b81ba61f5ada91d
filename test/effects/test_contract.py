# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Every effect of the library keeps the laws; whoever breaks one is told which."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from werrimbi_odom.effects import LIBRARY, find
from werrimbi_odom.effects.contract import check_effect
from werrimbi_odom.effects.functions import exp
from werrimbi_odom.effects.shapes import mean_sin
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import (
    Effect,
    Parameter,
    Twin,
    View,
    body_effect,
    reference_effect,
    wheel_effect,
    wiring_mistake,
)

AMOUNT = Parameter("1", 0.0, 0.01, (-0.1, 0.1), "how much")
PAGE = """Something happens.

Formula    left += something
Signature  something is seen
Ruler      measure something
"""


@pytest.mark.parametrize("effect", LIBRARY, ids=lambda effect: effect.name)
def test_the_library_keeps_the_laws(effect: Effect) -> None:
    check_effect(effect)


def law(change: Callable[[Any, Any, float], Any], **declared: Any) -> Effect:
    """An effect on the left wheel."""

    def some_law(travel: Any, drive: Any, amount: float) -> Any:
        return travel._replace(left=change(travel, drive, amount))

    some_law.__doc__ = PAGE
    return wheel_effect(amount=AMOUNT, **declared)(some_law)


@pytest.mark.parametrize("name", ["longitudinal_slip", "coulomb_slip"])
def test_a_law_keeps_them_where_it_is_refined(name: str) -> None:
    slip = find(name)
    lighter = replace(slip.parameters["turning"], typical=0.4)
    check_effect(replace(slip, parameters={**slip.parameters, "turning": lighter}))


def test_a_plain_law_of_ones_own_keeps_them() -> None:
    check_effect(law(lambda travel, drive, amount: travel.left * (1.0 + amount)))


def test_an_effect_may_look_at_a_measured_channel() -> None:
    def follows(travel: Any, drive: Any, amount: float) -> Any:
        return travel.left * (1.0 + amount * drive.channels["payload_kg"].mean)

    check_effect(law(follows, channels=("payload_kg",)))


def rewrites(travel: Any, drive: Any, amount: float) -> Any:
    return (travel.left + travel.right) * (1.0 + amount) - travel.right


def writes(travel: Any, drive: Any, amount: float) -> Any:
    travel.left[...] *= 1.0 + amount
    return travel.left


def sums_up(travel: Any, drive: Any, amount: float) -> Any:
    return travel.left + amount * 0.01 * np.cumsum(travel.left)


def divides(travel: Any, drive: Any, amount: float) -> Any:
    with np.errstate(all="ignore"):
        return travel.left + (amount * travel.left**2 / travel.left if amount else 0.0)


def has_no_root_alone(travel: Any, drive: Any, amount: float) -> Any:
    whole = isinstance(travel.left, np.ndarray)
    root = np.sqrt(np.abs(drive.speed.end)) if whole else math.sqrt(drive.speed.end)
    return travel.left * (1.0 + amount * root)


def takes_the_end(travel: Any, drive: Any, amount: float) -> Any:
    return travel.left + amount * 1e-3 * exp(-drive.since_reversal.end)


def lags(travel: Any, drive: Any, amount: float) -> Any:
    return travel.left * (1.0 + amount * drive.speed.mean)


def stays_an_array(travel: Any, drive: Any, amount: float) -> Any:
    return travel.left * (1.0 + amount * np.cos(0.0))


def differs_live(travel: Any, drive: Any, amount: float) -> Any:
    return travel.left * (1.0 + amount * (1.0 if isinstance(travel.left, float) else 2.0))


def peeps(travel: Any, drive: Any, amount: float) -> Any:
    heading = Drive.heading.__get__(drive)  # type: ignore[attr-defined]
    return travel.left * (1.0 + amount * mean_sin(heading))


def knows_its_kind(travel: Any, drive: Any, amount: float) -> Any:
    return travel.left * (1.0 + (amount if type(drive) is Drive else 0.0))


def does_nothing(travel: Any, drive: Any, amount: float) -> Any:
    return travel.left + 0.0 * amount


def jumps(travel: Any, drive: Any, amount: float) -> Any:
    return travel.left * (1.01 if amount > 0.0 else 1.0)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (rewrites, "exact identity"),
        (writes, "writes into an array"),
        (sums_up, "that step's row alone"),
        (divides, "finite"),
        (has_no_root_alone, "a single step fails"),
        (takes_the_end, "splitting a step"),
        (lags, "speed.end"),
        (stays_an_array, "floats must stay floats"),
        (differs_live, "step by step"),
        (knows_its_kind, "step by step|recorded and predicted are the same"),
        (does_nothing, "does nothing"),
        (jumps, "slope in amount"),
    ],
)
def test_who_breaks_a_law_is_told_which(
    change: Callable[[Any, Any, float], Any], told: str
) -> None:
    with pytest.raises(AssertionError, match=f"(?s)some_law breaks a law.*({told})"):
        check_effect(law(change))


def test_who_peeps_past_the_names_finds_nothing() -> None:
    with pytest.raises(AttributeError, match="heading"):
        check_effect(law(peeps))


def test_turning_must_not_look_at_the_heading() -> None:
    @body_effect(amount=AMOUNT)
    def compass(motion: Any, drive: Any, amount: float) -> Any:
        """Turn towards the north.

        Formula    turn += amount * path * heading
        Signature  it turns
        Ruler      look
        """
        pull = amount * 0.01 * drive.distance.change * drive.heading.start
        return motion._replace(turn=motion.turn + pull)

    with pytest.raises(AssertionError, match=r"splitting|heading"):
        check_effect(compass)


def test_a_view_keeps_what_it_was_given() -> None:
    @reference_effect(amount=AMOUNT)
    def forgetful(view: View, amount: float) -> View:
        """Forget the rest.

        Formula    ahead = amount
        Signature  seen
        Ruler      look
        """
        return View(ahead=amount)

    with pytest.raises(AssertionError, match="exact identity"):
        check_effect(forgetful)


def test_a_mistake_made_twice_is_none() -> None:
    @wiring_mistake()
    def stuck(wiring: Any) -> Any:
        """Cannot be mended.

        Formula    left = -|left|
        Signature  seen
        Ruler      look
        """
        return wiring._replace(left_sign=-1.0)

    with pytest.raises(AssertionError, match="twice"):
        check_effect(stuck)


GOOD = find("lateral_slip")


@pytest.mark.parametrize(
    ("bad", "told"),
    [
        (replace(GOOD, name="Lateral-Slip"), "small letters"),
        (replace(GOOD, doc="Formula    x"), "must begin with a sentence"),
        (replace(GOOD, doc=GOOD.doc.replace("Ruler", "Rule")), "Ruler"),
        (replace(GOOD, indistinguishable_from=(Twin("other"),)), "say what separates"),
        (
            replace(GOOD, parameters={"creep": replace(GOOD.parameters["creep"], unit="m s")}),
            "unit",
        ),
        (replace(GOOD, parameters={"creep": replace(GOOD.parameters["creep"], says=" ")}), "say"),
        (
            replace(GOOD, parameters={"creep": replace(GOOD.parameters["creep"], typical=5.0)}),
            "bounds",
        ),
        (
            replace(GOOD, parameters={"creep": replace(GOOD.parameters["creep"], typical=0.0)}),
            "differ from null",
        ),
    ],
)
def test_words_and_units_must_be_there(bad: Effect, told: str) -> None:
    with pytest.raises(AssertionError, match=told):
        check_effect(bad)


@pytest.mark.parametrize("name", ["m", "1/s", "s^2/m", "rad", "m^0.5", "", "kg*m^2/s^2"])
def test_units_are_written_as_usual(name: str) -> None:
    creep = replace(GOOD.parameters["creep"], unit=name)
    check_effect(replace(GOOD, parameters={"creep": creep}))


def test_a_place_that_each_drive_has_anew_goes_with_one_size() -> None:
    """Its score is of one size; with another one beside it nobody would look for the place."""
    place = replace(find("left_tread_bump").parameters["place"])

    def two_sizes(travel: Any, drive: Any, one: float, other: float, place: float) -> Any:
        return travel

    two_sizes.__doc__ = PAGE
    effect = wheel_effect(one=AMOUNT, other=AMOUNT, place=place)(two_sizes)
    with pytest.raises(AssertionError, match=r"parameter place: .*one size, and there are 2"):
        check_effect(effect)
