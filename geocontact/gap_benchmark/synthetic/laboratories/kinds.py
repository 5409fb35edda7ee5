"""Kinds of laboratories, each a combination of what a laboratory may have; which of them thresholds may be chosen on.

On kinds at *home* thresholds of the diagnosis may be chosen and changed. Kinds *abroad* are for reporting only: whoever
changes the diagnosis because of a case there puts that kind at home and adds another. No kind abroad has a noise and a
clock together that a kind at home has, and knocks, warming up and the second family of effects are abroad only.

Kinds abroad have been reported on more than once. *Fresh* kinds were added for a report on kinds that no version of the
diagnosis has seen: none has a noise and a clock together that another side has, and their noises, and the samplers,
movements, mixed steps and numbers of trials that were added for them, are on no other side. Once they were reported on
they are kinds abroad as the others are.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from geocontact.gap_benchmark.synthetic.laboratories.elsewhere import (
    FLAG,
    LENGTH,
    another_device,
    noticed,
    placement_of,
    sampled,
    sampled_unseen,
    sizes,
)
from geocontact.gap_benchmark.synthetic.laboratories.movements import moving
from geocontact.gap_benchmark.synthetic.laboratories.recorder import (
    at_another_rate,
    growth_of,
    hurry_of,
    other_filters,
    power_law_noise,
    quieter,
    quotients_of,
)
from geocontact.gap_benchmark.synthetic.laboratory import Forms, Laboratory, Placement, WarmUp
from geocontact.gap_benchmark.synthetic.noise import (
    FAR_FROM_NYQUIST,
    Coloured,
    FilteredNoise,
    Humming,
    Knocked,
    NoiseFilter,
    PowerLawNoise,
    SensorNoise,
    Wandering,
)
from geocontact.gap_benchmark.synthetic.recording import AT_ONCE, Clock, Recorder, Sampler
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene

Side = Literal["home", "abroad", "fresh"]
SIDES: tuple[Side, ...] = ("home", "abroad", "fresh")
Noise = Literal[
    "white", "pink", "mains", "filtered", "growing", "tailed", "knocked", "lasting", "walking", "hurried", "harmonics"
]
Ticking = Literal["even", "uneven", "dropping", "triggered", "averaging", "lagging", "interrupted"]
Steps = Literal["fine", "coarse", "mixed"]
InputFilters = Literal["usual", "six", "raw", "each"]
Trials = Literal["fewest", "few", "usual", "several", "many"]
Motion = Literal["usual", "sweep", "sines", "holds"]
Trouble = Literal["none", "placed", "constants", "warm_up"]


@dataclass(frozen=True)
class LaboratoryKind:
    """What laboratories of a kind have in common; numbers are drawn for each case.

    Parameters
    ----------
    side
        Whether thresholds may be chosen on it.
    noise
        Of outputs. white; pink: 1/f above a white floor; mains: hum beside white noise; filtered: through a low-pass of
        the measuring chain; growing: with the signal; tailed: Student's distribution; knocked: cables are; lasting:
        autoregressive with a long memory; walking: a random walk beside white noise; hurried: larger where the signal
        changes quickly; harmonics: hum with its third harmonic.
    clock
        even; uneven samples; dropping rows; triggered: inputs and outputs have a clock each; averaging: a sample is the
        mean over its interval; lagging: all channels pass a first-order low-pass of a fraction of a sample;
        interrupted: stretches of single outputs are missing.
    steps
        Of the numbers of outputs and inputs: 0.05 to 0.3 of the noise, or 0.5 to 2 (inputs: to 1), or of each channel
        one or the other.
    inputs
        What their noise came through: as the benchmark's own laboratory; 6 Hz; nothing; a filter of each input's own.
    trials
        In all: 4, what a diagnosis asks for (fewest), 4 or 5 (few), 5 or 6 as in the home laboratory (usual), 7 or 8
        (several), 9 to 12 (many).
    trouble
        placed: all sits a little elsewhere in every trial; constants: stated a little wrong, in all trials alike;
        warm_up: gains and zeros settle in the first trials.
    quotient
        Whether a centre of pressure is a noisy moment over a noisy force.
    forms
        Family of the equations that effects are planted by.
    motion
        usual: as at home; or the same way as a sweep of pace, there and back by three sines, or with holds.
    """

    side: Side
    noise: Noise
    clock: Ticking = "even"
    steps: Steps = "fine"
    inputs: InputFilters = "usual"
    trials: Trials = "usual"
    trouble: Trouble = "none"
    quotient: bool = False
    forms: Forms = "first"
    motion: Motion = "usual"


LABORATORY_KINDS: Mapping[str, LaboratoryKind] = {
    "white, rows dropped": LaboratoryKind("home", "white", "dropping", inputs="six"),
    "1/f, coarse, placed anew": LaboratoryKind("home", "pink", steps="coarse", trouble="placed"),
    "growing, uneven clock": LaboratoryKind("home", "growing", "uneven", inputs="each", quotient=True),
    "mains, raw inputs, many trials": LaboratoryKind("home", "mains", inputs="raw", trials="many", trouble="placed"),
    "filtered, coarse, constants off": LaboratoryKind("home", "filtered", steps="coarse", trouble="constants"),
    "heavy tails, two clocks, few trials": LaboratoryKind("home", "tailed", "triggered", trials="few", quotient=True),
    "mains, two clocks, coarse": LaboratoryKind("home", "mains", "triggered", "coarse", "six", quotient=True),
    "1/f, uneven clock, few trials": LaboratoryKind(
        "abroad", "pink", "uneven", inputs="each", trials="few", trouble="placed"
    ),
    "filtered, two clocks, coarse": LaboratoryKind(
        "abroad", "filtered", "triggered", "coarse", "each", quotient=True, forms="second"
    ),
    "filtered, rows dropped, many trials": LaboratoryKind(
        "abroad", "filtered", "dropping", inputs="raw", trials="many", trouble="placed"
    ),
    "knocks, rows dropped": LaboratoryKind("abroad", "knocked", "dropping", inputs="each", forms="second"),
    "growing, coarse, constants off": LaboratoryKind(
        "abroad", "growing", steps="coarse", inputs="six", trouble="constants", quotient=True
    ),
    "white, uneven clock, raw inputs": LaboratoryKind("abroad", "white", "uneven", "coarse", "raw", forms="second"),
    "heavy tails, warming up, many trials": LaboratoryKind("abroad", "tailed", trials="many", trouble="warm_up"),
    "knocks, placed anew, few trials": LaboratoryKind(
        "abroad", "knocked", "uneven", inputs="six", trials="few", trouble="placed", quotient=True, forms="second"
    ),
    "long memory, averaged samples, fewest trials": LaboratoryKind(
        "fresh", "lasting", "averaging", inputs="six", trials="fewest", forms="second"
    ),
    "random walk, mixed steps, placed anew": LaboratoryKind(
        "fresh", "walking", "even", "mixed", trials="several", trouble="placed"
    ),
    "hurried, interrupted, holds": LaboratoryKind(
        "fresh", "hurried", "interrupted", inputs="each", trials="few", motion="holds"
    ),
    "harmonics, uneven clock, sines": LaboratoryKind(
        "fresh", "harmonics", "uneven", "mixed", "raw", "many", forms="second", motion="sines"
    ),
    "long memory, two clocks, constants off": LaboratoryKind(
        "fresh", "lasting", "triggered", "coarse", "each", trouble="constants"
    ),
    "random walk, lagging, sweep": LaboratoryKind(
        "fresh", "walking", "lagging", "mixed", "six", "several", quotient=True, forms="second", motion="sweep"
    ),
    "hurried, rows dropped, warming up": LaboratoryKind(
        "fresh", "hurried", "dropping", "coarse", trials="many", trouble="warm_up", motion="sweep"
    ),
    "harmonics, averaged samples, placed anew": LaboratoryKind(
        "fresh", "harmonics", "averaging", "mixed", "raw", "fewest", "placed", forms="second"
    ),
}
"""By name."""


def kinds_of(side: Side) -> tuple[str, ...]:
    """Names of the kinds of a side."""
    return tuple(name for name, kind in LABORATORY_KINDS.items() if kind.side == side)


CLOCKS = {
    "even": Clock(losing=0.0),
    "uneven": Clock(uneven=0.3, losing=0.0),
    "dropping": Clock(losing=1.0, alone=0.05, longest=12),
    "triggered": Clock(losing=0.0, trigger=0.5),
    "averaging": Clock(losing=0.0),
    "lagging": Clock(losing=0.0),
    "interrupted": Clock(losing=0.0, interrupted=0.5),
}
STEPS = {"fine": (0.05, 0.3), "coarse": (0.5, 2.0)}
"""Steps of the numbers, in standard deviations of the noise; mixed: of each channel one of the two."""
COARSEST_INPUT = 1.0
TRIALS: Mapping[Trials, tuple[tuple[int, int], ...]] = {
    "fewest": ((2, 2),),
    "few": ((2, 2), (3, 2)),
    "several": ((4, 3), (5, 2), (5, 3)),
    "many": ((6, 3), (7, 3), (7, 4), (8, 4)),
}
MOST_USUAL = (4, 2)
"""Where a laboratory has no number of its own."""
MAINS = (50.0, 60.0)
"""Frequency of the mains [Hz]."""
HUM = (0.3, 1.0)
"""Root mean square of the hum, in standard deviations of the noise beside it."""
CHAIN = (0.02, 0.2)
"""Corner of a filter in the measuring chain, as a share of the sampling frequency."""
KNOCK, KNOCK_DECAY, KNOCK_RINGING, KNOCK_CHANCE = (4.0, 10.0), (0.02, 0.08), (5.0, 25.0), 0.5
"""Largest value of a knock in standard deviations of the noise; its decay [s]; its ringing [Hz]; how many trials."""
LASTING, LASTING_SHARE = (1.0, 5.0), (0.5, 0.9)
"""Memory of autoregressive noise [s]; its share of the variance, the rest is white."""
WALK = (0.3, 1.0)
"""Standard deviation of a random walk at the end of a trial, in that of the noise beside it."""
THIRD = (0.3, 0.8)
"""Root mean square of a third harmonic, in that of the hum."""
OVER, LAG = (0.6, 0.8, 1.0), (0.05, 0.25)
"""Shares of the time between two samples over which they are means; time constant of a low-pass, in that time."""
COLD = (1.0, 2.5)
"""What is off in the first trial, in what usually varies from trial to trial."""
CONSTANT = 0.01
"""Standard deviation of the error of a stated constant that is no length of the placement, as a share of it."""


def laboratory_of_kind(rng: Rng, scene: SyntheticScene, kind: LaboratoryKind) -> SyntheticScene:
    """The scene, recorded by some laboratory of the kind."""
    scene = at_another_rate(rng, moving(another_device(rng, scene), kind.motion))
    scene = _inputs(rng, scene, kind)
    lasting = scene.path(rng, 0)(np.zeros(1)).duration if kind.noise == "walking" else np.inf
    noise = tuple(_noise(rng, kind.noise, one.sd, scene.step, lasting) for one in scene.noise)
    scene = replace(scene, noise=noise)
    size = sizes(scene, scene.path(rng, 0))
    recorder = Recorder(
        growth_of(rng, scene, size) if kind.noise == "growing" else {},
        hurry_of(rng, scene, scene.path(rng, 0)) if kind.noise == "hurried" else {},
        quotients_of(scene, size) if kind.quotient else {},
        {row: one.sd * _step(rng, kind.steps, row, np.inf) for row, one in enumerate(noise)},
        {
            row: float(sd) * _step(rng, kind.steps, row, COARSEST_INPUT)
            for row, sd in enumerate(scene.input_noise)
            if sd
        },
    )
    usual = noticed(scene, scene.path(rng, 0), placement_of(scene, size, 1.0))
    own = TRIALS.get(kind.trials)
    laboratory = Laboratory(
        recorder,
        CLOCKS[kind.clock],
        _sampler(rng, scene, kind.clock),
        placement=usual if kind.trouble == "placed" else Placement(),
        standing=_constants(rng, scene) if kind.trouble == "constants" else Placement(),
        warm_up=_warm_up(rng, usual) if kind.trouble == "warm_up" else WarmUp(),
        trials=own[rng.integers(len(own))] if own else None,
        forms=kind.forms,
    )
    scene = sampled(rng, replace(scene, laboratory=laboratory))
    return sampled_unseen(rng, scene, (laboratory.trials or MOST_USUAL)[0])


def _inputs(rng: Rng, scene: SyntheticScene, kind: LaboratoryKind) -> SyntheticScene:
    """Other filters of the inputs' noise; who filters less has better sensors."""
    if kind.inputs == "usual":
        return scene
    filters = other_filters(rng, kind.inputs, len(scene.inputs), scene.step)
    pairs = zip(scene.input_noise, scene.filters, filters, strict=True)
    return replace(
        scene,
        filters=filters,
        input_noise=np.array([sd * quieter(scene.step, before, after) for sd, before, after in pairs]),
    )


