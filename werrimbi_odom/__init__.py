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
6. `files`, `ros`, `report`, `workbench`, `fleet`, `cli`: shells that read, write and show, of one
   robot or of many.
7. `simulation`: a robot in a physics engine; imports nothing of ours, so that tests are honest.
"""
