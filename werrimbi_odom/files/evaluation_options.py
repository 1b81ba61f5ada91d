# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How a model is evaluated on drives: common options for compare, diagnose, add and fit."""

from __future__ import annotations

from dataclasses import dataclass

from werrimbi_odom.files.run import ReferenceKind
from werrimbi_odom.model.encoder_online import EncoderLimits

LEAST, MOST = 1e-9, 1e6
"""Range of a leg and of the reference's standard deviations: squares are finite and not zero."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EvaluationOptions:
    """Length of the legs for the relative pose error, and properties of the reference."""

    reference_kind: ReferenceKind = "absolute"
    """Noise of the reference: independent per pose, accumulating, or that of a local map."""
    leg: float = 1.0
    """Length of a leg [m]; a quarter turn on the spot is a leg too."""
    limits: EncoderLimits | None = None
    """Limits for jumps of the counters; None: no limit (`EncoderLimits()`)."""
    sigma_xy: float | None = None
    """Noise of the reference in x and y, if known [m]; otherwise as stated in the record; otherwise
    estimated from differences of the reference alone, so that it does not contain errors of the
    model."""
    sigma_yaw: float | None = None
    """The same for heading [rad]."""

    @property
    def sigmas_known(self) -> tuple[bool, bool]:
        """Whether the reference's noise is known, in position and in heading."""
        return self.sigma_xy is not None, self.sigma_yaw is not None
