# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Set-up search where only positions were measured: headings come from the wheels.

Drives are cut into windows of some metres, each with its own start heading (closed form, as in the
orthogonal Procrustes problem). The residual of the windows tells whether the wheels turn the robot
correctly. Turn per travel is searched on a grid over its whole range, then refined.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import effective_track
from werrimbi_odom.inference.set_up.explanation import Setting, SetUpEstimate, setting_of, wirings
from werrimbi_odom.inference.set_up.findings import SetUpFinding, findings_of
from werrimbi_odom.inference.set_up.records import Complexes, Cuts, SetUpRecord, cut, ratio_of_ticks
from werrimbi_odom.inference.set_up.regression import swept
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class CutWindows:
    """Windows of consecutive cuts, as displacements from each window's start; w windows."""

    cuts: Cuts
    """Stretches, w * WINDOW of them: the first of each window is one cut long, the last the whole
    window."""
    floor: float
    """Error below which fits count as equal [m]."""

    @property
    def count(self) -> int:
        """Number of windows."""
        return self.cuts.count // rules.WINDOW

    def misfit(
        self, left: float, right: float, half_base: float | None = None, arm: complex = 0j
    ) -> float:
        """Typical error of a window [m], with fitted headings, and fitted scale if not given."""
        gone, swing, move = self._shapes(left, right)
        if half_base is None:
            half_base = _scale(gone, move) if arm == 0j else self._mount(gone, swing, move, arm)[0]
        model = half_base * gone + arm * swing
        rms = _rms(move - _facing(model, move) * model)
        return float(np.exp(np.mean(np.log(rms + self.floor))))

    def mount(self, left: float, right: float, arm: complex = 0j) -> tuple[float, complex]:
        """Least-squares half base and lever arm [m]."""
        return self._mount(*self._shapes(left, right), arm)

    def half_base(self, left: float, right: float) -> float:
        """Least-squares half base without a lever arm [m]."""
        gone, _, move = self._shapes(left, right)
        return _scale(gone, move)

    def _shapes(self, left: float, right: float) -> tuple[Complexes, Complexes, Complexes]:
        gone, turn = swept(self.cuts, left, right)
        swing = np.exp(1j * turn) - 1.0
        return (
            gone.reshape(-1, rules.WINDOW),
            swing.reshape(-1, rules.WINDOW),
            self.cuts.move.reshape(-1, rules.WINDOW),
        )

    def _mount(
        self, gone: Complexes, swing: Complexes, move: Complexes, arm: complex
    ) -> tuple[float, complex]:
        """Alternate between headings and mounting, both in closed form; bad windows weigh less."""
        half_base = complex(_scale(gone, move))
        columns = np.stack([gone.ravel(), swing.ravel()], axis=-1)
        for _ in range(8):
            model = half_base * gone + arm * swing
            facing = _facing(model, move)
            weight = 1.0 / (_rms(move - facing * model) + self.floor)
            weights = np.repeat(weight, rules.WINDOW)[:, None]
            straight = (facing.conj() * move).ravel()[:, None]
            solved = np.linalg.lstsq(weights * columns, weights * straight, rcond=1e-6)[0][:, 0]
            # A phase of half the base belongs to the headings.
            axis = np.exp(-1j * np.angle(solved[0]))
            half_base, arm = solved[0] * axis, complex(solved[1] * axis)
        return float(half_base.real), arm


def _rms(off: Complexes) -> Floats:
    return np.asarray(np.sqrt(np.mean(np.abs(off) ** 2, axis=1)))


def _facing(model: Complexes, move: Complexes) -> Complexes:
    """Start heading of each window as a unit complex number, shape (w, 1)."""
    match = np.sum(model.conj() * move, axis=1, keepdims=True)
    return np.asarray(np.exp(1j * np.angle(match)))


def _scale(gone: Complexes, move: Complexes) -> float:
    """Median scale over windows, robust against jumps of the reference."""
    match = np.abs(np.sum(gone.conj() * move, axis=1))
    size = np.sum(np.abs(gone) ** 2, axis=1)
    moved = size > 0.0
    return float(np.median(match[moved] / size[moved])) if moved.any() else 0.0