def _noise(rng: Rng, sort: Noise, sd: float, step: float, duration: float) -> SensorNoise:
    if sort in ("pink", "growing", "tailed"):
        return power_law_noise(rng, sort, sd)
    sd = sd * rng.uniform(0.7, 1.4)
    if sort == "lasting":
        return Coloured(sd, 0.0, _between(rng, *LASTING), rng.uniform(*LASTING_SHARE))
    if sort == "filtered":
        return FilteredNoise(sd, NoiseFilter(_between(rng, *CHAIN) / step, int(rng.integers(1, 4))))
    white = PowerLawNoise(sd)
    if sort == "mains":
        return Humming(white, sd * rng.uniform(*HUM), float(rng.choice(MAINS)))
    if sort == "harmonics":
        hum, mains = sd * rng.uniform(*HUM), float(rng.choice(MAINS))
        return Humming(white, hum, mains, hum * rng.uniform(*THIRD))
    if sort == "walking":
        return Wandering(white, sd * rng.uniform(*WALK) / np.sqrt(duration))
    if sort == "knocked":
        decay = max(_between(rng, *KNOCK_DECAY), 2.0 * step)
        ringing = min(_between(rng, *KNOCK_RINGING), FAR_FROM_NYQUIST / step)
        return Knocked(white, rng.uniform(*KNOCK), decay, ringing, KNOCK_CHANCE)
    return white


