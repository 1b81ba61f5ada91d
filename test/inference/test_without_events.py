# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Fits are repeated without events as long as these are accidents."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from werrimbi_odom.files.run import Run, Ticks
from werrimbi_odom.inference.diagnosis.without_events import refit_without_events
from werrimbi_odom.inference.events.common_cause import Alike
from werrimbi_odom.inference.events.events import Event, Events


def test_what_turns_out_to_be_no_accident_is_left_out_of_no_fit() -> None:
    """Not of the last one, and not of one before it either: the first is told."""
    path = Path("drive")
    run = Run("drive", path, Ticks(np.arange(3.0), np.zeros(3, int), np.zeros(3, int)))
    one, other = (
        Event(path, False, at, at, 0.0, "heading", 0.1, 0.01, "rad", (0.0, 0.0, 0.1),
              (1e-3, 1e-3, 0.01), (0.0, 0.0), True, 1e-9)
        for at in (1.0, 2.0)
    )  # fmt: skip
    place = Alike("place", 4, 4, (0.0, 0.0), 1e-9, of_reference=False)
    for last, told in (
        (Events((one, other)), 2),
        (Events(many=True), 0),
        (Events((one, other), alike=place), 0),
    ):
        beside = iter((Events((one,)), Events((one, other)), last))

        def fit(
            runs: Sequence[Run], holdout: Sequence[Run], first: bool, beside: Iterator[Events]
        ) -> tuple[int, Events]:
            return len(runs[0].happened), next(beside)

        left_out, happened = refit_without_events(partial(fit, beside=beside), [run], [])
        assert left_out == told
        assert happened is last
