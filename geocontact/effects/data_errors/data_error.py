"""How a discrete mistake in the data becomes a candidate: no parameters, and it may sit in some trials only."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate
from geocontact.chain.links import RECORDING, Channels, Modifier, Values
from geocontact.chain.system import System
from geocontact.effects.parts import with_motion, with_sensor

MIX_UP, REVERSAL, SWAP = RECORDING + 10.0, RECORDING + 20.0, RECORDING + 30.0
"""Ranks of mistakes; all come after what a recording leaves out."""


def output_error(
    name: str,
    variant: str,
    rank: float,
    change: Callable[[Channels, DifferentiatedInputs, Values], Channels],
    channel: str = "",
    factor: float = 1.0,
) -> Candidate:
    """A mistake in measured outputs."""
    modifier = Modifier(f"{name}.{variant}", rank, change)

    def somewhere(trials: frozenset[str] | None) -> Callable[[System], System]:
        return with_sensor(replace(modifier, trials=trials))

    return Candidate(name, variant, "data", (), somewhere(None), somewhere=somewhere, channel=channel, factor=factor)


def input_error(
    name: str,
    variant: str,
    change: Callable[[DifferentiatedInputs, DifferentiatedInputs, Values], DifferentiatedInputs],
    channel: str = "",
    factor: float = 1.0,
) -> Candidate:
    """A mistake in a measured input, undone before the model sees it and before anything else acts on the motion."""
    modifier = Modifier(f"{name}.{variant}", 0.0, change)

    def somewhere(trials: frozenset[str] | None) -> Callable[[System], System]:
        return with_motion(replace(modifier, trials=trials))

    return Candidate(name, variant, "data", (), somewhere(None), somewhere=somewhere, channel=channel, factor=factor)
