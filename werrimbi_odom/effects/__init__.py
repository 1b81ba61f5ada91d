# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The library of physical effects.

Each file has one effect, or a pair for left and right: a model of a few lines, its parameters, and
a page of text. Begin with `lateral_slip`. `library` lists all effects, `lookup` finds them and
those of other packages, and `contract` has the properties ("laws") that every effect must have.
"""

from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.effects.lookup import Collection, all_effects, find
from werrimbi_odom.effects.user_effects import load_file

__all__ = ["LIBRARY", "Collection", "all_effects", "find", "load_file"]
