# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Encoder counts, at the messages and interpolated between them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.counter_jumps import CounterJump, bridged
from werrimbi_odom.inference.legs.even_stamps import with_even_stamps
from werrimbi_odom.inference.legs.monotone_cubic import between_messages, interval_of, missed_at
from werrimbi_odom.inference.legs.queued_messages import last_of_packets
from werrimbi_odom.inference.legs.uneven_timer import with_uneven_timer
from werrimbi_odom.model.drive import Span
from werrimbi_odom.model.effect import wiring_of
from werrimbi_odom.model.encoder_online import Counts, EncoderLimits
from werrimbi_odom.model.encoder_recorded import wheel_steps
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

ROUNDING = 1e-3
"""Relative tolerance of the usual interval, for stamps in whole microseconds."""


@dataclass(frozen=True)
class Counters:
    """Encoder counts up to each accepted message; arrays of shape (k,)."""

    time: Floats
    """[s]"""
    left: Floats
    """Counts since the first message."""
    right: Floats
    first_left: float
    """Raw counter value at the first message."""
    first_right: float
    channels: Mapping[str, Floats] = field(default_factory=dict)
    """Extra measured channels at each message."""
    every: int = 1
    """Messages per node."""
    leaps: tuple[tuple[float, float, str], ...] = ()
    """Counter jumps: begin and end [s], and a description."""
    restamped: float = 0.0
    """Correction of the stamps, rms [s] (`even_stamps`)."""

    def at_most(self, rate: float) -> Counters:
        """Thin the nodes to the lowest rate that is at least `rate` [Hz].

        Counts and times of all messages remain known.
        """
        return replace(self, every=max(1, int(1.0 / (rate * self.interval) + ROUNDING)))

    def at(self, time: Floats) -> Floats:
        """Counts at any times, (n, 2): left and right; see `between_messages`."""
        return between_messages(time, self.time, self.left, self.right)

    def travel(self, robot: Robot, time: Floats) -> Floats:
        """Travel of both wheels between any times (n,), as the file wires them, (2, n - 1) [m]."""
        return _travel(robot, np.diff(self.at(time), axis=0).T)

    def rounding_at(self, time: Floats) -> Floats:
        """Variance of the counts' rounding at any times, relative to that at a message; (n,).

        Between two messages both have their weights in `between_messages`, and what they round off
        is partly made up for.
        """
        _, _, share = interval_of(time, self.time)
        weight = share * share * (3.0 - 2.0 * share)
        return np.asarray(1.0 - 2.0 * rules.ROUNDING_SHARED * weight * (1.0 - weight))

    @cached_property
    def interval(self) -> float:
        """Usual time between two messages [s]."""
        return float(np.median(np.diff(self.time)))

    @property
    def are_rare(self) -> bool:
        """Whether wheels change their speed much from one message to the next."""
        return self.interval > rules.RARE_COUNTS

    @property
    def within(self) -> Floats:
        """Times between rare messages, at which steps end too; none where they are not rare.

        A wheel that gains speed within a step of both turns the path elsewhere than an arc does:
        by a curve of the robot's sideways errors over its acceleration, which no robot has.
        """
        if not self.are_rare:
            return np.zeros(0)
        parts = math.ceil(self.interval / rules.RARE_COUNTS) + 1
        last = self.time.size - 1
        row = np.arange(last * parts + 1) / parts
        return np.interp(row, np.arange(last + 1), self.time)

    def unseen_at(self, time: Floats) -> Floats:
        """Standard deviation of the counts between messages that are rare, at any times, (n, 2).

        Wheels that change their speed within an interval are elsewhere than interpolation has them.
        How much it misses is seen at the messages: each is interpolated between its neighbours.
        With intervals half as long, half of that is missed (`UNSEEN_OF_LEFT_OUT`). Rounding misses
        a count at the most. Zero where messages are not rare.
        """
        if not self.are_rare:
            return np.zeros((time.size, 2))
        before, _, share = interval_of(time, self.time)
        missed = np.stack([missed_at(self.time, side) for side in (self.left, self.right)], axis=-1)
        missed = np.maximum(missed - 1.0, 0.0)
        most = np.maximum(missed[before], missed[before + 1])
        return np.asarray(rules.UNSEEN_OF_LEFT_OUT * 4.0 * (share * (1.0 - share))[:, None] * most)

    @property
    def nodes(self) -> NDArray[np.intp]:
        """Indices of the messages that are nodes: every `every`-th one, and the last."""
        last = self.time.size - 1
        return np.append(np.arange(0, last, self.every), last)

    def message_at(self, time: Floats) -> NDArray[np.intp]:
        """Index of the first node at or after some instants; of the last for any after it."""
        return np.minimum(np.searchsorted(self.time[self.nodes], time), self.nodes.size - 1)

    @property
    def are_coarse(self) -> bool:
        """Whether a counter brings few counts at a time to the nodes."""
        return self._bring_at_most(rules.FEW_COUNTS)

    def _bring_at_most(self, few: float) -> bool:
        return any(_steps_seen(side[self.nodes], few) for side in (self.left, self.right))

    @property
    def rates(self) -> Floats | None:
        """Counts per second of both wheels up to each node, between the steps of coarse counters.

        Shape (2, nodes), moving averages. None where a message brings enough (`COUNTS_A_SPEED`). As
        a count comes the wheel seems fast, and is as far as it says; before the next it is farther.
        So the speeds of single messages tell how far a wheel is beyond its count, and a law of them
        seems true.
        """
        if not self._bring_at_most(rules.COUNTS_A_SPEED):
            return None
        time = self.time[self.nodes]
        sides = [_without_steps(time, side[self.nodes]) for side in (self.left, self.right)]
        rates = np.diff(sides) / np.diff(time)
        rates = uniform_filter1d(rates, rules.MESSAGES_A_SPEED, axis=1, mode="nearest")
        return np.concatenate([rates[:, :1], rates], axis=1)

    def between_counts(self) -> Counters:
        """With coarse counters going evenly between the middles of their steps."""
        left, right = (_without_steps(self.time, side) for side in (self.left, self.right))
        return replace(self, left=left, right=right)

    def way(self, robot: Robot, leg: float, turn: float) -> Floats:
        """Cumulative travel at each message, in legs: path / `leg` [m] + turning / `turn`.

        Legs that ended where a coarse counter steps would all end just behind a count, and the
        quantisation would be no noise but an offset.
        """
        even = self.between_counts()
        left, right = _travel(robot, np.diff([even.left, even.right]))
        path = np.abs(0.5 * (left + right)) / leg
        turned = np.abs(right - left) / robot.track / turn
        return summed(path + turned)


