# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Base, radii and wheel noise: the paper's two procedures, and maximum likelihood.

`umbmark` (squares; `umbmark_equations` has the paper's), `out_and_back` (noise), `any_driving`
(maximum likelihood from any drives with a reference).
"""
