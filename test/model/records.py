# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Records with everything that happens to real counters, for hypothesis."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from hypothesis import strategies as st

from test.model.drives import Ticks
from werrimbi_odom.model.encoder_online import EncoderLimits
from werrimbi_odom.model.robot import Robot

PERIOD = 0.02


class Record(NamedTuple):
    robot: Robot
    limits: EncoderLimits
    ticks: Ticks


@st.composite
def drives(draw: st.DrawFn) -> tuple[np.ndarray, np.ndarray]:
    """Cumulative counts of lines, arcs, spins, pivots, rests and reversals; with some flicker."""
    speed = st.integers(-40, 40)
    stretch = st.tuples(st.sampled_from(["line", "spin", "any", "rest"]), speed, speed)
    steps: list[np.ndarray] = []
    for kind, left, right in draw(st.lists(stretch, min_size=1, max_size=8)):
        pair = {"line": (left, left), "spin": (-left, left), "any": (left, right)}
        steps += [np.array(pair.get(kind, (0, 0)))] * draw(st.integers(1, 60))
    counts = np.cumsum(np.array([(0, 0), *steps]), axis=0)
    if draw(st.booleans()):
        flicker = np.random.default_rng(draw(st.integers(0, 99)))
        counts += flicker.integers(0, 2, counts.shape)
    offset = draw(st.tuples(*2 * [st.integers(-(2**31), 2**31) | st.just(0)]))
    return counts[:, 0] + offset[0], counts[:, 1] + offset[1]


Fault = Callable[[np.ndarray, np.ndarray, np.ndarray, int], None]


def late(time: np.ndarray, left: np.ndarray, right: np.ndarray, at: int) -> None:
    time[at] -= 3.5 * PERIOD


def twice(time: np.ndarray, left: np.ndarray, right: np.ndarray, at: int) -> None:
    if at:
        time[at], left[at], right[at] = time[at - 1], left[at - 1], right[at - 1]


def clock_set_back(time: np.ndarray, left: np.ndarray, right: np.ndarray, at: int) -> None:
    time[at:] -= 1000.0


def gap(time: np.ndarray, left: np.ndarray, right: np.ndarray, at: int) -> None:
    time[at:] += 10.0


def reset(time: np.ndarray, left: np.ndarray, right: np.ndarray, at: int) -> None:
    left[at:] -= left[at]
    right[at:] -= right[at]


def one_reset(time: np.ndarray, left: np.ndarray, right: np.ndarray, at: int) -> None:
    right[at:] -= right[at] - 3


def glitch(time: np.ndarray, left: np.ndarray, right: np.ndarray, at: int) -> None:
    left[at] += 1_000_000


def jump(time: np.ndarray, left: np.ndarray, right: np.ndarray, at: int) -> None:
    right[at:] -= 1_000_000


def no_number(time: np.ndarray, left: np.ndarray, right: np.ndarray, at: int) -> None:
    (time if left.dtype.kind == "i" else left)[at] = np.nan


def no_end(time: np.ndarray, left: np.ndarray, right: np.ndarray, at: int) -> None:
    (time if right.dtype.kind == "i" else right)[at] = -np.inf


FAULTS: tuple[Fault, ...] = (
    late,
    twice,
    clock_set_back,
    gap,
    reset,
    one_reset,
    glitch,
    jump,
    no_number,
    no_end,
)


def as_read(counts: np.ndarray, bits: int) -> np.ndarray:
    """What a signed counter of so many bits shows."""
    if bits == 0:
        return counts
    return ((counts + (1 << (bits - 1))) & ((1 << bits) - 1)) - (1 << (bits - 1))


@st.composite
def records(draw: st.DrawFn, faults: bool = True) -> Record:
    """A drive as a driver publishes it, with some faults."""
    bits = draw(st.sampled_from([0, 0, 8, 16, 32]))
    robot = Robot(
        0.35,
        0.05,
        draw(st.sampled_from([500.0, 2000.0])),
        2000.0,
        encoder_bits=bits,
    )
    left, right = (as_read(counts, bits) for counts in draw(drives()))
    if draw(st.booleans()):  # positions as floats, as joint states carry them
        left, right = 0.25 + left, 0.5 + right
    time = 1.7e9 + PERIOD * np.arange(left.size)
    chosen = draw(st.lists(st.sampled_from(FAULTS), max_size=6)) if faults else []
    with np.errstate(invalid="ignore"):
        for fault in chosen:
            fault(time, left, right, draw(st.integers(0, left.size - 1)))
    limits = EncoderLimits(max_wheel_speed=draw(st.sampled_from([0.0, 0.8])))
    return Record(robot, limits, Ticks(time, left, right))
