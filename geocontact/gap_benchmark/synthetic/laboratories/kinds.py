"""Kinds of laboratories, each a combination of what a laboratory may have; which of them thresholds may be chosen on.

On kinds at *home* thresholds of the diagnosis may be chosen and changed. Kinds *abroad* are for reporting only: whoever
changes the diagnosis because of a case there puts that kind at home and adds another. No kind abroad has a noise and a
clock together that a kind at home has, and knocks, warming up and the second family of effects are abroad only.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from geocontact.gap_benchmark.synthetic.equipment.laboratory import Forms

Side = Literal["home", "abroad"]
SIDES: tuple[Side, ...] = ("home", "abroad")
Noise = Literal["white", "pink", "mains", "filtered", "growing", "tailed", "knocked"]
Ticking = Literal["even", "uneven", "dropping", "triggered"]
Steps = Literal["fine", "coarse"]
InputFilters = Literal["usual", "six", "raw", "each"]
Trials = Literal["few", "usual", "many"]
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
        the measuring chain; growing: with the signal; tailed: Student's distribution; knocked: cables are.
    clock
        even; uneven samples; dropping rows; triggered: inputs and outputs have a clock each.
    steps
        Of the numbers of outputs and inputs: 0.05 to 0.3 of the noise, or 0.5 to 2 (inputs: to 1).
    inputs
        What their noise came through: as the benchmark's own laboratory; 6 Hz; nothing; a filter of each input's own.
    trials
        2 to 4, as usual, or 9 to 12 in all.
    trouble
        placed: all sits a little elsewhere in every trial; constants: told a little wrong, in all trials alike;
        warm_up: gains and zeros settle in the first trials.
    quotient
        Whether a centre of pressure is a noisy moment over a noisy force.
    forms
        Family of the equations that effects are planted by.
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
}
"""By name."""


def kinds_of(side: Side) -> tuple[str, ...]:
    """Names of the kinds at home or abroad."""
    return tuple(name for name, kind in LABORATORY_KINDS.items() if kind.side == side)