def counters_of(run: Run, robot: Robot, limits: EncoderLimits | None) -> Counters:
    """Counters of a run, without the rows that the encoder model rejects.

    Parts of a run share one computation. InputError if fewer than two rows are usable, or the clock
    was set back.
    """
    together = run.reference is not None and run.reference.stamped_together
    least = rules.EVEN_LEAST_TOGETHER if together else rules.EVEN_LEAST
    return run.ticks.latest((robot, limits, least), lambda: _counted(run, robot, limits, least))


def _counted(run: Run, robot: Robot, limits: EncoderLimits | None, least: float) -> Counters:
    ticks = run.ticks
    sent = last_of_packets(ticks.time)
    stamps, counted = ticks.time[sent], (ticks.left[sent], ticks.right[sent])
    read = with_even_stamps(stamps, *counted, least=least)
    if read is not stamps and not any(_steps_seen(side, rules.FEW_COUNTS) for side in counted):
        read = with_uneven_timer(read, *counted)
    steps = wheel_steps(robot, read, *counted, limits)
    if steps.first_row < 0 or steps.time.size == 0:
        raise InputError(f"{run.path}: fewer than two usable rows of ticks")
    time = np.concatenate([read[[steps.first_row]], steps.time])
    if not (np.diff(time) > 0.0).all():
        raise InputError(
            f"{run.path}: the ticks' clock was set back in mid-run; cut the run there into two"
        )
    per_turn = robot.left_ticks_per_revolution, robot.right_ticks_per_revolution
    left, right = steps.left / robot.left_tick, steps.right / robot.right_tick
    reset = (steps.left_lost > 0.0) | (steps.right_lost > 0.0)
    found = bridged(time, left / per_turn[0], right / per_turn[1], reset)
    leaps = _told(found.leaps, time, robot)
    rows = np.concatenate([[steps.first_row], steps.row])
    if leaps:
        kept = found.kept
        left, right = found.left[kept] * per_turn[0], found.right[kept] * per_turn[1]
        kept = np.concatenate([[True], kept])
        time, rows = time[kept], rows[kept]
    return Counters(
        time,
        summed(left),
        summed(right),
        float(counted[0][steps.first_row]),
        float(counted[1][steps.first_row]),
        {name: np.asarray(values)[sent[rows]] for name, values in ticks.channels.items()},
        leaps=leaps,
        restamped=float(np.std(read - stamps)) if read is not stamps else 0.0,
    )


