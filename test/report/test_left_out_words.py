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
