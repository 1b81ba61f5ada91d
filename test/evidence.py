# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of tests that `make evidence` alone tries."""

from __future__ import annotations

from typing import Any

import pytest


def in_evidence(*values: Any, **more: Any) -> Any:
    """A parameter set, as by `pytest.param`, that is left out of `make test`."""
    return pytest.param(*values, marks=pytest.mark.evidence, **more)
