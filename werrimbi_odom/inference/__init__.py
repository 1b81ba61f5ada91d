# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From measurements back to the robot; no ROS and no plots.

Each folder imports only from those after it: `drafting` (an effect written from the evidence),
`adding` (an effect fitted and judged), `manoeuvres` (what to drive next), `calibration` (the
paper's and maximum likelihood), `changes` (between drives), `diagnosis` (which effect is missing),
`set_up` (set-up mistakes), `comparison` (errors of legs), `events` (sudden errors), `fitting`
(maximum likelihood), `legs` (where drives are cut), `rules` (every number that decides something).

Begin with `diagnosis.diagnosis`. docs/method.md has the statistics.
"""
