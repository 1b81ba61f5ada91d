# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`make demo`: a recording through the real node, then the round on a robot in the engine."""
