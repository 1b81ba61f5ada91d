# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Diagnosis: which physical effect is missing from the model.

It consists of the set-up search, the evidence map, score tests, forward selection and the verdict.
Reading order: `diagnosis` (the whole of it), `forward_selection`, `evidence` (the map) with
`step_jacobians`, `penalised_likelihood` (selection of models), `cross_validation`, `homogeneity`,
`rivals`, `ranking`, `verdict`, `uncertainty` (every ± that is stated), `result`.
The statistics are in docs/method.md, section 4.
"""
