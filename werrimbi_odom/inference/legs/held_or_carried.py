# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stretches without normal driving: wheels turn while the robot is held, or it moves without them.

They are found from wheels and reference alone, as outliers of the relation that most of the drive
follows (`agreement`). So no robot file, right or wrong, can create or hide such a stretch.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from werrimbi_odom.files.run import NoDriving, Reference
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.agreement import Agreement, agreement_of_turns
from werrimbi_odom.inference.legs.count_interpolation import Counters
from werrimbi_odom.inference.legs.displacement_agreement import agreement_of_displacements
from werrimbi_odom.inference.legs.gaps import as_stuck
from werrimbi_odom.inference.legs.measured_motion import MeasuredMotion, judged_motion, runs_of
from werrimbi_odom.inference.legs.motion_states import LOST, SLID
from werrimbi_odom.inference.legs.moved_in_silence import moved_in_silence
from werrimbi_odom.inference.legs.windows import Windows, windows_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

_GRID = 0.1  # grid on which held and carried are told apart [s]

HELD = "the wheels turned and the robot did not: held, or against a wall"
HELD_BACK = (
    "the wheels turned more than the robot: held back, or faster than the reference can follow"
)
CARRIED = "the robot moved and its wheels did not: carried, or pushed"
BY_HAND = "the robot moved otherwise than its wheels: lifted, or turned by hand"


def no_driving(counters: Counters, reference: Reference, robot: Robot) -> tuple[NoDriving, ...]:
    """Find stretches in which the robot was held or carried, in order."""
    seen: list[MeasuredMotion] = []
    turns = windows_of(counters, reference.turns(), robot, ways=False)
    by_turns = None if turns is None else agreement_of_turns(turns, robot.track)
    if by_turns is not None:
        slowest = rules.NO_DRIVING_TURNS * by_turns.windows.steps * by_turns.windows.step
        seen.append(judged_motion(by_turns, slowest, rules.NO_DRIVING_TURN, turns=True))
    ways = windows_of(counters, reference, robot, ways=True)
    by_ways = None if ways is None else agreement_of_displacements(ways, by_turns, robot.track)
    if by_ways is not None:
        rolling = by_ways.windows.rolled > by_ways.windows.still
        slowest = rules.NO_DRIVING_GOES * float(np.median(by_ways.gross[rolling]))
        seen.append(judged_motion(by_ways, slowest, rules.NO_DRIVING_WAY, turns=False))
    doubted = [_stretches(each) for each in seen]
    found = sorted(_reaching(stretch, seen) for each in doubted for stretch in each)
    if by_turns is not None:
        found = sorted(_while_slowed(stretch, by_turns) for stretch in found)
    parts = [part for each in _joined(found, seen) for part in _by_kind(*each, seen)]
    if by_turns is not None:
        slid = (part for part in parts if part.why == "held" and not _among(part, doubted[0]))
        parts = sorted({*parts} - {part for part in slid if _follows(part, by_turns)})
    if reference.walked is not None:  # scans: beside a bare wall they do not see the way
        by_heading = [] if by_turns is None else doubted[0]
        parts = [
            part._replace(words=SLID)
            if part.words == HELD and not _among(part, by_heading)
            else part
            for part in parts
        ]
    parts = _with_rests(parts, counters, robot)
    parts = [part if part.words == CARRIED else as_stuck(part, reference) for part in parts]
    if turns is not None and by_turns is None:  # to and fro on a line, carried in between
        parts = _with_others(parts, _turned_by_hand(turns, robot.track))
    parts = _with_others(parts, moved_in_silence(counters, reference, robot))
    if parts and not reference.has_yaw.any():
        parts = _with_what_follows(parts, counters)
    first, last = float(counters.time[0]), float(counters.time[-1])
    return tuple(
        part._replace(begin=max(part.begin, first), end=min(part.end, last)) for part in parts
    )


