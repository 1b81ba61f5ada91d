# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Matching of one scan with line elements: robust point-to-line ICP, with its covariance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from werrimbi_odom.model.pose import Floats
from werrimbi_odom.scans.line_features import Elements

ROUNDS = 40
PAIRED = 12
"""Rounds in which nearest lines are searched; then pairs are fixed, because an echo between two
lines could alternate between them for ever."""
CONVERGED = 1e-5
"""Step size [m, rad] at which the iteration has converged."""
GATES = (0.3, 0.08)
"""Largest and smallest gate for the distance of an echo from its line [m]. The first covers the
error of the predicted motion, the second the depth of a door's frame."""
SIGMAS = 6.0
"""The gate shrinks to this many standard deviations."""
LEAST_NOISE = 1e-3
"""Least noise of ranges [m]: no lidar is better."""
MAD = 1.4826
CAUCHY = 2.0
"""Residual at which an echo has half weight, in standard deviations (Cauchy weights)."""


@dataclass(frozen=True, eq=False)
class Match:
    """Pose of a scan relative to line elements."""

    pose: Floats
    """x, y [m] and yaw [rad] of the lidar, shape (3,)."""
    information: Floats
    """Information matrix of the pose for unit noise of ranges, shape (3, 3)."""
    noise: float
    """Scatter of the echoes about the lines [m]."""
    covariance: Floats
    """Covariance of the pose given the map, shape (3, 3); infinite if a direction is
    undetermined."""
    points: int
    """Number of echoes on a line."""
    share: float
    """Their mean weight: 1 if all agree."""
    converged: bool
    feigned: Floats


def match(points: Floats, elements: Elements, guess: Floats) -> Match:
    """Match echoes with line elements.

    Parameters
    ----------
    points : ndarray, shape (k, 2)
        Deskewed echoes in the lidar's frame, in the order of the beams [m].
    guess : ndarray, shape (3,)
        Initial pose. After convergence the result does not depend on it.
    """
    x, y, yaw = guess.tolist()
    gate, ratio, share, converged, used = np.inf, 1.0, 0.0, False, 0
    usual, information = LEAST_NOISE, np.zeros((3, 3))
    for round_ in range(ROUNDS):
        cos, sin = np.cos(yaw), np.sin(yaw)
        turned = points @ np.array([[cos, sin], [-sin, cos]])
        placed = turned + np.array([x, y])
        if round_ < PAIRED:
            distance, nearest = elements.tree.query(placed, distance_upper_bound=GATES[0])
            near = np.flatnonzero(distance < np.inf)
            nearest, distance = nearest[near], distance[near]
            normals, noise = elements.normals[nearest], elements.noise[nearest]
        away = ((placed[near] - elements.centres[nearest]) * normals).sum(axis=1)
        limit = np.clip(gate * noise, GATES[1], GATES[0])
        kept = (np.abs(away) <= limit) & (distance <= np.maximum(limit, elements.reach[nearest]))
        used = int(np.count_nonzero(kept))
        if used < 3:
            break
        pairs = nearest[kept]
        sigma, arm = noise[kept], turned[near[kept]]
        along = normals[kept]
        usual = float(np.median(sigma))
        residual = away[kept] / sigma
        size = np.abs(residual)
        ratio = max(MAD * float(np.partition(size, used // 2)[used // 2]), LEAST_NOISE / usual)
        weight = 1.0 / (1.0 + (residual / (CAUCHY * ratio)) ** 2)
        lever = arm[:, 0] * along[:, 1] - arm[:, 1] * along[:, 0]
        design = np.column_stack([along, lever]) / sigma[:, None]
        weighted = design * weight[:, None]
        information = weighted.T @ design
        share = float(weight.mean())
        if np.linalg.det(usual**2 * information) < 1e-9:
            break  # the pose is not determined
        step = np.linalg.solve(information, weighted.T @ -residual)
        x, y, yaw = x + step[0], y + step[1], yaw + step[2]
        gate = min(gate, SIGMAS * ratio)
        if np.abs(step).max() < CONVERGED:
            converged = True
            break
    feigned = np.zeros((2, 2))
    scatter, covariance = ratio * usual, np.full((3, 3), np.inf)
    if used >= 3:
        turn = elements.tilt[pairs] / sigma
        aside = np.column_stack([-along[:, 1], along[:, 0]]) * turn[:, None]
        feigned = usual**2 * (aside * weight[:, None]).T @ aside
        scatter = usual * float(
            np.sqrt((weight * residual**2).sum() / max(weight.sum() - 3.0, 1.0))
        )
        covariance = _covariance(design, residual, weight)
    return Match(
        np.array([x, y, yaw]),
        usual**2 * information,
        scatter,
        covariance,
        used,
        share,
        converged,
        feigned,
    )


def _covariance(design: Floats, residual: Floats, weight: Floats) -> Floats:
    """Sandwich covariance of a robust fit to independent, heteroscedastic echoes, shape (3, 3).

    For an M-estimator with score psi it is A^-1 B A^-1, with A the sum of psi' times the squared
    design and B that of psi^2 (Huber 1967). With equal noise of all echoes, cupboards far along a
    corridor would seem to determine its direction as well as near walls do. Deviations of walls
    from their lines are alike in neighbouring echoes and in the next scan, so they move no pose
    relative to the next. Differences of neighbours remove them.
    """
    slope = weight * (2.0 * weight - 1.0)  # derivative of Cauchy's score
    curvature = (design * slope[:, None]).T @ design
    if np.linalg.det(curvature) < 1e-9:
        return np.full((3, 3), np.inf)
    score = weight * residual
    apart = score - 0.5 * (np.roll(score, 1) + np.roll(score, -1))
    spread = (design * (apart**2 / 1.5)[:, None]).T @ design
    inverse = np.linalg.inv(curvature)
    return np.asarray(inverse @ spread @ inverse)
