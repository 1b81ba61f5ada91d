# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How small an effect any method could see in some drives: the bound of Cramér and Rao.

From what `werrimbi odom --as-reference` predicts with a little of the effect and without: the paths
differ, and the difference is weighed with the wheels' noise, which adds up along the way, and the
reference's, which is new in each pose. Start poses and the three calibration numbers are unknown.

To be told from a rival is more than to be seen: what the rival, fitted in its place, would explain
of it does not count. So the bound is also worked out with each rival's numbers unknown.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Collection, Mapping, Sequence
from functools import cache
from pathlib import Path
from statistics import NormalDist
from typing import NamedTuple

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
from werrimbi_odom.inference.fitting.score_tests import candidates

Floats = NDArray[np.float64]

LITTLE = 1e-6
"""Of the multipliers, for the calibration's derivatives; and of the smallest size that is hidden.
Headings are sums: at a thousandth one turns by 0.06 rad in 20 m, and the square of that, which no
shorter way has, passed for information (a third of the size of lost counts was to be seen)."""

SILENT = 1e-6
"""Share of a change below which it is rounding, and no direction of its own."""

ANYWHERE = 10.0
"""Standard deviation of a start pose that is unknown [m, rad]."""


class Bounds(NamedTuple):
    """Standard deviations that an unbiased estimate of an effect's size has at the least."""

    alone: float
    """With the calibration unknown."""
    beside: dict[str, float]
    """By rival: with what the rival can do unknown, too."""


def bounds(
    clean: HiddenSet,
    effect: str,
    peculiarity: Mapping[str, object],
    size: float,
    rivals: Collection[str] = (),
) -> Bounds:
    """How well the size of an effect can be known at the best, alone and beside each rival.

    Parameters
    ----------
    clean
        The drives, with nothing hidden in them.
    peculiarity
        Of the engine, of that size: a small one. Its shape (a threshold, a direction) counts as
        known, its size alone as unknown.
    size : float
        Distance from null, in the unit in which the bound is wanted.
    rivals
        Effects that may be fitted in its place, in each of their shapes.
    """
    values = values_of(effect, peculiarity)
    # Where a counter starts anywhere, any angle of a wheel is as good as another.
    anew = {name: 0.0 for name, item in find(effect).parameters.items() if item.per_run}
    own = np.concatenate(_change(clean, effect, tuple({**anew, **values}.items()), size))
    sizes = [name for name in CALIBRATION if name != effect]
    parameter = {"unequal_wheel_radii": "ratio"}
    known = [
        np.concatenate(
            _change(clean, name, ((parameter.get(name, "multiplier"), 1.0 + LITTLE),), LITTLE)
        )
        for name in sizes
    ]
    # A delay of each drive's own is none: what it does by itself is unknown like the calibration.
    nulls = find(effect).nulls
    for name in anew.keys() - values.keys():
        changed = nulls | {name: nulls[name] + LITTLE * find(effect).parameters[name].scale}
        known += _of_each(_change(clean, effect, tuple(changed.items()), LITTLE))
    beside = {
        rival: 1.0 / min(_left(own, [*known, *shape]) for shape in _shapes(clean, rival))
        for rival in rivals
        if rival not in CALIBRATION
    }
    return Bounds(1.0 / _left(own, known), beside)


def _left(own: Floats, others: Sequence[Floats]) -> float:
    """Size of a change once what others can do of it is taken off."""
    sizes = [float(np.linalg.norm(other)) for other in others]
    scaled = np.stack(
        [other / size for other, size in zip(others, sizes, strict=True) if size > 0.0], axis=-1
    )
    told = np.linalg.lstsq(scaled, own, rcond=SILENT)[0]
    return float(np.linalg.norm(own - scaled @ told))


def _of_each(change: Sequence[Floats]) -> list[Floats]:
    """A change in each drive by itself, of all drives' length."""
    return [
        np.concatenate([part * (drive == own) for drive, part in enumerate(change)])
        for own in range(len(change))
    ]


@cache
def _shapes(clean: HiddenSet, rival: str) -> list[list[Floats]]:
    """What a rival can change of some drives, in each of its shapes (a threshold, a length)."""
    drives = len(runs_of(make(clean), "train"))
    effect, found = find(rival), []
    for candidate in candidates([effect], (), (), drives):
        if not candidate.per_run and any(item.per_run for item in effect.parameters.values()):
            continue  # an angle that is the same in each drive: a part of one that is not
        null, columns = effect.nulls | dict(candidate.shape), []
        for coordinate in candidate.coordinates:
            values = candidate.with_value(coordinate, LITTLE).values
            change = _change(clean, rival, tuple(values.items()), LITTLE)
            moved = [name for name in null if coordinate[name] != null[name]]
            own = effect.quadrature is not None or candidate.place is not None
            if candidate.per_run and (own or any(effect.parameters[n].per_run for n in moved)):
                columns += _of_each(change)
            else:
                columns.append(np.concatenate(change))
        found.append(columns)
    return found


@cache
def _change(
    clean: HiddenSet, effect: str, values: tuple[tuple[str, float], ...], size: float
) -> list[Floats]:
    """What a little of an effect changes in each drive, in units of what is not known."""
    folder = make(clean)
    sensor = machine(clean.setup, clean.seed).reference
    noise = np.array([sensor.sigma_xy, sensor.sigma_xy, sensor.sigma_yaw])
    found = []
    for drive in runs_of(folder, "train"):
        plain, covariance = _predicted(folder, drive, ())
        changed, _ = _predicted(folder, drive, ((effect, values),))
        change = (changed - plain)[:, :, None] / size
        found.append(whitened(change, plain, covariance, noise)[:, 0])
    return found


@cache
def _predicted(
    folder: Path, drive: Path, effects: tuple[tuple[str, tuple[tuple[str, float], ...]], ...]
) -> tuple[Floats, Floats]:
    """Poses (n, 3) and covariances (n, 3, 3) by the readings of the counters nearest to some times.

    With effects put into the robot file. Not between readings: what is added to a covariance there
    would be none.
    """
    yaml = YAML()
    text = yaml.load((folder / "robot.yaml").read_text(encoding="utf-8"))
    (values,) = (node["ros__parameters"] for node in text.values())
    values["effects"] = [name for name, _ in effects]
    values |= {name: dict(block) for name, block in effects}
    when = np.loadtxt(drive / "reference.csv", delimiter=",", skiprows=1, usecols=0)
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


def tellable(sigma: float, chance: float, power: float) -> float:
    """Size at which an effect is told from a rival that is fitted in its place.

    The cost of the rival's model less that of the right one is about normal, with mean r and
    standard deviation 2 sqrt(r), where r is the noncentrality of what the rival leaves (Vuong,
    Econometrica 57, 1989). A difference of z(chance)^2 comes about with that chance at the most
    where the rival is the true one, however much it leaves.

    Parameters
    ----------
    sigma : float
        Bound of the size's standard deviation beside the rival.
    chance : float
        Of the wrong one of the two being told.
    power : float
        Share in which the right one is told.
    """
    sure, often = NormalDist().inv_cdf(1.0 - chance), NormalDist().inv_cdf(power)
    return sigma * (often + math.hypot(often, sure))


def unknown_numbers(effect: str, drives: int) -> int:
    """Of an effect in some drives: how many numbers a search for it fits."""
    parameters = find(effect).parameters.values()
    return sum(drives if item.per_run else 1 for item in parameters)
