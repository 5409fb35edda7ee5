"""Measured outputs lag the inputs by a constant delay.

output(t) → output(t - d), d >= 0: outputs cannot come early. Between samples by cubic Hermite interpolation; before the
first sample the output is taken to have run straight, within its range in the trial. A constant delay has no shape.
"""

from __future__ import annotations

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.history import delayed
from geocontact.chain.links import Channels, Modifier, Values
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_sensor

RANK = 70.0
LONGEST = 50.0
"""Samples that outputs may lag."""


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate: amplitude d."""
    most = min(LONGEST * system.scale.step, 0.25 * system.scale.duration)
    delay = Parameter("time_shift.delay", "s", min(2.0 * system.scale.step, 0.2 * most), 0.0, most)

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        return delayed(movement.time, outputs, values[delay.name])

    link = with_sensor(Modifier("time_shift", RANK, change, apart=True))
    others = ({delay.name: 0.4 * most},)
    return (Candidate("time_shift", "", "timing", (delay,), link, {delay.name: 0.0}, others),)


TIME_SHIFT = Effect("time_shift", "timing", offer, "unsynchronised recorders")
