# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stretches that are left out are told with their times."""

from __future__ import annotations

from pathlib import Path

from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.report.phrases import left_out_words


def test_what_lasts_no_time_was_at_a_time() -> None:
    run = Path("run")
    leap = LeftOut(run, 0.001, 0.02, "counter", "the right counter leapt by 13.5 m")
    held = LeftOut(run, 9.7, 11.2, "carried", "the robot was carried")
    at_once, lasting = left_out_words([leap, held])
    assert at_once == "At 0.0 s the right counter leapt by 13.5 m: left out."
    assert lasting == "From 9.7 s to 11.2 s the robot was carried: left out."


def test_the_longest_stretches_are_told_in_their_order() -> None:
    """Of sixty silences, those of half a second stood in the way of the half hour that mattered."""
    run = Path("run")
    short = [LeftOut(run, 10.0 * n, 10.0 * n + 0.5, "gap", "silent") for n in range(1, 8)]
    long = LeftOut(run, 100.0, 843.0, "carried", "the heading is not known")
    *told, rest = left_out_words([*short, long])
    assert told[-1] == "From 100.0 s to 843.0 s of run the heading is not known: left out."
    assert told[0].startswith("From 10.0 s")
    assert rest == "So are 3 more such stretches, 1.5 s in all."
