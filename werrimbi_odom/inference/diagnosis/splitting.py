# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Splitting of the drives into a fitted and a held-out part, where no held-out drives are given."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.inference import rules

Runs = tuple[Run, ...]


def set_aside(runs: Sequence[Run]) -> tuple[Runs, Runs]:
    """Split into the fitted and the held-out part: a quarter of every drive is held out.

    Two stretches of each drive's reference are held out, at other places in every drive, so that
    all kinds of motion are on both sides. The counters run on through them, so that the memory of
    an effect (a wheel's angle, the travel since a reversal, the distance) is the same on both. Of
    the drives that have too few poses for that, a quarter is held out whole; of a single such
    drive, the last quarter of its poses.
    """
    poses = [poses_of(run) for run in runs]
    few = [number for number, count in enumerate(poses) if count < rules.SET_ASIDE_ROWS]
    if len(runs) > 1 or not few:
        whole = _held_whole(few, poses)
        fitted: list[Run] = []
        held: list[Run] = []
        for number, run in enumerate(runs):
            if number in few:
                (held if number in whole else fitted).append(run)
                continue
            kept, other = _parted(run, number)
            fitted.append(kept)
            held.append(other)
        return tuple(fitted), tuple(held)
    (run,) = runs
    time = run.ticks.time if run.reference is None else run.reference.time[_measured(run.reference)]
    share = 1.0 - len(rules.SET_ASIDE) / rules.SET_ASIDE_BLOCKS
    at = float(np.quantile(time, share)) if time.size else np.inf
    return (_between(run, -np.inf, at),), (_between(run, at, np.inf),)


def _held_whole(few: Sequence[int], poses: Sequence[int]) -> set[int]:
    """Indices of the drives that are held out whole, of the `few` that have few poses.

    They are evenly spaced among them as given. Where these would have most of the poses, so that
    next to nothing were left to fit, they are so in the order of their numbers of poses.
    """
    count = held_of_few(len(few), least=1 if len(few) == len(poses) else 0)
    if count == 0:
        return set()
    every = len(few) / count
    chosen = {few[int((number + 0.5) * every)] for number in range(count)}
    if 2 * sum(poses[number] for number in chosen) > sum(poses[number] for number in few):
        rising = sorted(few, key=lambda number: poses[number])
        chosen = {rising[int((number + 0.5) * every - 0.5)] for number in range(count)}
    return chosen


def held_of_few(drives: int, least: int = 1) -> int:
    """How many of so many drives with few poses are held out whole."""
    return max(least, round(drives * len(rules.SET_ASIDE) / rules.SET_ASIDE_BLOCKS))


def poses_of(run: Run) -> int:
    """Number of poses of a drive that were measured, in position or in heading."""
    if run.reference is None:
        return 0
    return int(_measured(run.reference).sum())


def _measured(reference: Reference) -> np.ndarray:
    return np.asarray(reference.has_position | reference.has_yaw)


def _parted(run: Run, number: int) -> tuple[Run, Run]:
    """A run without its held-out stretches, and the run with only these."""
    reference = run.reference
    assert reference is not None
    rows = np.arange(reference.time.size)
    block = rows * rules.SET_ASIDE_BLOCKS // rows.size
    held = np.isin(
        block, [(first + 3 * number) % rules.SET_ASIDE_BLOCKS for first in rules.SET_ASIDE]
    )
    return _without(run, reference, ~held), _without(run, reference, held)


def _without(run: Run, reference: Reference, kept: np.ndarray) -> Run:
    """The run with some rows of its reference; the gaps between them are marked as taken out."""
    edges = np.flatnonzero(np.diff(kept.astype(np.int8)))
    ends = [0, *(edges + 1).tolist(), kept.size]
    time = reference.time
    gone = tuple(
        (float(time[max(first - 1, 0)]), float(time[min(last, kept.size - 1)]))
        for first, last in itertools.pairwise(ends)
        if not kept[first]
    )
    taken_out = (*run.taken_out, *gone)
    return replace(run, reference=reference.chosen(kept), taken_out=taken_out, put_aside=gone)


def _between(run: Run, begin: float, end: float) -> Run:
    ticks, reference = run.ticks, run.reference
    which = (ticks.time >= begin) & (ticks.time < end)
    cut = replace(
        ticks,
        time=ticks.time[which],
        left=ticks.left[which],
        right=ticks.right[which],
        channels={name: values[which] for name, values in ticks.channels.items()},
    )
    if reference is not None:
        reference = reference.chosen((reference.time >= begin) & (reference.time < end))
    return replace(run, ticks=cut, reference=reference)