def _with_others(parts: Sequence[NoDriving], others: Sequence[NoDriving]) -> list[NoDriving]:
    """Add those of the others that are beside the parts, in order."""
    alone = (
        one for one in others if all(one.end < each.begin or one.begin > each.end for each in parts)
    )
    return sorted([*parts, *alone])


def _turned_by_hand(windows: Windows, track: float) -> list[NoDriving]:
    """Stretches with turns that the wheels cannot produce, where the drive fits no law of turns."""
    slowest = rules.NO_DRIVING_TURNS * windows.steps * windows.step
    could = (np.abs(windows.left) + np.abs(windows.right)) / track
    stands = windows.rolled <= windows.still
    turned = np.abs(windows.measured)
    sure = turned > np.maximum(slowest, np.where(stands, 0.0, rules.NO_DRIVING_MOST * could))
    half = 0.5 * windows.steps * windows.step
    last_of_all = float(windows.time[-1]) + half
    found: list[NoDriving] = []
    for first, last in runs_of(turned > np.maximum(slowest, could)):
        inside = slice(first, last + 1)
        if np.count_nonzero(sure[inside]) < windows.steps + rules.NO_DRIVING_MORE:
            continue
        begin, end = float(windows.time[first]) - half, float(windows.time[last]) + half
        by_hand = CARRIED if stands[inside].mean() > 0.5 else BY_HAND
        if by_hand == BY_HAND and last_of_all - end <= rules.NO_DRIVING_SILENT:
            end = last_of_all  # a lifted robot is not put down to drive for just a moment
        if found and begin - found[-1].end <= rules.NO_DRIVING_JOINED:
            begin = found.pop().begin
        found.append(NoDriving(begin, end, "carried", by_hand))
    return found


def _stretches(seen: MeasuredMotion) -> list[tuple[float, float]]:
    """Stretches [s] whose deviation stays above what driving explains for long enough."""
    windows, off = seen.agreement.windows, seen.agreement.off
    more = np.abs(windows.measured) > np.abs(seen.agreement.expected)
    surely = seen.beyond > 1.0
    found = []
    # A hand slows a robot unevenly: smaller deviations in between belong to the stretch.
    for begin, end in runs_of(surely | seen.edge):
        rows = begin + np.flatnonzero(surely[begin : end + 1])
        if rows.size < max(rules.NO_DRIVING_FEWEST_FIRM, windows.steps + 1):
            continue
        first, last = int(rows[0]), int(rows[-1])
        inside = slice(first, last + 1)
        doubted = float(off[inside].sum()) / windows.steps
        could = float(seen.agreement.gross[inside].sum()) / windows.steps
        moved_more = more[inside].mean() > 0.5
        # A lost track or failed match jumps from one pose to the next, for one window only.
        leaps = moved_more and (
            last + 1 - first < 2 * windows.steps
            or float(off[inside].max()) > rules.NO_DRIVING_AT_ONCE * doubted
        )
        short = rows.size < max(rules.NO_DRIVING_FEWEST, windows.steps + rules.NO_DRIVING_MORE)
        if windows.without_leaps:  # then a short displacement or stop is real
            share = rules.NO_DRIVING_QUICK if moved_more else rules.NO_DRIVING_FIRM
            surely_so = doubted >= share * could
            leaps, short = leaps and not surely_so, short and not surely_so
        if leaps or short or doubted < seen.enough:
            continue
        found.append((float(seen.time[first]), float(seen.time[last])))
    return found


def _reaching(stretch: tuple[float, float], seen: Sequence[MeasuredMotion]) -> tuple[float, float]:
    """Extend a stretch by the adjacent outlier windows, of any measured quantity.

    A robot turned by hand while its wheels begin to turn can match them for a moment by chance.
    """
    off = np.sort(np.concatenate([each.time[each.edge] for each in seen]))
    apart = np.diff(off) > rules.NO_DRIVING_WINDOW
    group = np.concatenate([[0], np.cumsum(apart)])
    begin, end = stretch
    own = group[(off >= begin) & (off <= end)]
    reached = off[(group >= own[0]) & (group <= own[-1])] if own.size else np.array(stretch)
    return min(begin, float(reached[0])), max(end, float(reached[-1]))


