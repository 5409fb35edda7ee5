"""A simulator that is not ours: inputs and numbers in, outputs out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float


class SimulatorError(RuntimeError):
    """It gave no result for these inputs and numbers; the message says what it did instead."""


@runtime_checkable
class Simulator(Protocol):
    """What a case may bring in place of one of our models."""

    @property
    def inputs(self) -> tuple[str, ...]:
        """Channels that drive it."""

    @property
    def outputs(self) -> tuple[str, ...]:
        """Channels that it predicts."""

    @property
    def units(self) -> Mapping[str, str]:
        """SI unit of each channel."""

    def run(
        self, time: Float[np.ndarray, " t"], inputs: Float[np.ndarray, "i t"], numbers: Mapping[str, float]
    ) -> Float[np.ndarray, "t c"]:
        """Outputs at the times of the inputs; SimulatorError where there are none."""