def windows_of(cuts: Cuts, most: int = rules.FINE_WINDOWS) -> CutWindows | None:
    """Windows spread over all drives; None where there is none."""
    _, first, count = np.unique(cuts.stretch, return_index=True, return_counts=True)
    spans = zip(first.tolist(), (first + count - rules.WINDOW + 1).tolist(), strict=True)
    starts = np.concatenate(
        [np.empty(0, dtype=np.intp), *(np.arange(*span, rules.WINDOW // 2) for span in spans)]
    )
    if starts.size == 0:
        return None
    if starts.size > most:
        starts = starts[np.linspace(0, starts.size - 1, most).astype(int)]
    inside = starts[:, None] + np.arange(rules.WINDOW)
    begin = np.repeat(cuts.begin[starts], rules.WINDOW)
    move = np.cumsum(cuts.move[inside], axis=1).ravel()
    end = cuts.end[inside].ravel()
    floor = rules.WINDOW_FLOOR * float(np.median(np.abs(cuts.move))) + 1e-12
    nothing = np.full(end.size, np.nan)
    stretches = Cuts(cuts.left, cuts.right, begin, end, nothing, nothing, move, end * 0)
    return CutWindows(_compact(stretches), floor)


def _compact(cuts: Cuts) -> Cuts:
    """Keep only the steps that some stretch uses."""
    needed = np.zeros(cuts.left.size + 1, dtype=np.intp)
    last: NDArray[np.intp] = cuts.end.reshape(-1, rules.WINDOW)[:, -1]
    first: NDArray[np.intp] = cuts.begin.reshape(-1, rules.WINDOW)[:, -1]
    np.add.at(needed, first, 1)
    np.add.at(needed, last, -1)
    keep = np.cumsum(needed[:-1]) > 0
    place = np.concatenate([[0], np.cumsum(keep)])
    return Cuts(
        cuts.left[keep],
        cuts.right[keep],
        place[cuts.begin],
        place[cuts.end],
        cuts.duration,
        cuts.turn,
        cuts.move,
        cuts.stretch,
    )


def search_positions(
    records: Sequence[SetUpRecord], robot: Robot
) -> tuple[list[SetUpFinding], Setting | None]:
    """Findings, and the measured sizes."""
    cuts = cut(records, robot, "position", fewest=rules.POSITION_CUTS)
    windows, some = windows_of(cuts), windows_of(cuts, rules.COARSE_WINDOWS)
    if windows is None or some is None:
        return [], None
    track = effective_track(robot)
    tried = sorted(
        (some.misfit(left / track, right / track), left, right) for left, right in _grid()
    )
    best = min(
        _refined(windows, left / track, right / track)
        for _, left, right in tried[: rules.POSITIONS_REFINED]
    )
    given = _refined(windows, 1.0 / track, 1.0 / track)
    if given[0] < rules.GIVEN_AS_GOOD * best[0]:
        best = given
    with_arm = _with_arm(windows, best[1], best[2])
    if with_arm[0] * rules.GIVEN_AS_GOOD < best[0]:
        _, left, right, half_base, arm = with_arm
    else:  # on circles only, lever arm and base are confounded
        _, left, right = best
        half_base, arm = windows.half_base(left, right), 0j
    if half_base <= 0.0:
        return [], None
    estimate = SetUpEstimate(left, right, 2.0 * half_base, None, arm, ratio_of_ticks(robot))
    ways = wirings(estimate)
    setting = setting_of(estimate, ways[0], track)

    def misfit(one: Setting) -> float:
        left, right, half_base, _ = one.numbers(track)
        return windows.misfit(left, right, abs(half_base), arm)

    found = findings_of(setting, ways, misfit)
    entered = windows.misfit(1.0 / track, 1.0 / track, 0.5 * track)
    gain = entered / misfit(setting)
    apart = min(windows.count, cuts.count / rules.WINDOW)  # windows overlap
    evidence = 2.0 * (apart - 1) * math.log(gain)
    if not found or gain < rules.POSITIONS_WIDE or evidence < rules.POSITIONS_EVIDENCE:
        return [], None
    return found, setting


def _with_arm(
    windows: CutWindows, left: float, right: float
) -> tuple[float, float, float, float, complex]:
    """Error, turn per travel of both wheels, half base and lever arm of the best fit."""
    arm, error = 0j, math.inf
    for _ in range(3):
        half_base, arm = windows.mount(left, right, arm)
        error, left, right = _refined(windows, left, right, arm, step=0.03)
    return error, left, right, half_base, arm


def _grid() -> list[tuple[float, float]]:
    """Trial factors on the turn per travel of both wheels: all signs, the whole range."""
    sizes = np.exp(np.arange(-31, 32) * 0.25)
    ratios = (1.0, 2.0, 0.5, 4.0, 0.25)
    signs = tuple(product((1.0, -1.0), repeat=2))
    return [
        (sign_left * size / math.sqrt(ratio), sign_right * size * math.sqrt(ratio))
        for size in sizes.tolist()
        for ratio in ratios
        for sign_left, sign_right in signs
    ]


def _refined(
    windows: CutWindows, left: float, right: float, arm: complex = 0j, *, step: float = 0.15
) -> tuple[float, float, float]:
    """Pattern search in log size and log ratio, with shrinking steps."""
    size, ratio = 0.0, 0.0
    best = windows.misfit(left, right, None, arm)
    while step > 0.002:
        tries: list[tuple[float, float, float]] = []
        for du, dv in ((step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step)):
            factors = (
                math.exp(size + du - 0.5 * (ratio + dv)),
                math.exp(size + du + 0.5 * (ratio + dv)),
            )
            tries.append((windows.misfit(left * factors[0], right * factors[1], None, arm), du, dv))
        value, du, dv = min(tries)
        if value < best:
            best, size, ratio = value, size + du, ratio + dv
        else:
            step *= 0.5
    return best, left * math.exp(size - 0.5 * ratio), right * math.exp(size + 0.5 * ratio)
