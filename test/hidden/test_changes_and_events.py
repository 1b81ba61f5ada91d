# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What changed between sessions, and what happened at once, in the engine: how often it is told."""

from __future__ import annotations

import pytest

pytest.importorskip("mujoco", reason="hidden sets need the physics engine (pip install mujoco)")

from test.hidden import changes, events

pytestmark = pytest.mark.evidence


def test_a_radius_that_changed_by_three_thousandths_is_told_and_none_that_did_not() -> None:
    for told in changes.all_told(4, seed=3, share=0.003, workers=1):
        assert told.found == told.its_drive == (told.wheel is not None)
        assert told.beside == ()


def test_of_events_of_five_times_the_noise_nineteen_in_twenty_are_told() -> None:
    told = [*events.all_told(25, seed=9101, times=5.0)]
    found = [is_found for each in told for _, is_found in each.found]
    assert sum(found) >= 0.95 * len(found)
    assert sum(each.quiet == 0 for each in told) >= 0.98 * len(told)
