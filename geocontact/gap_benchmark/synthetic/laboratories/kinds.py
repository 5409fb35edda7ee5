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
from dataclasses import dataclass
from typing import Literal

from geocontact.gap_benchmark.synthetic.equipment.laboratory import Forms

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
        In all: 2 or 3 (fewest), 3 or 4 (few), 5 or 6 as in the home laboratory (usual), 7 or 8 (several), 9 to 12
        (many).
    trouble
        placed: all sits a little elsewhere in every trial; constants: told a little wrong, in all trials alike;
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
