# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A session of eleven drives of about a minute: seven for training, four held out."""

from __future__ import annotations

import math
from collections.abc import Container, Iterator, Sequence

from .hidden.hidden_effect import Peculiarity
from .manoeuvres import (
    Manoeuvre,
    MoveLimits,
    arcs,
    chain,
    figure_eight,
    free,
    moves,
    out_and_back,
    pivots,
    spins,
    square,
)
from .manoeuvres import start_stop as hops
from .recorder import record
from .recording import Recording
from .robot import TrueRobot

SLOW = MoveLimits(speed=0.2, acceleration=0.3, yaw_rate=0.6, yaw_acceleration=1.0)
FAST = MoveLimits(speed=0.7, acceleration=1.2, yaw_rate=2.0, yaw_acceleration=4.0)


def drives(seed: int) -> dict[str, Manoeuvre]:
    """Manoeuvres of the session by the names of their run folders.

    Together they excite everything that an effect may depend on: lines in all directions, curves to
    both sides, slow and fast, spins, driving backwards, hard starts and stops, standing still.
    """
    return {
        "train/square_ccw": square(1.5, laps=2),
        "train/square_cw": square(1.5, "cw", laps=2),
        "train/free_calm": free(60.0, seed=10 * seed + 1, speed=0.4, yaw_rate=1.0),
        "train/free_brisk": free(
            60.0, seed=10 * seed + 2, speed=0.8, yaw_rate=2.0, acceleration=1.5
        ),
        "train/start_stop": hops(3, laps=4),
        "train/arcs": chain(
            "arcs",
            arcs((0.4, 0.8), angle=math.pi / 2, pace=SLOW),
            arcs((0.4, 0.8, 1.6), angle=math.pi / 2, pace=FAST),
        ),
        "train/eights_and_spins": chain(
            "eights_and_spins",
            figure_eight(0.6, pace=FAST),
            figure_eight(0.6, pace=SLOW),
            spins(1.0, pairs=1),
            pivots(),
        ),
        "holdout/free_calm": free(60.0, seed=10 * seed + 3, speed=0.4, yaw_rate=1.0),
        "holdout/free_brisk": free(
            60.0, seed=10 * seed + 4, speed=0.8, yaw_rate=2.0, acceleration=1.5
        ),
        "holdout/to_and_fro": chain(
            "to_and_fro",
            out_and_back(2.0, laps=2, pace=FAST),
            out_and_back(2.0, turn_round=True, laps=1),
            spins(0.5, pairs=2, pace=FAST),
            out_and_back(1.0, laps=2),
        ),
        "holdout/slalom": chain("slalom", _slalom(FAST), _slalom(SLOW), square(1.0, pace=FAST)),
    }


def _slalom(pace: MoveLimits) -> Manoeuvre:
    gates = [(0.8, 1.2), (0.8, -2.4), (0.8, 2.4), (0.8, -1.2), (0.0, math.pi)]
    return moves("slalom", gates * 2, pace)


def session(
    robot: TrueRobot,
    seed: int,
    *,
    hidden: Sequence[Peculiarity] = (),
    only: Container[str] | None = None,
) -> Iterator[tuple[str, Recording]]:
    """Record the drives of the session, one after the other, with the names of their run folders.

    The seeds of the runs follow from that of the session. With `only` some drives are recorded,
    each as in the whole session.
    """
    for number, (name, manoeuvre) in enumerate(drives(seed).items()):
        if only is None or name in only:
            yield name, record(robot, manoeuvre, seed=1000 * seed + number, hidden=hidden)
