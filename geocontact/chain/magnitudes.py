"""How large things are in a set of trials: what bounds of effects are stated in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.links import Geometry
from geocontact.data.trial import Trial


@dataclass(frozen=True)
class Magnitudes:
    """Magnitudes over all trials, SI; ones where there are no trials yet.

    Parameters
    ----------
    deflection, low, high
        Largest magnitude of a deflection without load, and its least and greatest value, in the law's unit (m).
    rate
        Root mean square of its rate while deflected (m/s).
    duration, step
        Longest trial and typical (median) sample step [s].
    output
        Largest magnitude of each measured channel.
    centre, span, speed
        Middle and half-range of each input, and root mean square of its rate.
    places
        The same for each place of a system that has several.
    in_pieces
        Whether inputs are known around pieces of the trials only (`data.trial`).

    Examples
    --------
    >>> import geocontact as gc
    >>> scale = gc.chain.Magnitudes(deflection=0.35, output={"torque": 18.0})
    >>> scale.of("torque"), scale.of("another")
    (18.0, 1.0)
    """

    deflection: float = 1.0
    low: float = -1.0
    high: float = 1.0
    rate: float = 1.0
    duration: float = 1.0
    step: float = 0.01
    output: Mapping[str, float] = field(default_factory=dict)
    centre: Mapping[str, float] = field(default_factory=dict)
    span: Mapping[str, float] = field(default_factory=dict)
    places: Mapping[str, Magnitudes] = field(default_factory=dict)
    speed: Mapping[str, float] = field(default_factory=dict)
    in_pieces: bool = False

    def of(self, channel: str) -> float:
        """Magnitude of a channel, 1 when it is not known."""
        return self.output.get(channel, 1.0)


def positive(value: float) -> float:
    """`value`, or 1 when it is no use as a scale."""
    return value if np.isfinite(value) and value > 0.0 else 1.0


def measured_magnitude(trials: Sequence[Trial], channel: str) -> float:
    """Largest magnitude of a channel; 1 where it was not measured."""
    values = [t.column(channel) for t in trials if channel in t.signals.channels]
    finite = [np.abs(v[np.isfinite(v)]) for v in values]
    return positive(max((float(v.max()) for v in finite if v.size), default=1.0))


def rms_rate(movements: Sequence[DifferentiatedInputs], name: str) -> float:
    """Root mean square of the rate of an input over all trials."""
    rates = np.concatenate([m.rate[m.row(name)] for m in movements])
    return positive(float(np.sqrt(np.mean(rates**2))))


def magnitudes_of(
    geometry: Geometry,
    outputs: tuple[str, ...],
    trials: Sequence[Trial],
    movements: Sequence[DifferentiatedInputs],
    values: Sequence[Mapping[str, float]],
) -> Magnitudes:
    """Magnitudes over `trials`, with deflections at `values`, the numbers known in each of them."""
    if not trials:
        return Magnitudes()
    pairs = [geometry.deflection(movement, known) for movement, known in zip(movements, values, strict=True)]
    deflection = np.concatenate([d.ravel() for d, _ in pairs])
    rate = np.concatenate([r.ravel() for _, r in pairs])[deflection != 0.0]
    inputs = movements[0].inputs
    least = {name: min(float(m.position[m.row(name)].min()) for m in movements) for name in inputs}
    most = {name: max(float(m.position[m.row(name)].max()) for m in movements) for name in inputs}
    return Magnitudes(
        deflection=positive(float(np.abs(deflection).max())),
        low=float(deflection.min()),
        high=float(deflection.max()),
        rate=positive(float(np.sqrt(np.mean(rate**2))) if rate.size else 0.0),
        duration=positive(max(float(m.time[-1] - m.time[0]) for m in movements)),
        step=positive(float(np.median(np.concatenate([np.diff(m.time) for m in movements])))),
        output={name: measured_magnitude(trials, name) for name in outputs},
        centre={name: 0.5 * (least[name] + most[name]) for name in inputs},
        span={name: positive(0.5 * (most[name] - least[name])) for name in inputs},
        speed={name: rms_rate(movements, name) for name in inputs},
        in_pieces=any(trial.pieces for trial in trials),
    )
