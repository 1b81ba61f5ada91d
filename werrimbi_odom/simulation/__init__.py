# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A differential-drive robot in the MuJoCo physics engine.

The engine simulates real wheels on a real floor. It imports nothing else of this package, so its
recordings are independent of the odometry's own models and a fair test of them.

>>> from werrimbi_odom.simulation import TrueRobot, record, square, write_run
>>> recording = record(TrueRobot(), square(side=1.0), seed=1)
>>> len(recording.t_s) == len(recording.left_ticks)
True

Reading order: `robot` (the true robot), `manoeuvres` (commands), `chassis` and `engine` (the
physics), `sensors` (measurements), `recorder` (wheel noise) and `recording` (one drive),
`sessions` (a set of drives), `live` (driven by commands as they arrive), `field_drive` (recorded
without motion capture, `held_and_carried` in between), `hidden` (hidden effects as test data).
"""

from .engine import AxlePose, TruePath, UnstableError
from .field_bag import write_field_bag
from .field_drive import FieldDrive, as_in_the_field
from .hidden import (
    CATALOGUE,
    Hidden,
    Peculiarity,
    StrengthError,
    UnknownEffectError,
    WishError,
    hide,
    wished,
)
from .live import LiveRobot
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
    spin,
    spins,
    square,
    start_stop,
)
from .recorder import record
from .recording import Recording, write_run
from .robot import Nominal, TrueRobot, write_robot_file
from .sensors import ReferenceSensor
from .sessions import drives, session

__all__ = [
    "CATALOGUE", "AxlePose", "FieldDrive", "Hidden", "LiveRobot", "Manoeuvre",
    "MoveLimits", "Nominal", "Peculiarity", "Recording", "ReferenceSensor", "StrengthError",
    "TruePath", "TrueRobot", "UnknownEffectError", "UnstableError", "WishError", "arcs",
    "as_in_the_field", "chain", "drives", "figure_eight", "free", "hide", "moves",
    "out_and_back", "pivots", "record", "session", "spin", "spins", "square", "start_stop",
    "wished", "write_field_bag", "write_robot_file", "write_run",
]  # fmt: skip
