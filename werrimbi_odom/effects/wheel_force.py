# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Force that a wheel must pass to the floor in a start, along and of a turn.

With mass m, moment of inertia I about the vertical and base b it is m a / 2 along and I alpha / b
in a turn, against each other on the two sides. In units of m / 2 that is the acceleration of the
robot along, and `TURNING` times what the wheel's own has beyond it.
"""

from __future__ import annotations

from werrimbi_odom.model.effect import Parameter

TURNING = Parameter(
    "",
    null=1.0,
    typical=1.0,
    bounds=(0.0, 4.0),
    says="share that counts of a wheel's acceleration beyond the robot's: moment of inertia over "
    "mass * (base / 2)^2",
    tries=(1.0,),
    refines=True,
)
"""1 where the masses stand over the wheels, 0.3 to 0.8 where they stand between them, more on a
body that is longer than the base: 3.3 at three times."""
