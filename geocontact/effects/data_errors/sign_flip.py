"""A channel with its sign reversed: every trial, or some only.

output → -output; an input is turned back before the model sees it. No parameter: discrete.
"""

from __future__ import annotations

from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.system import System
from geocontact.effects.data_errors.data_error import REVERSAL, input_error, output_error
from geocontact.effects.data_errors.unit_error import input_over, output_times


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate per channel."""
    outputs = [
        output_error("sign_flip", name, REVERSAL, output_times(column, -1.0), name, -1.0)
        for column, name in enumerate(system.outputs)
    ]
    inputs = [
        input_error("sign_flip", name, input_over(system.inputs.index(name), -1.0), name, -1.0)
        for name in system.driving
    ]
    return (*outputs, *inputs)


SIGN_FLIP = Effect(
    "sign_flip",
    "data",
    offer,
    "sense of axes that two devices do not share",
)
