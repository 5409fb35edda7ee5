"""What every injected effect says of itself, what it asks of a system, and where it is drawn to sit."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from geocontact.gap_benchmark.synthetic.hooks import Hooks

Rng = np.random.Generator
Range = tuple[float, float]
EVERYWHERE = 0.25
"""Share of effects that may stand at all places which do."""
COMMON = (
    "time_shift",
    "filter_lag",
    "motion_offset",
    "relaxation",
    "sensor_gain",
    "sensor_offset",
    "sensor_drift",
    "saturation",
)
"""Effects of the vocabulary that any system may have."""
STRAPPED = (
    "series_compliance",
    "stiffening",
    "damping",
    "dry_friction",
    "dead_zone",
    "end_stop",
    "preload",
    "slip",
)
"""Those of an interface that is strapped to a limb."""
COMMON_UNKNOWN = ("tremor", "held_samples", "burst", "quantisation", "jump", "wander")
"""Effects outside of it that any system may have."""


class NotFoundError(RuntimeError):
    """No amplitude of this draw gives what is asked for."""


@dataclass(frozen=True)
class Biased:
    """An input that may be biased: row, largest bias, unit; and the angle that the bias varies with, its middle, w."""

    name: str
    row: int
    most: float
    unit: str
    by: int
    middle: float
    width: float


@dataclass(frozen=True)
class DriftingLength:
    """The length of the base model that changes where an axis drifts.

    Parameters
    ----------
    letter
        What it is called.
    most
        Largest slope over the angle [m/rad]; with `over_range` largest change over half the range of the angle [m].
    ripple
        Factor on how far the path ripples.
    hanging
        Whether the length is that of the hanging arm, so that the path begins there and ripples 2.5 times as far.
    """

    letter: str
    most: float
    over_range: bool = False
    ripple: float = 1.8
    hanging: bool = False


@dataclass(frozen=True)
class SeriesSpring:
    """A spring in series with an interface.

    Parameters
    ----------
    softest
        Largest compliance, in `unit`.
    later
        Of the share that was drawn and the departure: share of the compliance that is left at large loads.
    """

    softest: Callable[[SyntheticMagnitudes], float]
    later: Callable[[float, float], float] = lambda share, _: share
    unit: str = "m/N"


STRAP_IN_SERIES = SeriesSpring(
    lambda scale: scale.stroke / scale.force, lambda share, departure: 1.0 - departure * (1.0 - share)
)
"""Compliance in series of a strap: base parameters take most of a linear spring away."""


@dataclass(frozen=True)
class EffectNumbers:
    """Which effects a system may have, and what of their equations and sizes is its own.

    Parameters
    ----------
    names, unknown
        Effects of the vocabulary, and outside of it.
    confounded
        Those that base parameters reproduce nearly, if they are of a plain form.
    no_gap
        Those of them that leave no visible gap of their own kind: never planted as a single one or in a pair.
    biased
        Inputs that may be biased.
    on_ground
        Whether loads are those of spheres on level ground: forward, upward, and a centre of pressure.
    hinge
        Lever of what acts at the hinge of an exoskeleton's arm [m]; 0 where there is none.
    sides
        Whether two sides carry the load, each by its own area.
    either_way
        Whether an interface that opens may be pressed from either side.
    axis, series
        None where the effect does not apply.
    quick, apart, uneven
        Relaxation: shorter time [s], factor to the longer one, how far it depends on the load.
    thinning, thinning_departs, leaning
        Damping: rate v1 over the rms rate; whether it is larger for a smaller departure; factor on how it leans, the
        departure where None.
    softer
        Dead zone: factor on how soft its edges are.
    lossy
        End stop: factor on what rubber loses.
    relaxing
        Preload: factor on how far it relaxes.
    lagging
        Stiffening: factor on its hysteresis.
    hanging
        Weight: factor on the second mass that swings.
    lever, heaviest
        Mass at the sensor: constant that says where it sits, and the largest [kg].
    coupling, uneven_coupling
        Crosstalk: time of the slow part [s], how far it depends on the load.
    gains, gained, gained_together
        Gain error: how far it depends on the load, by output; rows that are drawn from, all loads where (); whether
        base parameters take it of one force, so that for a small departure both forces have it.
    clipped, recovery, slow
        Saturation: rows that are drawn from, all loads where (); time [s] and share of what comes later.
    zero, wander
        Largest zero error as a share of the largest output; how far it wanders.
    latest
        Longest delay [s]; 0.06 of a trial and 0.35 s at most where None.
    pitch
        Tremor: frequency [Hz].
    """

    names: tuple[str, ...]
    unknown: tuple[str, ...]
    biased: Callable[[SyntheticMagnitudes], tuple[Biased, ...]]
    quick: Range
    apart: Range
    gains: tuple[float, ...]
    recovery: Range
    pitch: Range
    confounded: tuple[str, ...] = ()
    no_gap: tuple[str, ...] = ()
    on_ground: bool = False
    hinge: float = 0.0
    sides: bool = False
    either_way: bool = False
    axis: DriftingLength | None = None
    series: SeriesSpring | None = None
    uneven: Range | None = None
    thinning: Range = (1.0, 1.0)
    thinning_departs: bool = False
    leaning: float | None = None
    softer: float = 1.0
    lossy: float = 1.0
    relaxing: float = 1.0
    lagging: float = 1.0
    hanging: float = 1.0
    lever: str = ""
    heaviest: float = 8.0
    coupling: Range = (0.0, 0.0)
    uneven_coupling: Range | None = None
    gained: tuple[int, ...] = ()
    gained_together: bool = False
    clipped: tuple[int, ...] = ()
    slow: Range = (0.45, 0.6)
    zero: float = 0.15
    wander: Range = (0.16, 0.3)
    latest: float | None = None


@dataclass(frozen=True)
class SyntheticMagnitudes:
    """Magnitudes of a case in the base model.

    numbers: what effects ask of the system; force, stroke [m], rate [m/s]: largest load, largest deflection, rms rate
    of deflection; low, high: its extremes; duration, step [s]; output: largest magnitude per channel; acceleration: rms
    of the first input's; middle: of it; span: half its range; loads: outputs that are forces; places: the same for each
    of several interfaces, whose first input is the angle of its own; `departure` in 0..1 scales how far an effect
    departs from the plain law.
    """

    numbers: EffectNumbers
    force: float
    stroke: float
    low: float
    high: float
    rate: float
    duration: float
    step: float
    output: dict[str, float]
    acceleration: float
    middle: float
    departure: float = 1.0
    span: float = 1.0
    loads: tuple[int, ...] = (0,)
    places: Mapping[str, SyntheticMagnitudes] = field(default_factory=dict)

    @property
    def latest(self) -> float:
        """Longest delay that is planted [s]."""
        return min(0.35, 0.06 * self.duration) if self.numbers.latest is None else self.numbers.latest

    def load(self, rng: Rng) -> int:
        """One of the outputs that are forces, by row."""
        return self.loads[0] if len(self.loads) == 1 else int(rng.choice(self.loads))

    def load_of(self, rng: Rng, rows: tuple[int, ...]) -> int:
        """One of these rows, of the outputs that are forces where there are none."""
        return int(rng.choice(rows)) if rows else self.load(rng)


@dataclass(frozen=True)
class Draw:
    """An effect with its shape settled and its amplitude open, which may be anything in `low`..`high`."""

    low: float
    high: float
    hooks: Callable[[float], Hooks]
    words: Callable[[float], str]
    variant: str = ""


@dataclass(frozen=True)
class InjectionPlan:
    """An injected effect: name of the vocabulary, the equation planted, the candidate's, and how to draw one.

    Of several interfaces one that is `placed` sits at one, or, where it may stand `together`, now and then at all.
    """

    name: str
    planted: str
    candidate: str
    draw: Callable[[Rng, SyntheticMagnitudes], Draw]
    placed: bool = False
    together: bool = False

    def drawn(self, rng: Rng, scale: SyntheticMagnitudes) -> Draw:
        """Shape, and the place where there are several."""
        if not self.placed or not scale.places:
            return self.draw(rng, scale)
        names = tuple(scale.places)
        everywhere = self.together and rng.random() < EVERYWHERE
        chosen = names if everywhere else (names[rng.integers(len(names))],)
        seed = int(rng.integers(2**62))  # alike in kind: magnitudes are those of each place
        draws = {name: self.draw(np.random.default_rng(seed), scale.places[name]) for name in chosen}
        first = draws[chosen[0]]
        where = "every site" if everywhere else chosen[0]
        parts = [] if everywhere else [chosen[0]]
        return Draw(
            max(one.low for one in draws.values()),
            min(one.high for one in draws.values()),
            lambda size: Hooks(places={name: one.hooks(size) for name, one in draws.items()}),
            lambda size: f"{where}: {first.words(size)}",
            ".".join([first.variant, *parts] if first.variant else parts),
        )
