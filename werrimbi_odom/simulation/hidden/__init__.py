# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects hidden in a simulated robot, as test data for the diagnosis.

`hidden_effect` defines where in a simulated drive an effect can act, `catalogue` lists all effects
with units and realistic strengths, and `hiding` draws from them; each other file has one family.
"""

from .catalogue import CATALOGUE, Entry
from .hidden_effect import Peculiarity
from .hiding import Hidden, StrengthError, UnknownEffectError, WishError, find, hide, wished

__all__ = [
    "CATALOGUE", "Entry", "Hidden", "Peculiarity", "StrengthError", "UnknownEffectError",
    "WishError", "find", "hide", "wished",
]  # fmt: skip
