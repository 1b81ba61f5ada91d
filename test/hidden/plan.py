# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which sets the proof needs: of all kinds, from seeds that begin where the code's mark says.

Seeds are drawn from a hash of the code that is judged. So whoever changes that code cannot have
looked at the sets that judge it, and no set is judged by code that was written after it was seen.
Seeds of different effects differ, so that their chances do.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations, count
from typing import TypeVar

from test.hidden.poorer import POORER
from test.hidden.sets import HiddenSet, drawn
from werrimbi_odom.simulation import CATALOGUE, hide
from werrimbi_odom.simulation.hidden.axle_and_reference import ReferenceMount

Thing = TypeVar("Thing")

APART = 10_000
"""Seeds that one plan may use, from its start on."""

OLD = 0
"""Start of the seeds that were judged many times while the diagnosis was written."""

CALIBRATION = ("track_width", "unequal_wheel_radii", "wheel_radius_scale")
EFFECTS = tuple(entry.name for entry in CATALOGUE if entry.kind == "effect")
OUTSIDERS = tuple(entry.name for entry in CATALOGUE if entry.kind == "outside")
MISTAKES = tuple(entry.name for entry in CATALOGUE if entry.kind == "mistake")
FACTORS = {"2": 2.0, "4": 4.0, "pi": math.pi, "180/pi": 180.0 / math.pi, "1000": 1000.0}

FAMILIES = (
    ("track_width", "turn_dependent_track"),
    (
        "unequal_wheel_radii",
        "wheel_radius_scale",
        "radius_drift",
        "radius_by_channel",
        "tyre_squash",
    ),
    (
        "eccentric_left_wheel",
        "eccentric_right_wheel",
        "oval_left_wheel",
        "oval_right_wheel",
        "left_tread_bump",
        "right_tread_bump",
    ),
    ("longitudinal_slip", "coulomb_slip", "load_transfer"),
    ("lateral_slip",),
    ("sideways_drift", "reference_yaw_offset"),
    ("floor_slope", "anisotropic_floor"),
    ("castor_kick", "castor_swing", "left_backlash", "right_backlash"),
    ("left_missed_ticks", "right_missed_ticks"),
    ("reference_lever_arm",),
    ("reference_delay", "reference_heading_delay", "reference_clock_drift", "reference_gyro_drift"),
    ("encoder_skew",),
)
"""Effects of one family are not hidden together: they have much of their signature in common."""

ALONE = tuple((name,) for name in EFFECTS if not any(name in family for family in FAMILIES))
"""Effects that are like no other."""


@dataclass(frozen=True, kw_only=True)
class Sizes:
    """How many sets of each kind; as they stand here, all of it."""

    effects: int = 10
    """Of each effect."""
    clean: int = 50
    outsiders: int = 4
    """Of each."""
    calibration: int = 3
    """Of each combination."""
    mistakes: int = 2
    """Of each."""
    factors: int = 20
    pairs: int = 20
    pairs_with_calibration: int = 6
    poorer: int = 2
    """Of each effect, by each poorer reference."""
    poorer_effects: int = len(EFFECTS)
    """Effects that are seen by a poorer reference."""
    poorer_clean: int = 4
    other: int = 2
    """Of each effect."""
    other_effects: int = len(EFFECTS)
    other_clean: int = 10
    other_outsiders: int = len(OUTSIDERS)
    rivals: int = 5


ALL = Sizes()

SAMPLE = Sizes(
    effects=1,
    clean=8,
    outsiders=1,
    calibration=1,
    mistakes=1,
    factors=2,
    pairs=4,
    pairs_with_calibration=1,
    poorer=1,
    poorer_effects=2,
    poorer_clean=1,
    other=1,
    other_effects=3,
    other_clean=1,
    other_outsiders=1,
    rivals=2,
)
"""What two cores judge in less than an hour, with all that `python -m test.hidden` does beside."""


def start_of(mark: str) -> int:
    """Where the seeds of the code with this mark begin; never where the old ones do."""
    return APART * (1 + int(mark[:8], 16) % 90_000)


def plan(start: int, sizes: Sizes) -> list[HiddenSet]:
    """All sets; kinds take turns in none, so that a run that is stopped has whole groups."""
    return [
        *effects(start, sizes),
        *clean(start, sizes),
        *outsiders(start, sizes),
        *calibration(start, sizes),
        *mistakes(start, sizes),
        *factors(start, sizes),
        *rivals(start, sizes),
        *pairs(start, sizes),
        *other(start, sizes),
        *poorer(start, sizes),
    ]


def _of_each(
    group: str, hidden: Iterable[tuple[str, ...]], first: int, apart: int, sets: int
) -> list[HiddenSet]:
    """So many sets of each; the seeds of one begin so far from those of the next."""
    return [
        HiddenSet(group, names, first + apart * number + seed)
        for number, names in enumerate(hidden)
        for seed in range(sets)
    ]


def effects(start: int, sizes: Sizes) -> list[HiddenSet]:
    """Each effect of the vocabulary, weak and strong."""
    return _of_each("effect", [(name,) for name in EFFECTS], start + 1000, 20, sizes.effects)


def clean(start: int, sizes: Sizes) -> list[HiddenSet]:
    """Nothing hidden."""
    return [HiddenSet("clean", (), start + 2001 + number) for number in range(sizes.clean)]


def calibration(start: int, sizes: Sizes) -> list[HiddenSet]:
    """Only calibration wrong, in several numbers at once."""
    together = [*combinations(CALIBRATION, 2), CALIBRATION]
    return _of_each("calibration", together, start + 3000, 10, sizes.calibration)


