# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How small an effect any method could see in some drives: the bound of Cramér and Rao.

From what `werrimbi odom --as-reference` predicts with a little of the effect and without: the paths
differ, and the difference is weighed with the wheels' noise, which adds up along the way, and the
reference's, which is new in each pose. Start poses and the three calibration numbers are unknown.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from ruamel.yaml import YAML
from scipy.special import chndtrinc
from scipy.stats import chi2

from test.hidden.follow import run
from test.hidden.machines import machine
from test.hidden.plan import CALIBRATION
from test.hidden.sets import HiddenSet, make, runs_of
from test.hidden.true_values import values_of
from werrimbi_odom.effects import find

Floats = NDArray[np.float64]

LITTLE = 1e-6
"""Of the multipliers, for the calibration's derivatives; and of the smallest size that is hidden.
Headings are sums: at a thousandth one turns by 0.06 rad in 20 m, and the square of that, which no
shorter way has, passed for information (a third of the size of lost counts was to be seen)."""

ANYWHERE = 10.0
"""Standard deviation of a start pose that is unknown [m, rad]."""


def bound(clean: HiddenSet, effect: str, peculiarity: Mapping[str, object], size: float) -> float:
    """Standard deviation that an unbiased estimate of an effect's size has at the least.

    Parameters
    ----------
    clean
        The drives, with nothing hidden in them.
    peculiarity
        Of the engine, of that size: a small one. Its shape (a threshold, a direction) counts as
        known, its size alone as unknown.
    size : float
        Distance from null, in the unit in which the bound is wanted.
    """
    folder = make(clean)
    sensor = machine(clean.setup, clean.seed).reference
    noise = np.array([sensor.sigma_xy, sensor.sigma_xy, sensor.sigma_yaw])
    values = values_of(effect, peculiarity)
    # Where a counter starts anywhere, any angle of a wheel is as good as another.
    angles = {name: 0.0 for name, item in find(effect).parameters.items() if item.per_run}
    values = angles | dict(values)
    blocks = [{effect: values}]
    others = [name for name in CALIBRATION if name != effect]
    scales = [size] + [LITTLE] * len(others)
    parameter = {"unequal_wheel_radii": "ratio"}
    blocks += [{name: {parameter.get(name, "multiplier"): 1.0 + LITTLE}} for name in others]
    information = np.zeros((len(blocks), len(blocks)))
    for drive in runs_of(folder, "train"):
        when = np.loadtxt(drive / "reference.csv", delimiter=",", skiprows=1, usecols=0)
        plain, covariance = _predicted(folder, drive, {}, when)
        changes = [
            (_predicted(folder, drive, block, when)[0] - plain) / scale
            for block, scale in zip(blocks, scales, strict=True)
        ]
        white = whitened(np.stack(changes, axis=-1), plain, covariance, noise)
        information += white.T @ white
    return float(np.linalg.inv(information)[0, 0] ** 0.5)


def _predicted(
    folder: Path, drive: Path, effects: Mapping[str, Mapping[str, float]], when: Floats
) -> tuple[Floats, Floats]:
    """Poses (n, 3) and covariances (n, 3, 3) by the readings of the counters nearest to some times.

    With effects put into the robot file. Not between readings: what is added to a covariance there
    would be none.
    """
    yaml = YAML()
    text = yaml.load((folder / "robot.yaml").read_text(encoding="utf-8"))
    (values,) = (node["ros__parameters"] for node in text.values())
    values["effects"] = list(effects)
    values |= {name: dict(block) for name, block in effects.items()}
    with tempfile.TemporaryDirectory() as place:
        robot, out = Path(place) / "robot.yaml", Path(place) / "odom.csv"
        with robot.open("w", encoding="utf-8") as file:
            yaml.dump(text, file)
        words = ["odom", "--robot", str(robot), str(drive), "--as-reference", "--out", str(out)]
        done = run(words)
        assert done.code == 0, done.complained
        rows = np.loadtxt(out, delimiter=",", skiprows=1)
    at = rows[np.unique(np.searchsorted(0.5 * (rows[1:, 0] + rows[:-1, 0]), when)), 1:]
    xx, xy, xw, yy, yw, ww = at[:, 3:9].T
    covariance = np.stack([xx, xy, xw, xy, yy, yw, xw, yw, ww], axis=-1).reshape(-1, 3, 3)
    return np.column_stack([at[:, :2], np.unwrap(at[:, 2])]), covariance


def whitened(changes: Floats, path: Floats, covariance: Floats, noise: Floats) -> Floats:
    """Changes of a predicted path in units of what is not known, innovation by innovation.

    Parameters
    ----------
    changes : array of shape (n, 3, k)
        Of the poses, by k parameters.
    path : array of shape (n, 3)
    covariance : array of shape (n, 3, 3)
        Of dead reckoning since the start.
    noise : array of shape (3,)
        Standard deviations of a measured pose.
    """
    measured = np.diag(noise**2)
    state = np.zeros_like(changes[0])
    spread = np.eye(3) * ANYWHERE**2
    rows = []
    for index, seen in enumerate(changes):
        if index:
            move = np.eye(3)
            step = path[index] - path[index - 1]
            move[0, 2], move[1, 2] = -step[1], step[0]
            added = _not_negative(covariance[index] - move @ covariance[index - 1] @ move.T)
            state = move @ state
            spread = move @ spread @ move.T + added
        root = np.linalg.cholesky(spread + measured)
        rows.append(np.linalg.solve(root, seen - state))
        gain = np.linalg.solve(spread + measured, spread).T
        state = state + gain @ (seen - state)
        keep = np.eye(3) - gain  # Joseph's form: the plain one loses the sign to rounding
        spread = keep @ spread @ keep.T + gain @ measured @ gain.T
    return np.concatenate(rows)


def _not_negative(matrix: Floats) -> Floats:
    """The nearest covariance: an arc's is for all of it, and anew where the next begins."""
    values, vectors = np.linalg.eigh(matrix)
    return np.asarray(vectors * values.clip(0.0) @ vectors.T)


def detectable(sigma: float, tests: int, chance: float, power: float, numbers: int = 1) -> float:
    """Size at which a test that is right about its noise finds an effect with this power.

    Parameters
    ----------
    sigma : float
        Bound of the size's standard deviation.
    tests : int
        Effects that are looked for at once; the chance of a false one is shared among them.
    numbers : int
        Of the effect that are unknown: its size, a direction on the floor, an angle in each drive.
        The likelihood ratio is then chi-squared with so many degrees of freedom (Wilks 1938).
    """
    least = chi2.isf(chance / tests, numbers)
    return sigma * math.sqrt(float(chndtrinc(least, numbers, 1.0 - power)))


def unknown_numbers(effect: str, drives: int) -> int:
    """Of an effect in some drives: how many numbers a search for it fits."""
    parameters = find(effect).parameters.values()
    return sum(drives if item.per_run else 1 for item in parameters)
