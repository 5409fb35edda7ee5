"""The clock of the outputs slips within a trial, or runs at another rate than that of the inputs.

output(t) → output(t - d(t)), t from the start of the trial of duration T. "once": d is 0 before the share `when` of the
trial and `delay` after it, linear over `PASSAGE` of the trial between the two, or over |delay| where that is longer, so
that time never runs backwards: frames that came late, delay > 0, or
samples of the outputs that were lost, delay < 0. "steady": d = rate t, a clock that runs slow or fast. Between samples
by cubic Hermite interpolation; before the first sample the output is taken to have run straight, after the last one to
stay. Every trial slips alike.
"""

from __future__ import annotations

import numpy as np

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.history import read_at
from geocontact.chain.links import Channels, Modifier, Values
from geocontact.chain.magnitudes import Magnitudes
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.measurement.time_shift import LONGEST
from geocontact.effects.parts import with_sensor

RANK = 75.0
PASSAGE = 0.04
"""Share of a trial: a slip at one sample could not be searched for by its slope."""
WHEN = 0.1, 0.9
"""Share of a trial within which a slip is no constant delay."""
PLACES = (0.25, 0.4, 0.6, 0.75)
"""Shares of a trial from which a slip is searched, beside its middle."""
FASTEST = 0.1
"""Rate of one clock over that of the other, less 1."""


def once(system: System) -> Candidate:
    """Amplitude delay, shape when."""
    most = min(LONGEST * system.scale.step, 0.25 * system.scale.duration)
    delay = Parameter("clock_slip.once.delay", "s", min(2.0 * system.scale.step, 0.2 * most), -most, most)
    when = Parameter("clock_slip.once.when", "-", 0.5, *WHEN)

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        if values[delay.name] == 0.0:
            return outputs
        time = movement.time
        phase = (time - time[0]) / (time[-1] - time[0])
        passage = max(PASSAGE, abs(values[delay.name]) / (time[-1] - time[0]))
        slipped = np.clip((phase - values[when.name]) / passage + 0.5, 0.0, 1.0)
        return np.asarray(read_at(time, outputs, time - values[delay.name] * slipped))

    link = with_sensor(Modifier("clock_slip.once", RANK, change, apart=True))
    others = tuple({when.name: place} for place in PLACES)
    return Candidate("clock_slip", "once", "timing", (delay, when), link, {delay.name: 0.0}, others)


def fastest(scale: Magnitudes) -> float:
    """Largest rate of a clock that is sought: in pieces of trials, where inputs reach no further, `LONGEST` in all."""
    return min(FASTEST, LONGEST * scale.step / scale.duration) if scale.in_pieces else FASTEST


def steady(system: System) -> Candidate:
    """Amplitude rate."""
    most = fastest(system.scale)
    rate = Parameter("clock_slip.steady.rate", "-", 0.05 * most, -most, most)

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        if values[rate.name] == 0.0:
            return outputs
        time = movement.time
        return np.asarray(read_at(time, outputs, time - values[rate.name] * (time - time[0])))

    link = with_sensor(Modifier("clock_slip.steady", RANK, change, apart=True))
    others = ({rate.name: -rate.start},)
    return Candidate("clock_slip", "steady", "timing", (rate,), link, {rate.name: 0.0}, others)


def offer(system: System) -> tuple[Candidate, ...]:
    """Two candidates."""
    return once(system), steady(system)


CLOCK_SLIP = Effect("clock_slip", "timing", offer, "frames that a recorder drops, clocks that are not synchronised")
