# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheel odometry that knows how wrong it is, and can tell its user why.

Ticks become wheel travel. Travel passes through the physical effects in the robot's model and
becomes motion pieces (line, arc, spin). Pieces become a pose with the closed-form covariance of
Chong and Kleeman (ICRA 1997). Legs of a drive compare the prediction with a reference; the
residuals show which physical effect is missing.

Terms
-----
tick, counter
    One count of a wheel encoder, and its cumulative reading.
run, drive
    One recording: ticks and, usually, a reference.
reference
    Measurements independent of the wheels: motion capture, laser, tape, localiser, gyro.
leg
    A stretch of a drive, 1 m by default, over which prediction and reference are compared.
effect
    A physical model with a few parameters that changes travel, motion or measurement. At its null
    values it does nothing.
verb
    A command of `werrimbi`, and the function of the same name in `api`.

Reading order
-------------
1. `model.motion`, `model.covariance`: the physics of one piece, in formulas.
2. `model.odometer`: `Odometer.update` takes one tick message from counters to estimate.
3. `model.trajectory`: the same for a recorded run, all rows at once.
4. `effects`: one physical effect a file.
5. `files`: robot files and recordings. `scans`: poses of a lidar, which are one more reference.
6. `inference`: `legs` and `fitting`, then `comparison`; `diagnosis.diagnosis` is the search for
   what is missing, in one function.
7. `report`: what a verb found, as one document for terminal, page and notebook.
8. `api`: the verbs, for `import werrimbi_odom as wo`. `cli`, `workbench` and `fleet` are shells
   around them.
9. `ros`: the nodes. `driving`: a manoeuvre within limits, for `ros.drive_node`.
10. `simulation`: a robot in a physics engine. It imports nothing of ours, so that tests are fair.

Imports run one way: the core (`model`) needs numpy alone, and `make lint` checks the layers.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from werrimbi_odom.api.arrays import write_run
    from werrimbi_odom.api.calibrate import calibrate_fit, calibrate_noise
    from werrimbi_odom.api.calibrate_umbmark import calibrate_umbmark
    from werrimbi_odom.api.compare_diagnose_add import add, compare, diagnose
    from werrimbi_odom.api.draft import draft
    from werrimbi_odom.api.drives import read_robot, read_run
    from werrimbi_odom.api.history import history
    from werrimbi_odom.api.info import info
    from werrimbi_odom.api.odom import odom, odometry
    from werrimbi_odom.effects.library import LIBRARY as EFFECTS
    from werrimbi_odom.errors import InputError
    from werrimbi_odom.model.effect import (
        Effect,
        Parameter,
        body_effect,
        reference_effect,
        wheel_effect,
    )

_WHERE = {
    "read_robot": "api.drives",
    "read_run": "api.drives",
    "write_run": "api.arrays",
    "odom": "api.odom",
    "odometry": "api.odom",
    "compare": "api.compare_diagnose_add",
    "diagnose": "api.compare_diagnose_add",
    "add": "api.compare_diagnose_add",
    "draft": "api.draft",
    "calibrate_fit": "api.calibrate",
    "history": "api.history",
    "info": "api.info",
    "calibrate_noise": "api.calibrate",
    "calibrate_umbmark": "api.calibrate_umbmark",
    "Effect": "model.effect",
    "Parameter": "model.effect",
    "wheel_effect": "model.effect",
    "body_effect": "model.effect",
    "reference_effect": "model.effect",
    "InputError": "errors",
}
"""Module of each name; imported at first use, so that the node stays light."""

__all__ = [
    "EFFECTS",
    "Effect",
    "InputError",
    "Parameter",
    "add",
    "body_effect",
    "calibrate_fit",
    "calibrate_noise",
    "calibrate_umbmark",
    "compare",
    "diagnose",
    "draft",
    "history",
    "info",
    "odom",
    "odometry",
    "read_robot",
    "read_run",
    "reference_effect",
    "wheel_effect",
    "write_run",
]


def __getattr__(name: str) -> Any:
    if name == "EFFECTS":
        return import_module("werrimbi_odom.effects.library").LIBRARY
    if name not in _WHERE:
        raise AttributeError(f"module 'werrimbi_odom' has no attribute {name!r}")
    return getattr(import_module(f"werrimbi_odom.{_WHERE[name]}"), name)


def __dir__() -> list[str]:
    return sorted(__all__)
