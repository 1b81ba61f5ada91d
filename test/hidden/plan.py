# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which sets the proof needs. Seeds of different effects differ, so that their chances do."""

from __future__ import annotations

import math
from itertools import combinations

from test.hidden.poorer import POORER
from test.hidden.sets import HiddenSet, drawn
from werrimbi_odom.simulation import CATALOGUE

SEEDS = 10
"""Sets of each effect."""

CLEAN = tuple(range(2001, 2051))
"""Seeds of the sets with nothing hidden."""

CALIBRATION = ("track_width", "unequal_wheel_radii", "wheel_radius_scale")
EFFECTS = tuple(entry.name for entry in CATALOGUE if entry.kind == "effect")
OUTSIDERS = tuple(entry.name for entry in CATALOGUE if entry.kind == "outside")
MISTAKES = tuple(entry.name for entry in CATALOGUE if entry.kind == "mistake")
FACTORS = {"2": 2.0, "4": 4.0, "pi": math.pi, "180/pi": 180.0 / math.pi, "1000": 1000.0}

FAMILIES = (
    ("track_width", "turn_dependent_track"),
    ("unequal_wheel_radii", "wheel_radius_scale", "radius_drift"),
    ("eccentric_left_wheel", "eccentric_right_wheel"),
    ("longitudinal_slip",),
    ("lateral_slip",),
    ("sideways_drift", "reference_yaw_offset"),
    ("floor_slope",),
    ("castor_kick", "left_backlash", "right_backlash"),
    ("left_missed_ticks", "right_missed_ticks"),
    ("reference_lever_arm",),
    ("reference_delay", "reference_heading_delay"),
    ("encoder_skew",),
)
"""Effects of one family are not hidden together: they have much of their signature in common."""


def effects() -> list[HiddenSet]:
    """Each effect of the vocabulary, weak and strong."""
    return [
        HiddenSet("effect", (name,), 1000 + 20 * number + seed)
        for number, name in enumerate(EFFECTS)
        for seed in range(SEEDS)
    ]


def clean() -> list[HiddenSet]:
    """Nothing hidden."""
    return [HiddenSet("clean", (), seed) for seed in CLEAN]


def calibration() -> list[HiddenSet]:
    """Only calibration wrong, in several numbers at once."""
    together = [*combinations(CALIBRATION, 2), CALIBRATION]
    return [
        HiddenSet("calibration", names, 3000 + 10 * number + seed)
        for number, names in enumerate(together)
        for seed in range(3)
    ]


def pairs() -> list[HiddenSet]:
    """Two effects of distinct families; a few with calibration."""
    chance = drawn(4000, "pairs")
    exotic = [
        family
        for family in (tuple(n for n in names if n not in CALIBRATION) for names in FAMILIES)
        if family
    ]
    found = []
    for seed in range(4000, 4020):
        first, second = chance.choice(len(exotic), 2, replace=False)
        names = [str(chance.choice(exotic[index])) for index in (first, second)]
        found.append(HiddenSet("pair", tuple(names), seed))
    for seed in range(4020, 4026):
        size = str(chance.choice(CALIBRATION))
        others = [family for family in FAMILIES if size not in family and family[0] != size]
        other = others[int(chance.integers(len(others)))]
        name = str(chance.choice([name for name in other if name not in CALIBRATION] or other))
        found.append(HiddenSet("pair", (size, name), seed))
    return found


def outsiders() -> list[HiddenSet]:
    """What the library does not hold; seeds are those of clean sets, which are their floor."""
    return [
        HiddenSet("outsider", (name,), CLEAN[4 * number + seed])
        for number, name in enumerate(OUTSIDERS)
        for seed in range(4)
    ]


def mistakes() -> list[HiddenSet]:
    """Wiring and frames."""
    return [
        HiddenSet("mistake", (name,), 5000 + 10 * number + seed)
        for number, name in enumerate(MISTAKES)
        for seed in range(2)
    ]


def factors() -> list[HiddenSet]:
    """Simple factors in the robot file, both ways."""
    found = []
    for number, factor in enumerate(FACTORS.values()):
        for key in ("wheel_radius", "wheel_separation"):
            for way in (factor, 1.0 / factor):
                entered = ((key, way),)
                found.append(HiddenSet("factor", (), CLEAN[number], entered=entered))
    return found


def poorer(seeds: int = 2) -> list[HiddenSet]:
    """The same drives by the same effects, measured worse."""
    found = [
        HiddenSet("poorer", effect.effects, effect.seed, seen=seen)
        for seen in POORER
        for effect in effects()
        if (effect.seed - 1000) % 20 < seeds
    ]
    return found + [
        HiddenSet("poorer", (), seed, seen=seen) for seen in POORER for seed in CLEAN[:4]
    ]


def rivals() -> list[HiddenSet]:
    """What the drives cannot tell apart, by construction."""
    lines, curves = "one_speed_line", "one_speed_curves"
    return [
        # A reference that is late by d is behind by v d; so is a robot that slips by v^2 / 2 at a
        # start. At one speed, and not by much, nobody knows which.
        HiddenSet("rivals", ("reference_delay=0.01",), 6008, lines),
        HiddenSet("rivals", ("longitudinal_slip=0.06",), 6007, lines),
        # A point at x is at x ahead, one that is late by d at v d behind, where only positions are
        # measured; a late one is also aside, by half the curvature times (v d)^2, so d is small.
        # Of this seed the arm lies along x.
        HiddenSet("rivals", ("reference_lever_arm=0.006",), 6016, curves, "positions_alone"),
        HiddenSet("rivals", ("reference_delay=0.015",), 6006, curves, "positions_alone"),
        # A point at x moves sideways by x times the turn; a tyre by creep times speed times turn.
        HiddenSet("rivals", ("lateral_slip=0.02",), 6005, curves),
    ]


def other() -> list[HiddenSet]:
    """Another engine set-up for each set: two of each effect, ten clean ones."""
    found = [
        HiddenSet("other", (name,), 7000 + 10 * number + seed, "other")
        for number, name in enumerate(EFFECTS)
        for seed in range(2)
    ]
    found += [HiddenSet("other", (), 7500 + seed, "other") for seed in range(10)]
    return found + [
        HiddenSet("other", (name,), 7600 + number, "other") for number, name in enumerate(OUTSIDERS)
    ]


def everything() -> list[HiddenSet]:
    """All of it; kinds take turns in none, so that a run that is stopped has whole groups."""
    return [
        *effects(),
        *clean(),
        *outsiders(),
        *calibration(),
        *mistakes(),
        *factors(),
        *rivals(),
        *pairs(),
        *other(),
        *poorer(),
    ]


def sample() -> list[HiddenSet]:
    """Some of each kind, for a look while the engine of the diagnosis is being changed."""
    some = [effects()[SEEDS * number + number % SEEDS] for number in range(len(EFFECTS))]
    return [
        *some,
        *clean()[:3],
        *outsiders()[::4],
        *calibration()[::6],
        *mistakes()[::2],
        *factors()[::5],
        *rivals()[::2],
        *pairs()[::9],
        *other()[::9],
    ]
