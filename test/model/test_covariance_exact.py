# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The closed form is right to ten digits and more, against integrals to fifty, for any piece."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np
import pytest

pytest.importorskip("mpmath")

from mpmath import mp, mpf

from test.model.exact_covariance import by_model_page, by_quadrature, turned, worst_error
from werrimbi_odom.model.covariance import PathNoise, path_noise, piece_covariance
from werrimbi_odom.model.motion import BodyMotion
from werrimbi_odom.model.robot import Robot

ROBOT = Robot(0.35, 0.05, 2000, 2000, left_wheel_noise=1.0e-3, right_wheel_noise=2.0e-3)
YAW = 0.7

SIZES = (1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1.0, 2.0, 3.141592653589793, 10.0, 100.0, 1e3, 1e4)
SEAM = (1.9999999999, 2.0000000001)  # either side of |h| = 1, where series and closed form meet
TURNS = (0.0, *(sign * size for size in (*SIZES, *SEAM) for sign in (1.0, -1.0)))

DRIVES = {
    "forwards": lambda turn: (3.0, 0.0, turn),
    "backwards": lambda turn: (-3.0, 0.0, turn),
    "spin": lambda turn: (0.0, 0.0, turn),
    "pivot about the left wheel": lambda turn: (0.5 * ROBOT.track * turn, 0.0, turn),
    "pivot about the right wheel": lambda turn: (-0.5 * ROBOT.track * turn, 0.0, turn),
    "forwards, creeping to the right": lambda turn: (2.0, -0.7, turn),
    "backwards, creeping to the left": lambda turn: (-2.0, 0.7, turn),
    "straight to the side": lambda turn: (0.0, 1.3, turn),
}


def wheel_noise(along: float, turn: float) -> PathNoise[float]:
    half = 0.5 * ROBOT.track * turn
    return path_noise(ROBOT, along - half, along + half)


@pytest.fixture(autouse=True)
def eighty_digits() -> Iterator[None]:
    with mp.workdps(80):
        yield


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("turn", TURNS)
def test_every_entry_is_right_to_ten_digits(drive: str, turn: float) -> None:
    motion = BodyMotion(*DRIVES[drive](turn))
    noise = wheel_noise(motion.along, turn)
    error, entry = worst_error(
        piece_covariance(motion, noise, YAW), by_quadrature(motion, noise, YAW)
    )
    assert error < 1e-10, f"{entry} is off by {error:.1e}"


def test_arrays_are_as_right_as_single_pieces() -> None:
    motions = [BodyMotion(*drive(turn)) for drive, turn in product(DRIVES.values(), TURNS)]
    noises = [wheel_noise(motion.along, motion.turn) for motion in motions]
    yaws = np.linspace(-3.0, 3.0, len(motions))
    together = piece_covariance(
        BodyMotion(*np.array(motions).T), PathNoise(*np.array(noises).T), yaws
    )
    for motion, noise, yaw, row in zip(
        motions, noises, yaws.tolist(), np.array(together).T, strict=True
    ):
        error, entry = worst_error(row.tolist(), by_quadrature(motion, noise, yaw))
        assert error < 1e-10, f"{entry} of {motion} is off by {error:.1e}"
        one = np.array(piece_covariance(motion, noise, yaw))
        assert np.abs(row - one).max() <= 1e-13 * np.abs(one).max()


@pytest.mark.parametrize(
    "noise",
    [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 1.0, 1.0), (1.0, 1.0, -1.0)],
    ids=["along the path", "in heading", "one wheel alone", "the other alone"],
)
@pytest.mark.parametrize("turn", [0.0, -1e-6, 0.3, 1.9, -2.1, 40.0])
def test_each_source_of_noise_is_right_by_itself(
    turn: float, noise: tuple[float, float, float]
) -> None:
    motion = BodyMotion(1.5, 0.4, turn)
    error, entry = worst_error(
        piece_covariance(motion, PathNoise(*noise), YAW), by_quadrature(motion, noise, YAW)
    )
    assert error < 1e-10, f"{entry} is off by {error:.1e}"


@pytest.mark.parametrize("turn", TURNS)
def test_the_model_page_says_the_same_to_fifty_digits(turn: float) -> None:
    motion = (3.0, 0.0, turn)
    noise = wheel_noise(3.0, turn)
    with mp.workdps(140):
        page = by_model_page(motion, noise, YAW)
    error, entry = worst_error(page, by_quadrature(motion, noise, YAW))
    assert error < 1e-50, f"{entry} is off by {error:.1e}"


def test_the_formula_as_printed_loses_digits_on_nearly_straight_lines() -> None:
    motion, noise = (3.0, 0.0, 2.5e-4), wheel_noise(3.0, 2.5e-4)
    exact = by_quadrature(motion, noise)
    with mp.workprec(53):
        printed = by_model_page(motion, noise)
    assert worst_error(printed, exact)[0] > 1e-11
    ours = piece_covariance(BodyMotion(*motion), noise, 0.0)
    assert worst_error(ours, exact)[0] < 1e-15


def test_counting_whole_turns_is_the_same_as_integrating_through_them() -> None:
    """The reference itself: over 3.5 turns, plain adaptive quadrature without the shortcut."""
    along, sideways, turn = motion = (1.2, 0.3, 22.0)
    a, b, c = noise = (0.5, 0.7, 0.2)
    travel = mp.mpc(along, sideways)
    end = mp.expj(turn)

    def swing(u: mpf) -> mp.mpc:
        return travel * (end - mp.expj(turn * u)) / turn

    def integral(f) -> mpf:
        return mp.quad(f, mp.linspace(0, 1, 9))

    plain = [
        integral(lambda u: a * mp.cos(turn * u) ** 2)
        + integral(lambda u: 2 * c * mp.cos(turn * u) * swing(u).real + b * swing(u).real ** 2),
        integral(lambda u: a * mp.cos(turn * u) * mp.sin(turn * u))
        + integral(
            lambda u: c * (mp.cos(turn * u) * swing(u).imag + mp.sin(turn * u) * swing(u).real)
        )
        + integral(lambda u: b * swing(u).real * swing(u).imag),
        integral(lambda u: c * mp.cos(turn * u) + b * swing(u).real),
        integral(lambda u: a * mp.sin(turn * u) ** 2)
        + integral(lambda u: 2 * c * mp.sin(turn * u) * swing(u).imag + b * swing(u).imag ** 2),
        integral(lambda u: c * mp.sin(turn * u) + b * swing(u).imag),
        mpf(b),
    ]
    assert worst_error(turned(plain, mpf(YAW)), by_quadrature(motion, noise, YAW))[0] < 1e-50
