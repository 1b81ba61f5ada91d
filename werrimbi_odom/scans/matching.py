# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Matching of one scan with line elements: robust point-to-line ICP, with its covariance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from werrimbi_odom.model.pose import Floats
from werrimbi_odom.scans.line_features import LEAST_NOISE, Elements

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
MAD = 1.4826
CAUCHY = 2.0
"""Residual at which an echo has half weight, in standard deviations (Cauchy weights)."""

BENT = 0.02
"""How much a lidar bends what is straight [rad]: its ranges err by some millimetres, at each angle
by its own, and the dents that a bare wall so gets go with the robot. Of a real Neato's 3 to 4 mm
(scatter 0.7 mm) the lines had directions of 0.017 rad, and beside a wall it seemed to stand."""

DENT = 7e-3
"""Least noise by which echoes disagree [m]: twice the dents of a real Neato, 3 to 4 mm. By its own
noise of 1 mm an end wall with such dents agreed by 0.4 with a map of one scan."""

PLACE = 0.6
"""Width of what counts as one place [m]: a step of stairs to each side."""

MOST_LEVERAGE = 0.8
"""Largest leverage of an echo that its residual is freed of: one of its own tells nothing."""
ALIKE = 4
"""Beams over which errors of echoes may be alike. With a real LD08, whose driver truncates angles
to a grid of 28 mrad, their correlation is 0.6, 0.3 and 0.15 over 1, 2 and 3 beams, and 0.05 over 5.
More beams tell of it hardly more, and of independent echoes less: what the fit takes up of their
sum is missing (NEES of steps in a simulated room: 1.10 with 3, 1.16 with 6)."""


