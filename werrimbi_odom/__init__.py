# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheel odometry that knows how wrong it is, and can tell its user why.

Ticks become wheel travel, travel becomes motion pieces (line, arc, spin), and pieces become a pose
with the closed-form covariance of Chong and Kleeman (ICRA 1997).

Reading order
-------------
1. `model.motion`, `model.covariance`: the physics of one piece, in formulas.
2. `model.odometer`: `Odometer.update` is the whole story, one tick message at a time.
3. `model.trajectory`: the same for a recorded run, all rows at once.
4. `files`, `ros`, `cli`: thin shells that read and write; none of them knows physics.
5. `simulation`: a robot in a physics engine; imports nothing of ours, so that tests are honest.
"""