def _told(
    leaps: Sequence[CounterJump], time: Floats, robot: Robot
) -> tuple[tuple[float, float, str], ...]:
    """Describe counter jumps: begin and end [s], and a sentence."""
    found = []
    for leap in leaps:
        tick, per_turn = (
            (robot.left_tick, robot.left_ticks_per_revolution)
            if leap.left
            else (robot.right_tick, robot.right_ticks_per_revolution)
        )
        size = leap.turns * tick * per_turn
        words = (
            f"the {'left' if leap.left else 'right'} counter leapt by {size:.3g} m"
            f"{' and came back' if leap.back else ''}, faster than its wheel turns"
            if leap.turns
            else "a counter fell to zero, as where a driver starts anew"
        )
        found.append((float(time[leap.first]), float(time[leap.last + 1]), words))
    return tuple(found)


def nodes_at(
    counters: Counters, at: Floats
) -> tuple[Floats, Floats, Floats, NDArray[np.intp], Mapping[str, Span[Floats]]]:
    """Nodes at the counters' messages, within rare ones, and at the ascending times `at` (n,).

    Result: times of the nodes (k + 1,), counts between them
    (k,) and (k,), node indices of `at` (n,), and values of the other channels at the start and end
    of each step.
    """
    kept = counters.nodes
    known, left, right = (part[kept] for part in (counters.time, counters.left, counters.right))
    place = np.searchsorted(known, at)
    new = np.unique(at[known[np.minimum(place, known.size - 1)] != at])
    if counters.are_rare:
        new = np.setdiff1d(np.concatenate([new, counters.within]), known)
    if new.size == 0:
        time, left, right = known, np.diff(left), np.diff(right)
    else:
        here = np.searchsorted(known, new) + np.arange(new.size)
        between = counters.at(new)
        time = _with(known, new, here)
        left = np.diff(_with(left, between[:, 0], here))
        right = np.diff(_with(right, between[:, 1], here))
    channels = {}
    for name, values in counters.channels.items():
        measured = np.isfinite(values)
        if measured.any():
            there = np.interp(time, counters.time[measured], values[measured])
            channels[name] = Span(there[:-1], there[1:])
    return time, left, right, np.searchsorted(time, at), channels


def _with(values: Floats, new: Floats, here: NDArray[np.intp]) -> Floats:
    """Insert `new` into `values` so that they end up at the indices `here`."""
    whole = np.empty(values.size + new.size)
    old = np.ones(whole.size, dtype=np.bool_)
    old[here] = False
    whole[old], whole[here] = values, new
    return whole


def _travel(robot: Robot, counts: Floats) -> Floats:
    """Travel of both wheels [m] by the steps of their counters, (2, n)."""
    left, right = wiring_of(robot.effects).wheels(*counts)
    return np.stack([left * robot.left_tick, right * robot.right_tick])


def _steps_seen(counts: Counts, few: float) -> bool:
    """Whether so few counts come at once, as a rule."""
    change = np.abs(np.diff(counts))
    return bool(change.any()) and float(np.median(change[change > 0.0])) <= few


def _without_steps(time: Floats, counts: Floats) -> Floats:
    """Counts of a coarse counter between the middles of its steps; others as they are."""
    if not _steps_seen(counts, rules.FEW_COUNTS):
        return counts
    stepped = np.flatnonzero(np.diff(counts))
    middle, level = (0.5 * (each[stepped] + each[stepped + 1]) for each in (time, counts))
    return np.asarray(np.interp(time, middle, level, left=counts[0], right=counts[-1]))


def summed(steps: Floats) -> Floats:
    """Cumulative sum with a leading zero."""
    return np.concatenate([[0.0], np.cumsum(steps)])
