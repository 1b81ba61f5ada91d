# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One tick message as scalar operations: the function that `QuickOdometer` compiles.

The state of the odometer is held in arrays, which cost nothing to pass. The functions are those of
`Odometer`, so results agree to the last bit.
"""

from __future__ import annotations

from collections.abc import Sequence

from werrimbi_odom.model.covariance import PoseCovariance, twist_noise
from werrimbi_odom.model.end_of_piece import PieceRule, PieceSums
from werrimbi_odom.model.motion import BodyMotion, Chord, WheelTravel, mean_twist, wheels_to_body
from werrimbi_odom.model.pace import seen
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.reading_checks import CountRule, Reading, undoubted
from werrimbi_odom.model.robot import WheelNoise
from werrimbi_odom.model.scalar_loop import Marching, onward, sums_of

GOES_ON, PIECE_ENDED, IN_DOUBT = 0, 1, 2
"""Result of a message; one in doubt changes nothing."""


def take(
    rules: Floats,
    heard: Floats,
    stamps: Floats,
    at: Floats,
    said: Floats,
    ended: Floats,
    time: float,
    left: float,
    right: float,
) -> int:
    """Process the counters of one message, if they pass all checks.

    `rules` (17,): `CountRule`, `PieceRule` and `WheelNoise`, then the longest interval that is no
    gap [s]. `heard` (9,): `Reading` of the last message, `Heard`, the number of stamps in the ring,
    and the index of the next one; updated, as are the two arrays after it. `stamps` (REMEMBERED +
    1,): ring buffer of stamps [s]. `at` (34,): `Marching`, flattened. `said` (22,): output: stamp,
    duration, travel of the wheels, and motion of the step; then the pose, its covariance, that of
    the twist, and the twist. `ended` (15,): output where a piece ends: its last stamp, pose and
    covariance at its start, `sums_of`.
    """
    counts, piece_rule, wheels = rules_of(rules)
    last, now = Reading(heard[0], heard[1], heard[2]), Reading(time, left, right)
    usual, fastest, newer, room = heard[3], heard[4], heard[5], int(heard[6])
    plain, step = undoubted(counts, now, last, usual, fastest)
    duration = time - last.time
    if not plain or duration < step.lasted or duration > rules[16]:
        return IN_DOUBT
    before = marching_of(at)
    travel = WheelTravel(step.left, step.right)
    motion = wheels_to_body(travel, wheels.track)
    goes_on, after = onward(piece_rule, wheels, before, travel, motion)
    if not goes_on:
        ended[0] = last.time
        ended[1], ended[2], ended[3] = before.start
        write_covariance(ended, 4, before.covariance_start)
        ended[10], ended[11], ended[12], ended[13], ended[14] = sums_of(before.stretch)
    write_marching(at, after)

    known, place = min(int(heard[7]) + 1, stamps.size), int(heard[8])
    stamps[place] = time
    place = (place + 1) % stamps.size
    oldest = stamps[place] if known == stamps.size else stamps[(place - known) % stamps.size]
    usual = (time - oldest) / (known - 1)
    fastest, newer, room = seen(step.rate, fastest, newer, room)
    heard[0], heard[1], heard[2] = time, left, right
    heard[3], heard[4], heard[5], heard[6] = usual, fastest, newer, room
    heard[7], heard[8] = known, place

    said[0], said[1], said[2], said[3] = time, duration, step.left, step.right
    said[4], said[5], said[6] = motion
    said[7], said[8], said[9] = after.pose
    write_covariance(said, 10, after.covariance)
    said[16], said[17], said[18] = twist_noise(
        wheels, counts.left_tick, counts.right_tick, duration, step.left, step.right, 0.0, 0.0
    )
    said[19], said[20], said[21] = mean_twist(motion, duration)
    return GOES_ON if goes_on else PIECE_ENDED


def rules_of(row: Floats) -> tuple[CountRule, PieceRule, WheelNoise]:
    """Unpack the beginning of `rules`."""
    return (
        CountRule(row[0], row[1], row[2], row[3], row[4], row[5], row[6]),
        PieceRule(row[7], row[8], row[9], row[10], row[11], row[12]),
        WheelNoise(row[13], row[14], row[15]),
    )


def marching_of(row: Floats | Sequence[float]) -> Marching:
    """Inverse of `write_marching`."""
    return Marching(
        Pose(row[0], row[1], row[2]),
        PoseCovariance(row[3], row[4], row[5], row[6], row[7], row[8]),
        Pose(row[9], row[10], row[11]),
        PoseCovariance(row[12], row[13], row[14], row[15], row[16], row[17]),
        row[18],
        PieceSums(
            row[19],
            row[20],
            BodyMotion(row[21], row[22], row[23]),
            Chord(row[24], row[25], row[26]),
            row[27],
            row[28],
            row[29],
            row[30],
            row[31],
            row[32],
            row[33] != 0.0,
        ),
    )


def write_marching(row: Floats, at: Marching) -> None:
    """Write the state number by number, shape (34,)."""
    row[0], row[1], row[2] = at.pose
    write_covariance(row, 3, at.covariance)
    row[9], row[10], row[11] = at.start
    write_covariance(row, 12, at.covariance_start)
    row[18] = at.earlier
    stretch = at.stretch
    row[19], row[20] = stretch.left, stretch.right
    row[21], row[22], row[23] = stretch.motion
    row[24], row[25], row[26] = stretch.chord
    row[27], row[28] = stretch.left_low, stretch.left_high
    row[29], row[30] = stretch.right_low, stretch.right_high
    row[31], row[32] = stretch.slope_low, stretch.slope_high
    row[33] = 1.0 if stretch.empty else 0.0


def write_covariance(row: Floats, first: int, covariance: PoseCovariance[float]) -> None:
    """Write the six numbers of a covariance from index `first` on."""
    xx, xy, xyaw, yy, yyaw, yawyaw = covariance
    row[first], row[first + 1], row[first + 2] = xx, xy, xyaw
    row[first + 3], row[first + 4], row[first + 5] = yy, yyaw, yawyaw
