# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A run: one recorded drive, from any kind of recording."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.mount import Mount
from werrimbi_odom.model.counter_wraps import running_on
from werrimbi_odom.model.encoder_online import Counts
from werrimbi_odom.model.pose import Floats

EXACT = 2.0**53
"""A float64 represents all integers below this exactly."""

ReferenceKind = Literal["absolute", "incremental", "local_map"]
"""absolute: independent noise per pose (motion capture); incremental: each pose relative to the
last, so that noise accumulates (a gyro); local_map: absolute with an additional slowly drifting
error (a localiser)."""
Gives = Literal["counts", "positions", "velocities", "odometry"]
"""Kinds of wheel data: counters, joint angles, joint speeds only, or the firmware's own poses."""
WORKED_OUT: dict[Gives, str] = {
    "velocities": "there are no wheel angles, only speeds: they are integrated, which loses "
    "what the wheels did between two messages",
    "odometry": "the wheels' travel is turned back from poses of odometry (from its twist, where "
    "they never change), by wheel_radius and wheel_separation of the robot file without their "
    "multipliers: these must be what the driver itself works with; what else it is made of is "
    "judged with the wheels, as the gyro that it takes its heading from, or all that a filter "
    "fuses",
}
"""What is said of wheels that nothing counted."""
Made = TypeVar("Made")


def integrated(time: Floats, rates: Floats) -> Floats:
    """Integral over time, (n, ...), by the trapezoidal rule; non-increasing stamps add nothing."""
    lasted = np.diff(np.maximum.accumulate(time)).reshape(-1, *(1,) * (rates.ndim - 1))
    steps = 0.5 * (rates[1:] + rates[:-1]) * lasted
    return np.concatenate([np.zeros((1, *rates.shape[1:])), np.cumsum(steps, axis=0)])


@dataclass(frozen=True, eq=False)
class Ticks:
    """Encoder counts; arrays of shape (n,)."""

    time: Floats
    """Stamps, finite [s]; they may decrease where the record does."""
    left: Counts
    """Cumulative signed counts; int64 if all are integers, else float64 with NaN where missing."""
    right: Counts
    """The same for the right wheel."""
    channels: Mapping[str, Floats] = field(default_factory=dict)
    """Other measured columns by name; NaN where not measured."""
    _latest: list[tuple[object, Any]] = field(default_factory=list, init=False, repr=False)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle without the cache."""
        return Ticks, (self.time, self.left, self.right, self.channels)

    @property
    def rows(self) -> int:
        """Number of readings."""
        return int(self.time.size)

    def unwrapped(self, bits: int) -> Ticks:
        """With counters that run on where those of `bits` bits begin anew; itself for 0.

        To compare them with a motion. An odometer takes them as they are: a reading near zero tells
        it of a counter that was reset.
        """
        if not bits:
            return self
        left, right = (_running_on(counts, bits) for counts in (self.left, self.right))
        return Ticks(self.time, left, right, self.channels)

    def latest(self, by: object, work: Callable[[], Made]) -> Made:
        """Result of `work`, cached for the last key `by`."""
        if not self._latest or self._latest[0][0] != by:
            self._latest[:] = [(by, work())]
        made: Made = self._latest[0][1]
        return made


def _running_on(counts: Counts, bits: int) -> Counts:
    whole = np.flatnonzero(np.isfinite(counts))
    if whole.size == 0:
        return counts
    run = counts.astype(np.float64)
    run[whole] = running_on(counts[whole], bits)
    return run


class GyroTurn(NamedTuple):
    """Turn of a gyro after its alignment with another reference; see `merged`."""

    time: Floats
    """All its stamps, on the other reference's clock, shape (n,) [s]."""
    yaw: Floats
    """Its headings before the alignment, shape (n,) [rad]."""
    turned: Floats
    """Turn without its part in offset and constant drift, shape (m,) [rad]."""
    scale: float
    """Turn of the other reference over that of the gyro, estimated from this drive alone."""
    std: float
    by_course: bool = False
    """Whether it was aligned with the direction of positions, which hold no headings."""
    mount: float = 0.0
    """Angle to that direction at which the robot file has it, which `Reference.yaw` holds [rad]."""


