# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Runs laid end to end: one array for the steps of all of them, one for their legs.

Effects work row by row, and legs know only their own start and end; so a session of many drives
costs what one long drive would, and not a round of numpy calls for each.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, field, fields
from functools import partial
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.legs.cutting import MatchedRun, delayed, joined
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.drive_of_run import QUANTITIES, DriveOfRun, with_wheels_of_messages
from werrimbi_odom.model.driving import features
from werrimbi_odom.model.effect import wiring_of
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.wiring import Wiring

MODELS = 8
"""Of which it is remembered what was worked out: a fit comes back to a few only."""
DELAYS = 4
"""The same of shifts of the reference's clock: a fit moves one either way, and then on."""
DRIVES = 2
"""Of which it is remembered what effects may look at: twenty numbers for each step."""
Found = TypeVar("Found")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Concatenated:
    """Several matched runs on common arrays: n steps, m legs."""

    runs: tuple[MatchedRun, ...]
    steps: NDArray[np.intp]
    """First step of each run, and the number of all steps; shape (runs + 1,)."""
    legs: NDArray[np.intp]
    """First leg of each run, and the number of all legs; shape (runs + 1,)."""
    begin: NDArray[np.intp]
    """First step of each leg, shape (m,)."""
    end: NDArray[np.intp]
    """One past the last step of each leg, shape (m,)."""
    run_of_leg: NDArray[np.intp]
    start: Floats
    """Measured pose at each leg's start, (m, 3); NaN where not measured."""
    finish: Floats
    """Measured pose at each leg's end, (m, 3)."""
    intervals: Floats
    """Reference intervals in each leg, shape (m,)."""
    duration: Floats
    """Of each leg, shape (m,) [s]."""
    gap: NDArray[np.bool_]
    """Legs that are none, for they hold something that is left out; shape (m,)."""
    stepped: NDArray[np.bool_]
    """Legs in which something happened at once (an event), which may end anywhere; shape (m,)."""
    finer: Concatenated | None = None
    """The same nodes in shorter legs, of which these are joined."""
    _features: dict[tuple[float, ...], Drive[Floats]] = field(default_factory=dict)
    _delayed: dict[float, Concatenated] = field(default_factory=dict)
    _known: dict[Hashable, Any] = field(default_factory=dict)
    _of_models: list[tuple[object, dict[Hashable, Any]]] = field(default_factory=list)
    _of_steps: list[tuple[object, dict[Hashable, Any]]] = field(default_factory=list)
    _latest: list[tuple[tuple[object, ...], Any]] = field(default_factory=list)

    def __reduce__(self) -> tuple[Any, ...]:
        """For another process: without what is remembered, some of it by laws (functions)."""
        own = {
            item.name: getattr(self, item.name)
            for item in fields(self)
            if not item.name.startswith("_")
        }
        return partial(Concatenated, **own), ()

    @property
    def count(self) -> int:
        """Number of legs."""
        return self.begin.size

    @property
    def data(self) -> int:
        """Number of measured coordinates at the ends of legs that count."""
        return int(np.isfinite(self.finish[~self.gap]).sum())

    @property
    def headings_alone(self) -> bool:
        """Whether the references measure headings and nothing else: gyros, mostly."""
        return not np.isfinite(self.finish[:, :2]).any()

    @property
    def stamps_err(self) -> bool:
        """Whether the stamps' noise is told apart: of gyros, and of scans.

        Matches say how well each scan was seen, and nothing of when.
        """
        return self.headings_alone or self.own_axes

    @property
    def headings_laid(self) -> bool:
        """Whether headings are a gyro's that were laid upon those of a localiser."""
        return any(run.measured.gyro is not None for run in self.runs)

    @property
    def own_axes(self) -> bool:
        """Whether references begin with axes of their own, so that no direction is common."""
        return any(run.measured.own_axes for run in self.runs)

    @property
    def shares(self) -> Floats | None:
        """Variances of place and heading that scans state at each leg's end, (m, 2).

        Over the largest that is usual in a drive, which counts for all (`with_stated_noise`). None
        where it is not stated of all.
        """
        found = []
        for name in ("sigma_xy", "sigma_yaw"):
            stated = [getattr(run.measured, name) for run in self.runs]
            usual = [getattr(run, name) for run in self.runs]
            if any(sigma is None for sigma in stated):
                return None
            found.append(np.concatenate([sigma[1:] for sigma in stated]) / max(usual))
        return np.stack(found, axis=-1) ** 2

    @property
    def run_of_step(self) -> NDArray[np.intp]:
        """Index of the run of each step, shape (n,)."""
        return np.repeat(np.arange(len(self.runs)), np.diff(self.steps))

    @property
    def ends_at(self) -> Floats:
        """Stamp of the pose at each leg's end, shape (m,) [s]."""
        return np.concatenate([run.measured.time[1:] for run in self.runs])

    @property
    def inside(self) -> NDArray[np.intp]:
        """Steps that belong to a leg."""
        both = zip(self.runs, self.steps, strict=False)
        return np.concatenate([np.arange(run.ends[0], run.ends[-1]) + first for run, first in both])

    def per_leg(self, values: Floats) -> Floats:
        """Sums over the steps of each leg of values for all steps."""
        sums = np.concatenate([[0.0], np.cumsum(values)])
        return np.asarray(sums[self.end] - sums[self.begin])

    def delayed(self, delay: float) -> Concatenated:
        """The same legs, when the reference saw at t - `delay` [s] what it stamps t."""
        if all(delay == run.delay for run in self.runs):
            return self
        known = self._delayed.get(delay)
        if known is None and self.finer is not None:
            finer = self.finer.delayed(delay)
            runs = zip(finer.runs, self.runs, strict=True)
            known = concatenated([joined(fine, run.rows) for fine, run in runs], finer)
        elif known is None:
            known = concatenated([delayed(run, delay) for run in self.runs])
        _remember(self._delayed, delay, known, DELAYS)
        return known

    def known(self, key: Hashable, work: Callable[[Concatenated], Found]) -> Found:
        """What `work` makes of the runs, worked out once for a key."""
        found: Found | None = self._known.get(key)
        if found is None:
            found = work(self)
            _remember(self._known, key, found)
        return found

    def of_model(self, model: object, key: Hashable, work: Callable[[], Found]) -> Found:
        """What `work` finds of a model by its legs, worked out once for the last few models."""
        return _recalled(self._of_models, model, key, work, MODELS)

    def of_steps(self, model: object, key: Hashable, work: Callable[[], Found]) -> Found:
        """The same of what is as long as the steps, for the last model alone."""
        return _recalled(self._of_steps, model, key, work, 1)

    def latest(self, of: tuple[object, ...], work: Callable[[], Found]) -> Found:
        """What `work` finds, unless it was found the last time, of the very same objects."""
        if not self._latest or any(
            one is not other for one, other in zip(self._latest[0][0], of, strict=True)
        ):
            self._latest[:] = [(of, work())]
        value: Found = self._latest[0][1]
        return value

    def parts(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """First leg of `finer` in each leg, and one past the last; shape (m,) each."""
        assert self.finer is not None
        runs = zip(self.finer.runs, self.runs, self.finer.legs, strict=False)
        nodes = [np.searchsorted(fine.rows, run.rows) + first for fine, run, first in runs]
        begin, end = ([part[which] for part in nodes] for which in (slice(-1), slice(1, None)))
        return np.concatenate(begin), np.concatenate(end)

    def raw(self, robot: Robot) -> WheelTravel[Floats]:
        """Travel of all steps before any effect."""
        left, right = wiring_of(robot.effects).wheels(*self.known("counts", _counts))
        return WheelTravel(left * robot.left_tick, right * robot.right_tick)

    def drive(self, robot: Robot) -> Drive[Floats]:
        """What effects may look at, over the steps of all runs."""
        wiring = wiring_of(robot.effects)
        key = (*wiring, robot.left_tick, robot.right_tick, robot.track)
        known = self._features.get(key)
        if known is None:
            of_steps = zip(self.runs, self.known("messages", _messages), strict=True)
            known = _drives_joined([_drive_of(run, its, robot, wiring) for run, its in of_steps])
            _remember(self._features, key, known, DRIVES)
        return known


def concatenated(runs: Sequence[MatchedRun], finer: Concatenated | None = None) -> Concatenated:
    """Lay runs end to end.

    Parameters
    ----------
    finer : Concatenated, optional
        The runs of which these are `joined`.
    """
    steps = _starts([run.time.size - 1 for run in runs])
    legs = _starts([run.legs for run in runs])
    poses = [np.stack([run.measured.x, run.measured.y, run.measured.yaw], axis=-1) for run in runs]
    return Concatenated(
        runs=tuple(runs),
        steps=steps,
        legs=legs,
        begin=np.concatenate(
            [run.ends[:-1] + first for run, first in zip(runs, steps, strict=False)]
        ),
        end=np.concatenate([run.ends[1:] + first for run, first in zip(runs, steps, strict=False)]),
        run_of_leg=np.repeat(np.arange(len(runs)), np.diff(legs)),
        start=np.concatenate([pose[:-1] for pose in poses]),
        finish=np.concatenate([pose[1:] for pose in poses]),
        intervals=np.concatenate([run.intervals for run in runs]),
        duration=np.concatenate([np.diff(run.time[run.ends]) for run in runs]),
        gap=np.concatenate([run.gap for run in runs]),
        stepped=np.concatenate([run.stepped for run in runs]),
        finer=finer,
        _features={} if finer is None else finer._features,  # they are of steps, which are the same
    )


def laid_out(runs: Sequence[MatchedRun] | Concatenated) -> Concatenated:
    """Runs laid end to end, if they are not yet."""
    return runs if isinstance(runs, Concatenated) else concatenated(runs)


def _messages(runs: Concatenated) -> list[NDArray[np.intp]]:
    """The message that each step is a part of, numbered from 0 on in each run."""
    middles = [(run, 0.5 * (run.time[1:] + run.time[:-1])) for run in runs.runs]
    return [
        np.unique(run.counters.message_at(middle), return_inverse=True)[1]
        for run, middle in middles
    ]


def _drive_of(
    run: MatchedRun, message: NDArray[np.intp], robot: Robot, wiring: Wiring
) -> DriveOfRun:
    left, right = wiring.wheels(run.left, run.right)
    first_counts = wiring.wheels(run.counters.first_left, run.counters.first_right)
    raw = WheelTravel(left * robot.left_tick, right * robot.right_tick)
    drive = features(robot, np.diff(run.time), raw, first_counts, run.channels)
    return with_wheels_of_messages(drive, message)


def _drives_joined(parts: Sequence[DriveOfRun]) -> DriveOfRun:
    """Drives laid end to end."""
    if len(parts) == 1:
        return parts[0]

    def joined(name: str) -> Any:
        return _joined([part.found(name) for part in parts])

    return DriveOfRun.by({name: partial(joined, name) for name in QUANTITIES})


def _recalled(
    memory: list[tuple[object, dict[Hashable, Any]]],
    model: object,
    key: Hashable,
    work: Callable[[], Found],
    most: int,
) -> Found:
    found = next((found for known, found in memory if known == model), None)
    if found is None:
        found = {}
        memory.append((model, found))
        del memory[:-most]
    if key not in found:
        found[key] = work()
    value: Found = found[key]
    return value


def _counts(runs: Concatenated) -> WheelTravel[Floats]:
    """Of both wheels in all steps."""
    counts: WheelTravel[Floats] = _joined([WheelTravel(run.left, run.right) for run in runs.runs])
    return counts


def _starts(sizes: Sequence[int]) -> NDArray[np.intp]:
    return np.concatenate([[0], np.cumsum(sizes)]).astype(np.intp)


def _remember(memory: dict[Any, Any], key: Any, value: Any, most: int = MODELS) -> None:
    """Put it in as the latest; what was not asked for the longest is forgotten."""
    memory.pop(key, None)
    while len(memory) >= most:
        del memory[next(iter(memory))]
    memory[key] = value


def _joined(parts: Sequence[Any]) -> Any:
    """Values of one kind, their arrays laid end to end."""
    first = parts[0]
    if len(parts) == 1:
        return first
    if isinstance(first, np.ndarray):
        return np.concatenate(parts)
    if isinstance(first, tuple):
        return type(first)(*(_joined(list(column)) for column in zip(*parts, strict=True)))
    common = [name for name in first if all(name in part for part in parts)]
    return {name: _joined([part[name] for part in parts]) for name in common}
