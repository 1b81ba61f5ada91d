# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheel odometry that knows how wrong it is, and can tell its user why.

Ticks become wheel travel, travel becomes motion pieces (line, arc, spin), and pieces become a pose
with the closed-form covariance of Chong and Kleeman (ICRA 1997). Legs of a drive compare it with
what was measured, and the difference tells which physical effect is missing.

Reading order
-------------
1. `model.motion`, `model.covariance`: the physics of one piece, in formulas.
2. `model.odometer`: `Odometer.update` is the whole story, one tick message at a time.
3. `model.trajectory`: the same for a recorded run, all rows at once.
4. `effects`: one physical effect a file; travel passes through those that the robot holds.
5. `inference.fitting`, `inference.comparison`: legs, predictions, fits; then `inference.diagnosis`:
   `diagnosis.diagnose` is the search for what is missing, told in one function.
6. `api`: the verbs, for `import werrimbi_odom as wo`; `cli`, `workbench` and `fleet` are shells
   over them, of one robot or of many; `files`, `ros` and `report` read, write and show. `scans`
   makes poses of a lidar's scans, which are a reference like any other.
7. `simulation`: a robot in a physics engine; imports nothing of ours, so that tests are honest.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from werrimbi_odom.api.calibrate import calibrate_fit, calibrate_noise
    from werrimbi_odom.api.calibrate_umbmark import calibrate_umbmark
    from werrimbi_odom.api.draft import draft
    from werrimbi_odom.api.drives import read_robot, read_run
    from werrimbi_odom.api.history import history
    from werrimbi_odom.api.info import info
    from werrimbi_odom.api.odom import odom, odometry
    from werrimbi_odom.api.verbs import add, compare, diagnose
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
    "odom": "api.odom",
    "odometry": "api.odom",
    "compare": "api.verbs",
    "diagnose": "api.verbs",
    "add": "api.verbs",
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
"""Where each name is; nothing is imported before it is used, so that the node stays light."""

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
]


def __getattr__(name: str) -> Any:
    if name == "EFFECTS":
        return import_module("werrimbi_odom.effects.library").LIBRARY
    if name not in _WHERE:
        raise AttributeError(f"module 'werrimbi_odom' has no attribute {name!r}")
    return getattr(import_module(f"werrimbi_odom.{_WHERE[name]}"), name)


def __dir__() -> list[str]:
    return sorted(__all__)
