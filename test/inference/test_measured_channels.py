# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Extra columns of the ticks: a sensor that was not connected in one drive measured nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import run_of
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration, search_round
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.legs.cutting import match_for_fit

LOADED, UNPLUGGED = 5.0, float("nan")


def of_payload(seed: int, first: float) -> Run:
    """A drive whose payload begins at `first` [kg], and grows by 1 kg."""
    run = run_of(ROBOT, seed, 30)
    payload = first + np.linspace(0.0, 1.0, run.ticks.time.size)
    return replace(run, ticks=replace(run.ticks, channels={"payload_kg": payload}))


@pytest.mark.parametrize("first", [LOADED, UNPLUGGED])
def test_no_law_of_a_sensor_is_tried_that_one_drive_does_not_have(first: float) -> None:
    """It was tried, and the payload of that drive was not there."""
    drives = [of_payload(3, first), of_payload(5, LOADED)]
    runs = concatenated(match_for_fit(drives, ROBOT, 1.0))
    law = find("radius_by_channel")
    this = search_round(runs, fit_calibration(runs, ROBOT), [law], ROBOT)
    assert [score.candidate.name for score in this.scores] == [law.name] * (first == LOADED)


def test_a_sensor_that_was_not_connected_is_told_where_its_law_is_asked_for() -> None:
    drives = [of_payload(3, UNPLUGGED), of_payload(5, LOADED)]
    with pytest.raises(InputError, match="run_3 has none"):
        add_effects([find("radius_by_channel")], drives, ROBOT)
