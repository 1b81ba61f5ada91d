# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheels from JointState messages: angles, counts, or integrated speeds; several per side."""

from __future__ import annotations

import difflib
import math
from array import array
from collections import Counter
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag import BagMessage, left_out_words, stamp_of
from werrimbi_odom.files.bags.ways_of_speeds import ways_of
from werrimbi_odom.files.robot_files.parameters import WHOLE_COUNTS
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.run import WORKED_OUT, Ticks, counts_of
from werrimbi_odom.model.counter_wraps import differences
from werrimbi_odom.model.encoder_online import Counts
from werrimbi_odom.model.pose import Floats

_WINDOW = 0.5
"""Time over which wheels of a side are compared [s]: long against play and late messages, short
against a manoeuvre."""
_UNLIKE = 0.25
"""Share of the way of a side's wheels that may be unlike. Steered and driven wheels of one side
differ by up to an eighth in the tightest turns, skidding ones by less; mecanum wheels on a drive
that is sideways in part by more than a third."""
_FEWEST, _SHARE = 20, 0.03
"""Messages that leap away and back, and their share, from which a second node sends them. Faults of
a counter are fewer; what is sent by a node at 1 Hz beside a driver at 30 Hz is more."""
_MOSTLY = 0.5
"""Share from which both sequences take turns."""
_LEAP, _FASTER = 0.1, 10.0
"""Least leap, in turns of the wheel, and in usual steps from message to message."""
_BACK = 0.1
"""Share of a leap to within which it leads back, and to which a sequence of its own changes."""
UNTURNED = "the angles begin anew at each turn; they are unwrapped"


