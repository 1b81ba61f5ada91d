# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded drives cut into legs: one clock for ticks and reference, gaps, ends of legs.

Reading order: `cutting` (the legs) with `aligned_run` and `matched_run`, `gaps`, `usable_run` (what
of a run can be judged), `clock_rate`, `held_or_carried` (held and carried robots) with `agreement`,
`displacement_agreement` and `measured_motion`, `reference_lapses`, `noisy_phases` and `stray_poses`
(poses that are wrong), `even_stamps` (stamps of arrival put right) with `lost_messages` and
`queued_messages`, `counter_jumps` (counters that leap).
"""