@dataclass(frozen=True, eq=False)
class Match:
    """Pose of a scan relative to line elements."""

    pose: Floats
    """x, y [m] and yaw [rad] of the lidar, shape (3,)."""
    information: Floats
    """Information matrix of the pose for unit noise of echoes on usual lines, shape (3, 3)."""
    feigned: Floats
    """What of that of the position lines feign that are askew by noise, or bent, shape (2, 2)."""
    aged: Floats
    """That information with each echo counted as many times as its line is key scans old on the
    average, shape (3, 3)."""
    noise: float
    """Scatter of the echoes about the lines, of usual ones [m]."""
    covariance: Floats
    """Covariance of the pose given the map, shape (3, 3); infinite if a direction is
    undetermined."""
    points: int
    """Number of echoes on a line."""
    share: float
    """Their mean weight: 1 if all agree."""
    agreed: float
    """The same along the weakest direction of the position, where a dent is no disagreement."""
    alone: float
    """Share of what is known along it that one place tells, up to `PLACE` wide."""
    converged: bool


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
    gate, noise, share, converged, used = np.inf, LEAST_NOISE, 0.0, False, 0
    information = np.zeros((3, 3))
    for round_ in range(ROUNDS):
        cos, sin = np.cos(yaw), np.sin(yaw)
        turned = points @ np.array([[cos, sin], [-sin, cos]])
        placed = turned + np.array([x, y])
        if round_ < PAIRED:
            distance, nearest = elements.tree.query(placed, distance_upper_bound=GATES[0])
            near = np.flatnonzero(distance < np.inf)
            nearest = nearest[near]
        normals, worth = elements.normals[nearest], elements.worth[nearest]
        residual = ((placed[near] - elements.centres[nearest]) * normals).sum(axis=1)
        within = np.clip(gate / worth, GATES[1], GATES[0])
        kept = np.abs(residual) <= within
        kept &= distance[near] <= np.maximum(within, elements.reach[nearest])
        used = int(np.count_nonzero(kept))
        if used < 3:
            break
        # Each residual, and its row of the design, in units of what its line is worth.
        worth, normals, turned = worth[kept], normals[kept], turned[near[kept]]
        residual = worth * residual[kept]
        size = np.abs(residual)
        noise = max(MAD * float(np.partition(size, used // 2)[used // 2]), LEAST_NOISE)
        weight = 1.0 / (1.0 + (residual / (CAUCHY * noise)) ** 2)
        lever = turned[:, 0] * normals[:, 1] - turned[:, 1] * normals[:, 0]
        design = np.column_stack([normals, lever]) * worth[:, None]
        weighted = design * weight[:, None]
        information = weighted.T @ design
        share = float(weight.mean())
        if np.linalg.det(information) < 1e-9:
            break  # the pose is not determined
        step = np.linalg.solve(information, weighted.T @ -residual)
        x, y, yaw = x + step[0], y + step[1], yaw + step[2]
        gate = min(gate, SIGMAS * noise)
        if np.abs(step).max() < CONVERGED:
            converged = True
            break
    scatter, covariance, feigned = noise, np.full((3, 3), np.inf), np.zeros((2, 2))
    aged, agreed, alone = np.zeros((3, 3)), 0.0, 1.0
    if used >= 3:
        scatter = float(np.sqrt((weight * residual**2).sum() / max(weight.sum() - 3.0, 1.0)))
        covariance = _covariance(design, residual, weight)
        askew = np.hypot(elements.tilt[nearest[kept]], BENT)
        aside = design[:, [1, 0]] * [-1.0, 1.0] * askew[:, None]
        feigned = (aside * weight[:, None]).T @ aside
        aged = (weighted * elements.age[nearest[kept], None]).T @ design
        believed = 1.0 / (1.0 + (residual / (CAUCHY * max(noise, DENT))) ** 2)
        agreed, alone = _weakest(design[:, :2], believed, turned)
    pose = np.array([x, y, yaw])
    return Match(
        pose,
        information,
        feigned,
        aged,
        scatter,
        covariance,
        used,
        share,
        agreed,
        alone,
        converged,
    )


def _weakest(design: Floats, weight: Floats, points: Floats) -> tuple[float, float]:
    """`Match.agreed` and `Match.alone`; all of shape (k, 2), the weights (k,)."""
    direction = np.linalg.eigh((design * weight[:, None]).T @ design)[1][:, 0]
    told = (design @ direction) ** 2
    by_each = weight * told
    sure = float(by_each.sum())
    if sure <= 0.0:
        return 0.0, 1.0
    along = points @ direction
    order = np.argsort(along)
    upto = np.cumsum(by_each[order])
    middle = along[order[np.searchsorted(upto, 0.5 * sure)]]
    there = np.abs(along - middle) < 0.5 * PLACE
    return sure / float(told.sum()), float(by_each[there].sum()) / sure


def _covariance(design: Floats, residual: Floats, weight: Floats) -> Floats:
    """Sandwich covariance of a robust fit to heteroscedastic echoes, shape (3, 3).

    For an M-estimator with score psi it is A^-1 B A^-1, with A the sum of psi' times the squared
    design and B that of psi^2 (Huber 1967). With equal noise of all echoes, cupboards far along a
    corridor would seem to determine its direction as well as near walls do. B has the products of
    neighbouring echoes too (Newey and West 1987), whose errors may be alike: walls are no lines,
    and some drivers write each echo to a bin of a grid of angles. At rest the next scan has the
    same errors, and they move no pose relative to it; in motion they do. Where few echoes determine
    a direction, the fit takes up a part of their errors, their leverage, and residuals are freed of
    it (MacKinnon and White 1985). Without that a corridor's direction was too sure by a sixth.
    """
    slope = weight * (2.0 * weight - 1.0)  # derivative of Cauchy's score
    curvature = (design * slope[:, None]).T @ design
    if np.linalg.det(curvature) < 1e-9:
        return np.full((3, 3), np.inf)
    weighted = design * weight[:, None]
    leverage = (weighted @ np.linalg.inv(weighted.T @ design) * design).sum(axis=1)
    score = weight * residual / (1.0 - np.minimum(leverage, MOST_LEVERAGE))
    pull = design * score[:, None]
    before = 0.5 * pull
    for apart in range(1, ALIKE + 1):
        before += (1.0 - apart / (ALIKE + 1.0)) * np.roll(pull, apart, axis=0)
    half = pull.T @ before
    inverse = np.linalg.inv(curvature)
    return np.asarray(inverse @ (half + half.T) @ inverse)