class JointsCollector:
    """Collects the wheels among the joints of a robot."""

    def __init__(self, path: Path, topic: str, robot_file: RobotFile) -> None:
        self._place = f"{path}: {topic}"
        self._file = robot_file
        self._sides = [wheel_names(robot_file, side) for side in ("left", "right")]
        self._wheels = [name for side in self._sides for name in side]
        self._angles = _Rows()
        self._speeds = _Rows()
        self._names: list[str] = []
        self._seen: dict[str, None] = {}
        """Names of the joints in all messages."""
        self._places: list[int] = []
        self._left_out: Counter[str] = Counter()

    def take(self, message: BagMessage) -> None:
        """Add a message."""
        content = message.content
        if content.name != self._names or not self._places:
            self._names = list(content.name)
            self._seen |= dict.fromkeys(self._names)
            known = all(name in self._names for name in self._wheels)
            self._places = [self._names.index(name) for name in self._wheels] if known else []
        if not self._places:
            self._left_out["without our joints"] += 1
            return
        angles = len(content.position) == len(self._names)
        speeds = len(content.velocity) == len(self._names)
        if angles:
            self._angles.add(stamp_of(message), content.position, self._places)
        elif not (speeds and len(content.position) == 0):
            self._left_out["without a position for each joint"] += 1
        if speeds:
            self._speeds.add(stamp_of(message), content.velocity, self._places)

    def ticks(self) -> tuple[Ticks, list[str]]:
        """All ticks, and the skipped messages in words."""
        time, positions = self._angles.arrays(len(self._wheels))
        words = left_out_words(self._left_out)
        if self._speeds_tell(positions):
            time, speeds = self._speeds.arrays(len(self._wheels))
            known = np.where(np.isfinite(speeds), speeds, 0.0)
            positions, how = ways_of(time, known)
            words += [WORKED_OUT["velocities"], *how]
        elif not time.size:
            raise InputError(f"{self._place}: {self._why_none()}")
        elif self._file.values["position_unit"] == "radians" and _begin_anew(positions):
            positions, words = np.unwrap(positions, axis=0), [*words, UNTURNED]
        left = self._side(time, positions[:, : len(self._sides[0])], "left")
        right = self._side(time, positions[:, len(self._sides[0]) :], "right")
        return Ticks(time, left, right), words

    def _speeds_tell(self, positions: Floats) -> bool:
        """Whether to use speeds: there are some, and angles are absent or constant."""
        speeds = self._speeds.arrays(len(self._wheels))[1]
        if speeds.size == 0 or positions.shape[0] > speeds.shape[0]:
            return False
        known = positions[np.isfinite(positions).all(axis=1)]  # a broadcaster writes NaN for none
        still = known.shape[0] == 0 or not np.ptp(known, axis=0).any()
        moves = np.isfinite(speeds) & (speeds != 0.0)
        return bool(still and (positions.shape[0] == 0 or moves.any()))

    def _side(self, time: Floats, positions: Floats, side: str) -> Counts:
        values = self._file.values
        per_turn = float(values[f"{side}_ticks_per_revolution"])  # type: ignore[arg-type]
        in_radians = values["position_unit"] == "radians"
        counts = positions * (per_turn / (2.0 * math.pi)) if in_radians else positions
        bits = int(values["encoder_bits"])  # type: ignore[arg-type]
        self._refuse_two_nodes(side, counts, per_turn, bits)
        self._refuse_unlike(side, time, counts, per_turn, bits)
        self._refuse_other_unit(in_radians, positions)
        return counts_of(side_counts(counts, per_turn, bits))

    def _refuse_other_unit(self, in_radians: bool, positions: Floats) -> None:
        """Raise if angles are to be read as counts, or counts as angles."""
        known = positions[np.isfinite(positions)]
        fractions = known != np.rint(known)
        if not in_radians and known.size and np.mean(fractions) > 0.5:
            raise InputError(
                f"{self._place}: its positions are no whole numbers, and so no counts; angles are "
                "read with position_unit: radians"
            )
        if in_radians and not fractions.any() and np.unique(known).size >= WHOLE_COUNTS:
            raise InputError(
                f"{self._place}: its positions are whole numbers, and so counts, no angles; they "
                "are read with position_unit: ticks and left_ticks_per_revolution in the robot file"
            )

    def _refuse_two_nodes(self, side: str, counts: Floats, per_turn: float, bits: int) -> None:
        """Raise if a second node publishes a wheel: what both say is no way of it."""
        for name, column in zip(self._sides[side == "right"], counts.T, strict=True):
            rolled = np.cumsum(differences(column, bits)[0]) if bits else column
            if count := _leaps_to_and_fro(rolled / per_turn):
                raise InputError(
                    f"{self._place}: the position of {name} jumps to and fro between two sequences "
                    f"in {count} of {column.size} messages: two nodes publish it (the driver, and "
                    "a joint_state_publisher perhaps, which sends zeros). `ros2 topic info -v` "
                    "lists them; stop the one that does not measure, and record again. The "
                    "driver's own odometry, where it was recorded, still holds the drive: "
                    "--ticks-topic names it"
                )

    def _refuse_unlike(
        self, side: str, time: Floats, counts: Floats, per_turn: float, bits: int
    ) -> None:
        """Raise if the wheels of a side turn by different amounts, so that their mean says nothing.

        Mecanum and omni wheels do when the robot goes sideways; a counter does that stands still or
        counts backwards.
        """
        known = np.isfinite(counts).all(axis=1) & np.isfinite(time)
        if counts.shape[1] == 1 or not known.any():
            return
        rolled = _counted_on(counts[known], per_turn, bits)
        window = np.floor((time[known] - time[known][0]) / _WINDOW)
        steps = np.diff(rolled[np.diff(window, prepend=-1.0) != 0.0], axis=0)
        apart = float(np.abs(steps - steps.mean(axis=1, keepdims=True)).sum())
        whole = float(np.abs(steps).sum())
        if apart > max(_UNLIKE * whole, per_turn):
            names = self._sides[side == "right"]
            raise InputError(
                f"{self._place}: {' and '.join(names)}, wheels of the {side} side, do not turn "
                f"alike: {100 * apart / whole:.0f} % of their way is against each other. Mecanum "
                "and omni wheels turn so when the robot goes sideways, and no model here is for "
                "them. On any other robot one of them stands still, spins freely, or counts "
                f"backwards: leave it out of {side}_wheel_names in the robot file"
            )

    def _why_none(self) -> str:
        absent = [name for name in self._wheels if name not in self._seen]
        if not absent and self._left_out["without our joints"]:
            return (
                f"no message holds {', '.join(self._wheels)} together: they come in messages of "
                "their own. joint_state_publisher puts them together, with both topics in its "
                "source_list; of a recording, save the counts as ticks.csv of a folder "
                "(docs/recordings.md)"
            )
        if not absent:
            return "no message gives a position for each joint"
        near = difflib.get_close_matches(absent[0], self._seen, n=1, cutoff=0.0)
        nearest = f", the nearest is {near[0]}" if near else ""
        return (
            f"no joint {absent[0]}{nearest}; it has {', '.join(self._seen) or 'none'}; "
            "set left_wheel_names and right_wheel_names in the robot file"
        )


