# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference that repeats its pose to the last digit stands still itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import run_of
from test.model.drives import ROBOT
from werrimbi_odom.inference.legs.gaps import STUCK
from werrimbi_odom.inference.legs.held_or_carried import looked_at

BEGIN, END = 26.0, 27.2


@pytest.mark.parametrize("rate", [5, 10, 20])
@pytest.mark.parametrize("noise", [0.0, 1e-3])
def test_a_repeated_pose_is_told_of_the_reference(rate: float, noise: float) -> None:
    """As incremental references are judged, whose equal poses are not taken out."""
    run, random = run_of(ROBOT, 3, 40), np.random.default_rng(3)
    seen = run.reference
    assert seen is not None
    time = np.arange(seen.time[0], seen.time[-1], 1.0 / rate)
    poses = np.stack(
        [
            np.interp(time, seen.time, part) + 1e-3 * random.standard_normal(time.size)
            for part in (seen.x, seen.y, np.unwrap(seen.yaw))
        ]
    )
    inside = (time > BEGIN) & (time < END)
    last = poses[:, inside][:, :1]
    poses[:, inside] = last + noise * random.standard_normal((3, inside.sum()))
    x, y, yaw = poses
    found = looked_at(replace(run, reference=replace(seen, time=time, x=x, y=y, yaw=yaw)), ROBOT)
    assert found.no_driving is not None
    (part,) = found.no_driving
    assert part.begin == pytest.approx(BEGIN, abs=0.3)
    assert part.end == pytest.approx(END, abs=0.3)
    if noise:
        assert part.why in ("held", "carried")
    else:
        assert (part.why, part.words) == ("gap", STUCK)