def _constants(rng: Rng, scene: SyntheticScene) -> Placement:
    """Every constant off by a draw; sizes are made less later, as far as they would show."""
    usual = {name: LENGTH if name in scene.body.lengths else CONSTANT * told for name, told in scene.constants.items()}
    return Placement({name: sd * rng.standard_normal() for name, sd in usual.items()})


def _warm_up(rng: Rng, usual: Placement) -> WarmUp:
    cold = rng.uniform(*COLD) * rng.choice([-1.0, 1.0], len(usual))
    off = usual.times(cold)
    return WarmUp(Placement(gains=off.gains, zeros=off.zeros), rng.uniform(1.0, 4.0))


def _step(rng: Rng, steps: Steps, row: int, coarsest: float) -> float:
    """Step of numbers, in standard deviations of their noise; of two channels in a row one is fine, if they are
    mixed.
    """
    low, high = STEPS[("fine", "coarse")[row % 2] if steps == "mixed" else steps]
    return _between(rng, low, min(high, coarsest))


def _sampler(rng: Rng, scene: SyntheticScene, clock: Ticking) -> Sampler:
    """Switches among the inputs are read at once, whatever the sampler does."""
    switches = tuple(row for row in range(len(scene.inputs)) if scene.units[row] == FLAG)
    if clock == "averaging":
        return Sampler(over=float(rng.choice(OVER)), at_once=switches)
    return Sampler(lag=rng.uniform(*LAG), at_once=switches) if clock == "lagging" else AT_ONCE


def _between(rng: Rng, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))