def pairs(start: int, sizes: Sizes) -> list[HiddenSet]:
    """Two effects of distinct families; a few with calibration. Of fewer, the first."""
    chance = drawn(start + 4000, "pairs")
    families = (*FAMILIES, *ALONE)
    exotic = [
        family
        for family in (tuple(n for n in names if n not in CALIBRATION) for names in families)
        if family
    ]
    found = []
    for seed in range(start + 4000, start + 4000 + ALL.pairs):
        first, second = chance.choice(len(exotic), 2, replace=False)
        names = [str(chance.choice(exotic[index])) for index in (first, second)]
        found.append(HiddenSet("pair", tuple(names), seed))
    beside = []
    for seed in range(start + 4020, start + 4020 + ALL.pairs_with_calibration):
        size = str(chance.choice(CALIBRATION))
        others = [family for family in families if size not in family and family[0] != size]
        other = others[int(chance.integers(len(others)))]
        name = str(chance.choice([name for name in other if name not in CALIBRATION] or other))
        beside.append(HiddenSet("pair", (size, name), seed))
    return [*found[: sizes.pairs], *beside[: sizes.pairs_with_calibration]]


def outsiders(start: int, sizes: Sizes) -> list[HiddenSet]:
    """What the library does not hold; seeds are those of clean sets, which are their floor."""
    return _of_each("outsider", [(name,) for name in OUTSIDERS], start + 2001, 4, sizes.outsiders)


def mistakes(start: int, sizes: Sizes) -> list[HiddenSet]:
    """Wiring and frames."""
    return _of_each("mistake", [(name,) for name in MISTAKES], start + 5000, 10, sizes.mistakes)


def factors(start: int, sizes: Sizes) -> list[HiddenSet]:
    """Simple factors in the robot file, both ways."""
    found = [
        HiddenSet("factor", (), start + 2001 + number, entered=((key, way),))
        for number, factor in enumerate(FACTORS.values())
        for key in ("wheel_radius", "wheel_separation")
        for way in (factor, 1.0 / factor)
    ]
    return evenly(found, sizes.factors, start)


def poorer(start: int, sizes: Sizes) -> list[HiddenSet]:
    """The same drives by the same effects, measured worse."""
    found = []
    for number, seen in enumerate(POORER):
        for name in evenly(EFFECTS, sizes.poorer_effects, start + APART * number):
            first = start + 1000 + 20 * EFFECTS.index(name)
            found += [
                HiddenSet("poorer", (name,), first + seed, seen=seen)
                for seed in range(sizes.poorer)
            ]
    return found + [
        HiddenSet("poorer", (), start + 2001 + number, seen=seen)
        for seen in POORER
        for number in range(sizes.poorer_clean)
    ]


def rivals(start: int, sizes: Sizes) -> list[HiddenSet]:
    """What the drives cannot tell apart, by construction."""
    lines, curves, first = "one_speed_line", "one_speed_curves", start + 6000
    arm = _arm_along_x(first + 16)
    found = [
        # A reference that is late by d is behind by v d; so is a robot that slips by v^2 / 2 at a
        # start. At one speed, and not by much, nobody knows which: poses within the starts tell v
        # from v^2, by a cost that grows with the square of the size (21 at 10 ms, 3 at 4 ms).
        HiddenSet("rivals", ("reference_delay=0.004",), first + 8, lines),
        HiddenSet("rivals", ("longitudinal_slip=0.03",), first + 7, lines),
        # A point at x is at x ahead, one that is late by d at v d behind, where only positions are
        # measured; a late one is also aside, by half the curvature times (v d)^2, so d is small.
        HiddenSet("rivals", ("reference_lever_arm=0.003",), arm, curves, "positions_alone"),
        HiddenSet("rivals", ("reference_delay=0.015",), first + 6, curves, "positions_alone"),
        # A point at x moves sideways by x times the turn; a tyre by creep times speed times turn.
        HiddenSet("rivals", ("lateral_slip=0.02",), first + 5, curves),
    ]
    return evenly(found, sizes.rivals, start)


def _arm_along_x(first: int) -> int:
    """The first seed from there on whose lever arm lies along x to a tenth."""
    for seed in count(first):
        mount = hide("reference_lever_arm", 1.0, seed=seed).peculiarity
        assert isinstance(mount, ReferenceMount)
        if abs(mount.y) < 0.1:
            return seed
    raise AssertionError


def other(start: int, sizes: Sizes) -> list[HiddenSet]:
    """Another engine set-up for each set."""
    found = [
        HiddenSet("other", (name,), start + 7000 + 10 * EFFECTS.index(name) + seed, "other")
        for name in evenly(EFFECTS, sizes.other_effects, start)
        for seed in range(sizes.other)
    ]
    found += [
        HiddenSet("other", (), start + 7500 + seed, "other") for seed in range(sizes.other_clean)
    ]
    return found + [
        HiddenSet("other", (name,), start + 7600 + OUTSIDERS.index(name), "other")
        for name in evenly(OUTSIDERS, sizes.other_outsiders, start)
    ]


def evenly(things: Sequence[Thing], wanted: int, start: int) -> list[Thing]:
    """So many of them, spread over all; which ones, the start says."""
    if wanted >= len(things):
        return list(things)
    first = start // APART
    picked = {(first + number * len(things) // wanted) % len(things) for number in range(wanted)}
    return [things[index] for index in sorted(picked)]
