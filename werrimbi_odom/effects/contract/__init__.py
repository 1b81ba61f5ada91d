# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The laws that every effect must keep, a user's own too; `check_effect` tests one effect.

Fits, the diagnosis and the node rely on these laws: a live drive equals a recorded one, no result
depends on how often the counters were read, an effect at its null values changes nothing.

Begin with `check`; `laws` has the laws themselves.
"""

from werrimbi_odom.effects.contract.check import check_effect

__all__ = ["check_effect"]