def _while_slowed(stretch: tuple[float, float], turns: Agreement) -> tuple[float, float]:
    """Extend a stretch while the robot, in sum, turns by less than any effect leaves of a turn.

    A hand grips and lets go gradually: it slows the robot by less than one window can show. Page's
    cumulative sum (Biometrika 41, 1954) says where that ends; one that is less than the usual
    deviation of a window is noise.
    """
    time, usual = turns.windows.time, turns.windows.steps * float(np.nanmedian(turns.off))
    short = np.sign(turns.expected) * (turns.expected - turns.windows.measured)
    short -= rules.NO_DRIVING_SLOWED * turns.gross
    begin, end = stretch
    reach = rules.NO_DRIVING_SPLIT

    def last(rows: NDArray[np.intp], at: float) -> float:
        known = np.isfinite(short[rows])
        rows = rows[: known.size if known.all() else int(np.argmin(known))]
        total = np.cumsum(short[rows])
        slowed = rows.size > 0 and total.max() > usual
        return float(time[rows[int(np.argmax(total))]]) if slowed else at

    after = np.flatnonzero((time > end) & (time <= end + reach))
    before = np.flatnonzero((time < begin) & (time >= begin - reach))[::-1]
    return last(before, begin), last(after, end)


def _joined(
    found: Sequence[tuple[float, float]], seen: Sequence[MeasuredMotion]
) -> list[tuple[float, float]]:
    """Merge stretches, and with the ends of the drive, unless driving is seen between."""
    if not found:
        return []
    half = max(0.5 * each.agreement.windows.steps * each.agreement.windows.step for each in seen)
    first = min(float(each.time[0]) for each in seen)
    last = max(float(each.time[-1]) for each in seen)
    joined = [(first - half, first - half)]
    for begin, end in [*found, (last + half, last + half)]:
        before = joined[-1][1]
        apart = begin - before
        speaks = any(
            each.speaks[(each.time > before + half) & (each.time < begin - half)].any()
            for each in seen
        )
        if apart <= rules.NO_DRIVING_JOINED or (apart <= rules.NO_DRIVING_SILENT and not speaks):
            joined[-1] = joined[-1][0], max(before, end)
        else:
            joined.append((begin, end))
    return [(begin, end) for begin, end in joined if end > begin]


def _by_kind(begin: float, end: float, seen: Sequence[MeasuredMotion]) -> list[NoDriving]:
    """Split a stretch by what happened in it: held, carried, or one after the other."""
    grid = np.linspace(begin, end, max(2, round((end - begin) / _GRID)))
    shares = np.stack([each.at(each.beyond, grid) for each in seen])
    which = np.argmax(shares, axis=0)
    columns = np.arange(grid.size)

    def of_the_worst(of: Sequence[Floats]) -> Floats:
        every = np.stack([each.at(one, grid) for each, one in zip(seen, of, strict=True)])
        return np.asarray(every[which, columns])

    measured = np.abs(of_the_worst([each.agreement.windows.measured for each in seen]))
    expected = np.abs(of_the_worst([each.agreement.expected for each in seen]))
    moved = (measured > expected).astype(np.float64)
    window = 2 * round(0.5 * rules.NO_DRIVING_SPLIT / _GRID) + 1
    moved = median_filter(moved, window, mode="nearest")
    if end - begin < rules.NO_DRIVING_SPLIT:  # one kind, by the weighted majority
        weight = shares.max(axis=0)
        moved[:] = float(np.average(measured > expected, weights=weight) > 0.5)
    # Short parts take the kind of the longest: a hand comes or goes a moment sooner or later.
    runs = [*runs_of(moved > 0.5), *runs_of(moved < 0.5)]
    longest = max(runs, key=lambda run: run[1] - run[0])
    for first, last in runs:
        if (last + 1 - first) * _GRID < rules.NO_DRIVING_SPLIT:
            moved[first : last + 1] = moved[longest[0]]
    edges = [0, *(np.flatnonzero(np.diff(moved)) + 1).tolist(), grid.size]
    rolled = seen[0].at(seen[0].agreement.windows.rolled, grid)
    still = seen[0].agreement.windows.still
    lag = seen[0].agreement.lag
    parts = []
    for one, other in itertools.pairwise(edges):
        # The reference saw it later than the wheels turned; both times are excluded.
        span = (
            begin + min(lag, 0.0) if one == 0 else float(grid[one]),
            end + max(lag, 0.0) if other == grid.size else float(grid[other]),
        )
        if not moved[one]:
            went = float(measured[one:other].sum() / max(expected[one:other].sum(), 1e-12))
            words = HELD_BACK if went > rules.NO_DRIVING_WENT else HELD
            parts.append(NoDriving(*span, "held", words))
        else:
            stood = np.mean(rolled[one:other] <= still) > 0.5
            parts.append(NoDriving(*span, "carried", CARRIED if stood else BY_HAND))
    return parts