@dataclass(frozen=True, eq=False)
class Reference:
    """Measured poses; arrays of shape (m,), NaN where not measured."""

    time: Floats
    """Stamps on the ticks' clock, finite [s]."""
    x: Floats
    """[m]"""
    y: Floats
    """[m]"""
    yaw: Floats
    """Wrapped or not, as recorded [rad]."""
    sigma_xy: Floats | None = None
    """Standard deviation of x and of y, if stated [m]."""
    sigma_yaw: Floats | None = None
    """Standard deviation of yaw, if stated [rad]."""
    kind: ReferenceKind | None = field(default=None, kw_only=True)
    """Kind of its noise; None if unknown to the reader."""
    own_axes: bool = field(default=False, kw_only=True)
    """The coordinate frame differs between drives, and between segments after a cut (scans without
    a map): drives have no common direction or position on the floor."""
    mount: Mount | None = field(default=None, kw_only=True)
    """Where a transform places the sensor, if these are the base's poses freed of that."""
    walked: Floats | None = field(default=None, kw_only=True)
    """Variances of a coordinate and of yaw that the map of the last metres has walked by each pose
    of scans, shape (m, 2) [m², rad²]; what matters is their growth."""
    covariance: Floats | None = field(default=None, kw_only=True)
    """Covariances of x, y and yaw, if they are stated by direction, shape (m, 3, 3); `sigma_xy` is
    then that of the wider direction."""
    gyro: GyroTurn | None = field(default=None, kw_only=True)
    """Given if `yaw` is that of a gyro, aligned with another reference."""
    stamped_together: bool = field(default=False, kw_only=True)
    """Its stamps are delayed together with those of the wheels; see
    `inference.legs.even_stamps`."""
    one_rate: bool = field(default=False, kw_only=True)
    """By when the recorder received its messages and the wheels', neither clock gains on the other;
    see `files.clocks.of_one_rate`."""

    @property
    def has_position(self) -> NDArray[np.bool_]:
        """Where x and y were measured."""
        return np.isfinite(self.x) & np.isfinite(self.y)

    @property
    def has_yaw(self) -> NDArray[np.bool_]:
        """Where yaw was measured."""
        return np.isfinite(self.yaw)

    @property
    def by_course(self) -> bool:
        """Whether headings are a gyro's, laid upon the direction of the positions' path."""
        return self.gyro is not None and self.gyro.by_course

    def earlier(self, delay: float) -> Reference:
        """The same with stamps that are free of a delay [s]."""
        if delay == 0.0:
            return self
        gyro = None if self.gyro is None else self.gyro._replace(time=self.gyro.time - delay)
        return replace(self, time=self.time - delay, gyro=gyro)

    def turns(self) -> Reference:
        """What shows its turns, as often as they were measured: the gyro's own headings, if any."""
        if self.gyro is None:
            return self
        nothing = np.full(self.gyro.time.size, np.nan)
        return Reference(self.gyro.time, nothing, nothing, self.gyro.yaw)

    def chosen(self, which: NDArray[np.bool_] | NDArray[np.intp]) -> Reference:
        """Select poses; `which` has shape (m,), or is of rows."""
        names = ("time", "x", "y", "yaw", "sigma_xy", "sigma_yaw", "walked", "covariance")
        known = {name: values for name in names if (values := getattr(self, name)) is not None}
        gyro = None if self.gyro is None else self.gyro._replace(turned=self.gyro.turned[which])
        return replace(self, gyro=gyro, **{name: each[which] for name, each in known.items()})


Why = Literal["held", "carried", "gap", "counter", "reference"]
"""held: wheels turn, the robot does not; carried: the robot moves, its wheels do not; gap:
reference or ticks are silent during driving; counter: it jumped; reference: it jumped."""


class NoDriving(NamedTuple):
    """A stretch of a run that is not driving."""

    begin: float
    """On the run's own clock [s]."""
    end: float
    why: Why
    words: str
    """Description, as the end of a sentence: the wheels turned and ..."""


@dataclass(frozen=True, eq=False)
class Run:
    """One recorded drive."""

    name: str
    """Last part of the path."""
    path: Path
    ticks: Ticks
    reference: Reference | None = None
    notes: tuple[str, ...] = ()
    """Choices and omissions of the reader, in words for the user."""
    damage: tuple[str, ...] = ()
    """Damage of the record that was worked around, in words for the user."""
    no_reference: str = ""
    """Without a reference: what could be one, and what the record contains."""
    circle: str = ""
    """If the reference is computed from the wheels, by name and frames: what it is, why, and the
    alternatives."""
    wheels_from: Gives = "counts"
    """What the counts are worked out from."""
    held_poses: int = 0
    """Number of reference poses removed by `held_poses.without_held_poses`."""
    no_driving: tuple[NoDriving, ...] | None = None
    """Stretches that are not driving; None if not yet determined."""
    at_rest: tuple[float, float, float] | None = None
    """Of a gyro: how its heading turns while the wheels stand, the standard deviation of that, and
    what was taken off already [rad/s], by all rests of the drive that this may be a part of; None
    if there are none."""
    clock_rate: float = 0.0
    """What the reference's clock gains on the wheels', where that is much, in a second."""
    taken_out: tuple[tuple[float, float], ...] = ()
    """Stretches of the reference that are excluded on purpose, start and end in its stamps [s]:
    legs end there, and start again."""
    put_aside: tuple[tuple[float, float], ...] = ()
    """Those of them that another part of the run has, for judging."""
    of_bag: bool = False
    """Whether it was read from the messages of a bag, and not from columns."""
    happened: tuple[tuple[float, float], ...] = ()
    """Stretches in which the robot or the reference was displaced at once, start and end in the
    stamps of the reference [s]: an event, which no model explains. Legs continue through it, and
    their errors are not evaluated."""


def by_hand(parts: Iterable[NoDriving] | None) -> list[NoDriving]:
    """The stretches in which the robot was held or carried; None if they were not looked for."""
    return [part for part in parts or () if part.why in ("held", "carried")]


class Collected(NamedTuple):
    """A reference from the messages of one topic."""

    reference: Reference
    told: str
    """Its frames or content, in words."""
    damage: tuple[str, ...] = ()
    """See `Run.damage`."""
    taken_out: tuple[tuple[float, float], ...] = ()
    """See `Run.taken_out`."""


def counts_of(values: Floats) -> Counts:
    """Counts as int64 if all are integers that a float64 represents exactly, else NaN for inf."""
    exact = np.abs(values) < EXACT
    if exact.all() and (values == np.rint(values)).all():
        return values.astype(np.int64)
    return np.where(np.isfinite(values), values, np.nan)
