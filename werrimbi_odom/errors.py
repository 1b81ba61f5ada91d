# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The one family of errors that a user can mend; the command line turns them into one line."""

from __future__ import annotations


class InputError(ValueError):
    """Something given by the user cannot be used; the message names the place and the mend."""
