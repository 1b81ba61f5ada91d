# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Positions of a comparison's legs, and the covariance of dead reckoning along the path."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.comparison.compare import Comparison
from werrimbi_odom.model.covariance import PoseCovariance
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.trajectory import trajectory


def middles(comparison: Comparison) -> NDArray[np.complex128]:
    """Measured midpoint of each leg (x + iy); by the model where only headings are measured."""
    legs = comparison.legs
    found = 0.5 * (legs.x + legs.end_x) + 0.5j * (legs.y + legs.end_y)
    found = found.astype(np.complex128)
    for index in headings_alone(comparison):
        mine = legs.run == index
        time = 0.5 * (legs.start_time + legs.end_time)[mine]
        path = comparison.paths[index]
        found[mine] = np.interp(time, path.time, path.predicted)
    return found


def headings_alone(comparison: Comparison) -> frozenset[int]:
    """Indices of the runs of which no positions are measured."""
    groups = comparison.prepared.groups
    return frozenset(i for group in groups if group.measure == "heading" for i in group.index)


def covariance_along(comparison: Comparison, index: int) -> Floats:
    """Covariance of the dead-reckoned position at every reference pose of a run, (n, 2, 2) [m²].

    It starts from the noise of the measured start pose. It is that of the axle's midpoint, which is
    near the point that the reference measures.
    """
    run, path = comparison.prepared.runs[index], comparison.paths[index]
    robot = comparison.model.of_run(index)
    group = next(item for item in comparison.prepared.groups if index in item.index)
    own = group.index.index(index)
    wander = group.own.noise.wander
    xy = math.hypot(group.own.sigma_xy[own], wander[0])
    heading = math.hypot(group.own.sigma_yaw[own], wander[1])
    yaw = float(path.predicted_yaw[0]) - view_of(robot.effects).yaw
    begin = int(np.clip(np.searchsorted(run.ticks.time, path.time[0]), 0, run.ticks.time.size - 2))
    ticks = run.ticks
    driven = trajectory(
        robot,
        ticks.time[begin:],
        ticks.left[begin:],
        ticks.right[begin:],
        start=Pose(0.0, 0.0, yaw),
        covariance=PoseCovariance(xy**2, 0.0, 0.0, xy**2, 0.0, heading**2),
        channels={name: values[begin:] for name, values in ticks.channels.items()},
    )
    every = driven.covariance.matrix()[:, :2, :2]
    rows = np.clip(np.searchsorted(driven.time, path.time), 0, driven.time.size - 1)
    return np.asarray(every[rows])
