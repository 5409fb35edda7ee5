"""Outputs passed through a first- or second-order low-pass.

Two first-order stages in a row with time constants tau (1 - r/2) and tau r/2, r = order - 1: the lag tau >= 0 of slow
signals is the amplitude, the order in 1..2 the shape; order 2 is critically damped. The corner of order 1 is
1/(2 pi tau) Hz. Between samples outputs run along a cubic.
"""

from __future__ import annotations

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.history import lagged
from geocontact.chain.links import Channels, Modifier, Values
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_sensor

RANK = 30.0
LONGEST = 50.0
"""Samples that outputs may lag."""


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate: amplitude tau, shape order."""
    most = min(LONGEST * system.scale.step, 0.25 * system.scale.duration)
    lag = Parameter("filter_lag.lag", "s", min(2.0 * system.scale.step, 0.2 * most), 0.0, most)
    order = Parameter("filter_lag.order", "-", 1.2, 1.0, 2.0)

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        return lagged(movement.time, outputs, values[lag.name], values[order.name])

    link = with_sensor(Modifier("filter_lag", RANK, change, apart=True))
    others = ({lag.name: 0.3 * most},)
    return (Candidate("filter_lag", "", "sensor", (lag, order), link, {lag.name: 0.0}, others),)


FILTER_LAG = Effect(
    "filter_lag",
    "sensor",
    offer,
    "anti-alias and smoothing filters of amplifiers",
)