class _Rows:
    """Stamps, and a value for each wheel."""

    def __init__(self) -> None:
        self._time = array("d")
        self._values = array("d")

    def add(self, time: float, values: NDArray[np.float64], places: list[int]) -> None:
        self._time.append(time)
        self._values.extend(float(values[place]) for place in places)

    def arrays(self, wheels: int) -> tuple[Floats, Floats]:
        """Arrays of shapes (n,) and (n, wheels)."""
        return np.array(self._time), np.array(self._values).reshape(-1, wheels)


def _leaps_to_and_fro(turns: Floats) -> int:
    """Number of messages of a second sequence among those of a wheel; 0 if there is none.

    `turns` (n,): the wheel's angle [turns], unwrapped, in order of receipt; may hold NaN. A second
    sequence is known by its values, which change little from one to the next (zero, as a rule):
    faults of a counter have any value.
    """
    known = turns[np.isfinite(turns)]
    if known.size < _FEWEST:
        return 0
    first, second = np.diff(known)[:-1], np.diff(known)[1:]
    both = np.abs(first + second)
    least = np.maximum(_LEAP, _FASTER * float(np.median(both)))
    size = np.minimum(np.abs(first), np.abs(second))
    away: NDArray[np.bool_] = (size > least) & (both < _BACK * size)
    count = int(away.sum())
    if count < max(_FEWEST, _SHARE * known.size):
        return 0
    alone = np.abs(np.diff(known[1:-1][away])) < _BACK * np.median(size[away])
    return count if count > _MOSTLY * known.size or alone.mean() > _MOSTLY else 0


def _begin_anew(angles: Floats) -> bool:
    """Whether angles stay within a turn and jump by most of one, as some drivers publish them."""
    with np.errstate(invalid="ignore"):
        within = np.nanmax(np.abs(angles), initial=0.0) <= 2.0 * math.pi + 1e-6
        return bool(within and (np.abs(np.diff(angles, axis=0)) > 1.5 * math.pi).any())


def wheel_names(robot_file: RobotFile, side: str) -> tuple[str, ...]:
    """Joint names of a side."""
    return tuple(robot_file.values[f"{side}_wheel_names"])  # type: ignore[arg-type]


def side_counts(counts: Floats, per_revolution: float, bits: int) -> Floats:
    """Mean counter of a side's wheels, with wraps and resets handled per wheel.

    `counts` (n, wheels). `per_revolution`: counts per turn. `bits`: width at which the counters
    wrap; 0: they do not wrap. Result (n,): NaN where any wheel's count is not finite. If a single
    wheel falls to near zero (its driver restarted), it is assumed to have rolled like the others.
    If all of them fall, the mean falls too, and the encoder model detects the reset.
    """
    if counts.shape[1] == 1:
        return counts[:, 0]
    known = np.isfinite(counts).all(axis=1)
    mean = np.full(len(counts), np.nan)
    if known.any():
        mean[known] = _counted_on(counts[known], per_revolution, bits).mean(axis=1)
    return mean


def _counted_on(counts: Floats, per_revolution: float, bits: int) -> Floats:
    raw = np.diff(counts, axis=0)
    steps, _ = differences(counts, bits)
    fell = (np.abs(counts[1:]) < per_revolution) & (np.abs(steps) > per_revolution)
    all_fell: NDArray[np.bool_] = np.logical_and.reduce(fell, axis=1)
    some_fell = fell.any(axis=1) & ~all_fell
    if some_fell.any():
        rolled = np.where(fell, np.nan, steps)[some_fell]
        mean = np.nanmean(rolled, axis=1, keepdims=True)
        steps[some_fell] = np.where(np.isnan(rolled), mean, rolled)
    # Offset of the counters due to wraps and resets, summed since all wheels last fell. It is
    # exactly zero without such events; a sum of steps would have rounding errors.
    hidden = np.zeros_like(counts)
    np.cumsum(np.where(all_fell[:, None], 0.0, steps - raw), axis=0, out=hidden[1:])
    since = np.maximum.accumulate(np.append(0, np.arange(1, len(counts)) * all_fell))
    return np.asarray(counts + hidden - hidden[since], dtype=np.float64)
