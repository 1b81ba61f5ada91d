# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Inference: from measurements back to the robot. Independent of ROS and of plotting.

Each folder imports only from those after it: `drafting` (write an effect from the evidence),
`adding` (put an effect in and judge it), `manoeuvres` (what to drive next), `calibration` (UMBmark,
and from any driving), `changes` (from drive to drive), `diagnosis` (which effect is missing),
`set_up` (mistakes in the robot file that no derivative shows), `comparison` (odometry errors over
legs), `events` (sudden changes), `fitting`, `legs` (cutting drives into legs), `rules` (every
number that decides something).
"""
