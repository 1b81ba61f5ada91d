# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A run: one recorded drive, wherever it was recorded."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal, NamedTuple, TypeVar
from weakref import ref

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.encoder import Counts
from werrimbi_odom.model.pose import Floats

EXACT = 2.0**53
"""Whole numbers below this are told apart by a float64."""

ReferenceKind = Literal["absolute", "incremental", "local_map"]
"""Poses each with noise of its own (motion capture); each told from the last one, so that noise
adds up (a gyro); or on a map, with an error that wanders slowly as well (a localiser)."""
Made = TypeVar("Made")


def integrated(time: Floats, rates: Floats) -> Floats:
    """Integral over time, (n, ...), by trapezia; stamps that do not go forward add nothing."""
    lasted = np.diff(np.maximum.accumulate(time)).reshape(-1, *(1,) * (rates.ndim - 1))
    steps = 0.5 * (rates[1:] + rates[:-1]) * lasted
    return np.concatenate([np.zeros((1, *rates.shape[1:])), np.cumsum(steps, axis=0)])


@dataclass(frozen=True, eq=False)
class Ticks:
    """What the encoders counted; arrays of shape (n,)."""

    time: Floats
    """Stamps, finite; they may go back where the record does [s]."""
    left: Counts
    """Cumulative signed counts; int64 where all are whole, else float64 with NaN where missing."""
    right: Counts
    """The same for the right wheel."""
    channels: Mapping[str, Floats] = field(default_factory=dict)
    """Other measured columns by name; NaN where not measured."""
    _latest: list[tuple[object, ref[Any]]] = field(default_factory=list, init=False, repr=False)

    def __reduce__(self) -> tuple[Any, ...]:
        """For another process: without what is remembered."""
        return Ticks, (self.time, self.left, self.right, self.channels)

    @property
    def rows(self) -> int:
        """Number of readings."""
        return int(self.time.size)

    def latest(self, by: object, work: Callable[[], Made]) -> Made:
        """What `work` makes of them, unless the same was made last, and somebody holds it still."""
        last, held = self._latest[0] if self._latest else (None, None)
        made: Made | None = held() if held is not None and last == by else None
        if made is None:
            made = work()
            self._latest[:] = [(by, ref(made))]
        return made


class GyroTurn(NamedTuple):
    """What a gyro showed whose headings were laid upon another reference's; see `merged`."""

    turned: Floats
    """Turning, clear of what an angle and a steady drift make of it, shape (m,) [rad]."""
    scale: float
    """Turning by the other over the gyro's, told by this drive alone."""
    std: float


@dataclass(frozen=True, eq=False)
class Reference:
    """What was measured from outside; arrays of shape (m,), NaN where not measured."""

    time: Floats
    """Stamps in the ticks' clock, finite [s]."""
    x: Floats
    """[m]"""
    y: Floats
    """[m]"""
    yaw: Floats
    """Wrapped or not, as it was recorded [rad]."""
    sigma_xy: Floats | None = None
    """Standard deviation of x, and of y, where it is stated [m]."""
    sigma_yaw: Floats | None = None
    """Standard deviation of yaw, where it is stated [rad]."""
    kind: ReferenceKind | None = field(default=None, kw_only=True)
    """What its noise is like, where the reader knows; None where it does not."""
    own_axes: bool = field(default=False, kw_only=True)
    """Its axes begin anew with each drive, and where it was cut (scans without a map): then drives
    have no direction and no place of the floor in common."""
    gyro: GyroTurn | None = field(default=None, kw_only=True)
    """Where `yaw` is a gyro's, laid upon another reference's."""
    stamped_together: bool = field(default=False, kw_only=True)
    """Its stamps are late when the wheels' are; see `inference.legs.even_stamps`."""

    @property
    def has_position(self) -> NDArray[np.bool_]:
        """Where x and y were measured."""
        return np.isfinite(self.x) & np.isfinite(self.y)

    @property
    def has_yaw(self) -> NDArray[np.bool_]:
        """Where yaw was measured."""
        return np.isfinite(self.yaw)

    def earlier(self, delay: float) -> Reference:
        """The same with stamps that are free of a delay [s]."""
        return self if delay == 0.0 else replace(self, time=self.time - delay)

    def chosen(self, which: NDArray[np.bool_]) -> Reference:
        """Some of the poses; `which` has shape (m,)."""
        return Reference(
            self.time[which],
            self.x[which],
            self.y[which],
            self.yaw[which],
            None if self.sigma_xy is None else self.sigma_xy[which],
            None if self.sigma_yaw is None else self.sigma_yaw[which],
            kind=self.kind,
            own_axes=self.own_axes,
            gyro=None if self.gyro is None else self.gyro._replace(turned=self.gyro.turned[which]),
            stamped_together=self.stamped_together,
        )


Why = Literal["held", "carried", "gap", "counter", "reference"]
"""held: wheels turn, the robot does not; carried: it moves, its wheels do not; gap: reference or
ticks are silent while it drives; counter: it leapt; reference: it jumped."""


class NoDriving(NamedTuple):
    """A stretch of a run that is no driving."""

    begin: float
    """In the run's own clock [s]."""
    end: float
    why: Why
    words: str
    """What happened then, as the end of a sentence: the wheels turned and ..."""


@dataclass(frozen=True, eq=False)
class Run:
    """One recorded drive."""

    name: str
    """Last part of the path."""
    path: Path
    ticks: Ticks
    reference: Reference | None = None
    notes: tuple[str, ...] = ()
    """What the reader chose or left out, in words for the user."""
    damage: tuple[str, ...] = ()
    """What of the record is spoilt and was got over, in words for the user."""
    no_reference: str = ""
    """Where nothing was measured: what would be a reference, and what is there."""
    circle: str = ""
    """Where the reference's name and frames say that it is made from the wheels: what it is, why,
    and what else there is."""
    held_poses: int = 0
    """Poses of the reference that were left out, see `held.without_held_poses`."""
    no_driving: tuple[NoDriving, ...] | None = None
    """What of it is no driving; None where nobody has looked yet."""
    taken_out: tuple[tuple[float, float], ...] = ()
    """Stretches of the reference that were put aside on purpose, from and to in its stamps [s]:
    legs end there, and begin anew."""
    happened: tuple[tuple[float, float], ...] = ()
    """Stretches in which the robot, or the reference, was moved at once, from and to in the stamps
    of the reference [s]: an event, which no law explains. Legs go through it, and nothing is told
    of their errors."""


class Collected(NamedTuple):
    """A reference from the messages of one topic."""

    reference: Reference
    told: str
    """In words what it is about."""
    damage: tuple[str, ...] = ()
    """See `Run.damage`."""
    taken_out: tuple[tuple[float, float], ...] = ()
    """See `Run.taken_out`."""


def counts_of(values: Floats) -> Counts:
    """Counts as int64 where all of them are whole numbers that a float64 tells apart."""
    exact = np.abs(values) < EXACT
    if exact.all() and (values == np.rint(values)).all():
        return values.astype(np.int64)
    return values