def _among(part: NoDriving, stretches: Sequence[tuple[float, float]]) -> bool:
    return any(begin < part.end and end > part.begin for begin, end in stretches)


def _follows(part: NoDriving, turns: Agreement) -> bool:
    """Whether the heading turns as the wheels say, so that nobody holds the robot.

    Then the wheels slip alike, or the reference falls short of the way, as scans in a corridor do.
    Only whole windows tell: at the ends a robot that is held has been driving, or drives on.
    """
    time = turns.windows.time
    half = 0.5 * turns.windows.steps * turns.windows.step
    inside = (time >= part.begin + half) & (time <= part.end - half)
    expected, measured = turns.expected[inside], turns.windows.measured[inside]
    turned = float(np.abs(expected).sum()) / turns.windows.steps
    left, whole = float(np.sum((measured - expected) ** 2)), float(expected @ expected)
    return turned > rules.NO_DRIVING_TURN and left < rules.NO_DRIVING_FOLLOWS * whole


def _with_rests(parts: Sequence[NoDriving], counters: Counters, robot: Robot) -> list[NoDriving]:
    """Extend carries over the adjacent rest of the wheels: the motion begins and ends gently."""
    travel = np.stack([counters.left * robot.left_tick, counters.right * robot.right_tick])

    def further(at: float, side: float, least: float) -> float:
        here = np.array([np.interp(at, counters.time, wheel) for wheel in travel])
        rolled = np.abs(travel - here[:, None]).max(axis=0) > rules.NO_DRIVING_TREMBLES
        ahead = side * (counters.time[rolled] - at)
        return at + side * float(min([rules.NO_DRIVING_SET_DOWN, least, *ahead[ahead > 0.0]]))

    found = list(parts)
    for number, part in enumerate(parts):
        if part.words == CARRIED:
            before = part.begin - found[number - 1].end if number else np.inf
            after = parts[number + 1].begin - part.end if number + 1 < len(parts) else np.inf
            begin, end = (part.begin, -1.0, before), (part.end, 1.0, after)
            found[number] = part._replace(begin=further(*begin), end=further(*end))
    return found


def _with_what_follows(parts: Sequence[NoDriving], counters: Counters) -> list[NoDriving]:
    """Exclude all but the longest drive between stretches, where only positions are measured.

    The heading after the robot was held or carried is unknown, and only one drive can be used.
    """
    begins = [float(counters.time[0]), *(part.end for part in parts)]
    ends = [*(part.begin for part in parts), float(counters.time[-1])]
    drives = list(zip(begins, ends, strict=True))
    longest = max(range(len(drives)), key=lambda each: drives[each][1] - drives[each][0])
    found = list(parts)
    for number, (begin, end) in enumerate(drives):
        if number != longest and end > begin:
            found.append(NoDriving(begin, end, parts[min(number, len(parts) - 1)].why, LOST))
    return sorted(found)
