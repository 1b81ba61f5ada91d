# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One scan laid upon line elements: point to line, robust, with its covariance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from werrimbi_odom.model.pose import Floats
from werrimbi_odom.scans.elements import Elements

ROUNDS = 40
PAIRED = 12
"""Of these rounds: in so many the nearest lines are looked up; then they stay, for an echo between
two of them would go to and fro for ever."""
CONVERGED = 1e-5
"""Steps [m, rad] below which the search has ended."""
GATES = (0.3, 0.08)
"""How far from a line an echo may lie at first, and at the least [m]: the first holds what the last
motion mispredicts, the least what a door's frame stands out."""
SIGMAS = 6.0
"""The gate shrinks to so many standard deviations."""
LEAST_NOISE = 1e-3
"""Of ranges [m]: no lidar is better."""
MAD = 1.4826
CAUCHY = 2.0
"""Standard deviations at which an echo counts half."""


@dataclass(frozen=True, eq=False)
class Match:
    """Where a scan was seen from."""

    pose: Floats
    """x, y [m] and yaw [rad] of the lidar, shape (3,)."""
    information: Floats
    """Of the pose, for ranges of unit noise, shape (3, 3)."""
    noise: float
    """Scatter of the echoes about the lines [m]."""
    covariance: Floats
    """Of the pose, given the map; infinite where one of the three is not held, shape (3, 3)."""
    points: int
    """Echoes that lie on a line."""
    share: float
    """Mean weight of these: 1 where all agree."""
    converged: bool


def match(points: Floats, elements: Elements, guess: Floats) -> Match:
    """Lay echoes upon line elements.

    Parameters
    ----------
    points : ndarray, shape (k, 2)
        Deskewed, in the lidar's frame, in the order of the beams [m].
    guess : ndarray, shape (3,)
        A pose to begin with. Where it converges, nothing of it remains in the result.
    """
    x, y, yaw = guess.tolist()
    gate, noise, share, converged, used = GATES[0], LEAST_NOISE, 0.0, False, 0
    information = np.zeros((3, 3))
    for round_ in range(ROUNDS):
        cos, sin = np.cos(yaw), np.sin(yaw)
        turned = points @ np.array([[cos, sin], [-sin, cos]])
        placed = turned + np.array([x, y])
        if round_ < PAIRED:
            distance, nearest = elements.tree.query(placed, distance_upper_bound=GATES[0])
            near = np.flatnonzero(distance < np.inf)
            nearest = nearest[near]
        normals = elements.normals[nearest]
        residual = ((placed[near] - elements.centres[nearest]) * normals).sum(axis=1)
        kept = np.abs(residual) <= gate
        kept &= distance[near] <= np.maximum(gate, elements.reach[nearest])
        used = int(np.count_nonzero(kept))
        if used < 3:
            break
        residual, normals, turned = residual[kept], normals[kept], turned[near[kept]]
        size = np.abs(residual)
        noise = max(MAD * float(np.partition(size, used // 2)[used // 2]), LEAST_NOISE)
        weight = 1.0 / (1.0 + (residual / (CAUCHY * noise)) ** 2)
        lever = turned[:, 0] * normals[:, 1] - turned[:, 1] * normals[:, 0]
        design = np.column_stack([normals, lever])
        weighted = design * weight[:, None]
        information = weighted.T @ design
        share = float(weight.mean())
        if np.linalg.det(information) < 1e-9:
            break  # nothing holds one of the three
        step = np.linalg.solve(information, weighted.T @ -residual)
        x, y, yaw = x + step[0], y + step[1], yaw + step[2]
        gate = max(min(gate, SIGMAS * noise), GATES[1])
        if np.abs(step).max() < CONVERGED:
            converged = True
            break
    scatter, covariance = noise, np.full((3, 3), np.inf)
    if used >= 3:
        scatter = float(np.sqrt((weight * residual**2).sum() / max(weight.sum() - 3.0, 1.0)))
        covariance = _covariance(design, residual, weight)
    return Match(np.array([x, y, yaw]), information, scatter, covariance, used, share, converged)


def _covariance(design: Floats, residual: Floats, weight: Floats) -> Floats:
    """Of a robust fit to echoes of which each errs by itself, and some more than others, (3, 3).

    An M-estimator of score psi has A^-1 B A^-1, A the sum of psi' times the squared design and B
    that of psi^2 (Huber 1967). With one noise for all echoes the cupboards far along a corridor
    would hold it as well as its near walls do. What walls and their lines differ is alike in
    neighbouring echoes, and there in the next scan again, so it moves no pose against the next:
    differences of neighbours leave it out.
    """
    slope = weight * (2.0 * weight - 1.0)  # of Cauchy's score
    curvature = (design * slope[:, None]).T @ design
    if np.linalg.det(curvature) < 1e-9:
        return np.full((3, 3), np.inf)
    score = weight * residual
    apart = score - 0.5 * (np.roll(score, 1) + np.roll(score, -1))
    spread = (design * (apart**2 / 1.5)[:, None]).T @ design
    inverse = np.linalg.inv(curvature)
    return np.asarray(inverse @ spread @ inverse)
