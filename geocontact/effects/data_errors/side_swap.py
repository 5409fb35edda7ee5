"""Two channels exchanged: every trial, or some only.

Of the knee its two sides. The foot has no two sides; what can be exchanged are its two force channels. The elbow has
one output: no candidate.
No parameter: discrete.
"""

from __future__ import annotations

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.links import Channels, Values
from geocontact.chain.system import System
from geocontact.effects.data_errors.data_error import SWAP, output_error
from geocontact.effects.parts import load_channels


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate per pair of force channels."""
    forces = load_channels(system)
    return tuple(swapped(system, a, b) for i, a in enumerate(forces) for b in forces[i + 1 :])


def swapped(system: System, a: str, b: str) -> Candidate:
    """Exchange of two outputs."""
    order = list(range(len(system.outputs)))
    i, j = system.outputs.index(a), system.outputs.index(b)
    order[i], order[j] = j, i

    def change(outputs: Channels, _: DifferentiatedInputs, __: Values) -> Channels:
        return outputs[:, order]

    return output_error("side_swap", f"{a}_{b}", SWAP, change)


SIDE_SWAP = Effect("side_swap", "data", offer, "cables of two channels of one device exchanged")
