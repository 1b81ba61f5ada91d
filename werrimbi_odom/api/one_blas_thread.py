# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Limit the linear algebra of a function to one thread, as the command line limits its process."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

Given = ParamSpec("Given")
Found = TypeVar("Found")


def with_one_blas_thread(work: Callable[Given, Found]) -> Callable[Given, Found]:
    """Run a function with one BLAS thread.

    The matrices are small, and drives are processed side by side already: more threads mostly wait
    for each other. Their number also changes the order of sums, and so the last digits. Without
    threadpoolctl, which rosdep does not bring, nothing is limited.
    """

    @wraps(work)
    def limited(*args: Given.args, **kwargs: Given.kwargs) -> Found:
        import scipy.linalg  # noqa: F401  its BLAS must be there to be limited

        try:
            from threadpoolctl import threadpool_limits
        except ModuleNotFoundError:
            return work(*args, **kwargs)
        with threadpool_limits(1, user_api="blas"):
            return work(*args, **kwargs)

    return limited
