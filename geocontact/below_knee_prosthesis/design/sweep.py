"""A sweep of one thing about a foot, alone or with its alignment: bands over the draws, and the best values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.design.aims import Aim
from geocontact.below_knee_prosthesis.design.choice import FootChoice, PairChoice, choose, choose_pair
from geocontact.below_knee_prosthesis.design.foot_task import FootTask
from geocontact.below_knee_prosthesis.design.knob import AIMS, Knob
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES, ROLLING

NO_DIFFERENCE = 1e-3
"""Share of an outcome's size: a smaller difference is none."""


def band(drawn: Float[np.ndarray, "d ..."], level: float) -> Float[np.ndarray, "three ..."]:
    """Median, and lower and upper end of the interval of that probability, over the draws."""
    return np.asarray(np.quantile(drawn, [0.5, 0.5 * (1.0 - level), 0.5 * (1.0 + level)], axis=0))


@dataclass(frozen=True)
class Difference:
    """What the last value of a sweep has in place of the first, of one outcome, draw by draw.

    Parameters
    ----------
    median, lower, upper
        In the outcome's unit.
    small
        Whether all of it is nothing beside the outcome's size (`NO_DIFFERENCE`).
    """

    median: float
    lower: float
    upper: float
    small: bool

    @property
    def unsure(self) -> bool:
        """Whether its sign is not known."""
        return self.lower <= 0.0 <= self.upper


@dataclass(frozen=True, eq=False)
class Sweep:
    """Outcomes of all draws over the values.

    Parameters
    ----------
    drawn
        By draw, response, value and aim, with the recorded load: what the best value is sought in.
    free
        The same with the load that would follow from the foot: what bands and differences are of.
    level
        Probability of the bands.
    """

    knob: Knob
    drawn: Float[np.ndarray, "d responses n aims"]
    free: Float[np.ndarray, "d responses n aims"]
    level: float

    @property
    def bands(self) -> Float[np.ndarray, "three responses n aims"]:
        """Median, lower and upper end."""
        return band(self.free, self.level)

    @property
    def ends(self) -> Float[np.ndarray, "two n aims"]:
        """Least and most of the medians over the responses of the person."""
        median = self.bands[0]
        return np.stack([median.min(axis=0), median.max(axis=0)])

    def difference(self, response: int, aim: int) -> Difference:
        """The last value in place of the first, by the places of response and aim in `RESPONSES` and `AIMS`."""
        off = self.free[:, response, -1, aim] - self.free[:, response, 0, aim]
        median, lower, upper = map(float, band(off, self.level))
        least = NO_DIFFERENCE * float(np.abs(self.free[..., aim]).mean())
        return Difference(median, lower, upper, max(abs(lower), abs(upper)) < least)

    def answers(
        self, task: FootTask, targets: Mapping[Aim, float], intact: Mapping[Aim, float]
    ) -> tuple[AimAnswer, ...]:
        """The best value for every aim, in the order of `AIMS`.

        Parameters
        ----------
        targets
            Values that are wanted, in SI.
        intact
            Outcomes that the intact side has: wanted where `targets` has none.

        Where neither says, the usual one is (`usual_target`).
        """
        found = []
        for k, aim in enumerate(AIMS):
            target = targets.get(aim, intact.get(aim, usual_target(aim, task)))
            given = MEASURES[aim].sense, target, self.knob.present, self.level
            choice = choose(self.knob.settings, self.drawn[..., k], *given)
            found.append(AimAnswer(aim, target, choice, aim in intact))
        return tuple(found)


@dataclass(frozen=True)
class AimAnswer:
    """The best value for one aim.

    Parameters
    ----------
    target
        Wanted value; None where the least or the most is best.
    of_intact
        Whether it is what the intact side has.
    """

    aim: Aim
    target: float | None
    choice: FootChoice
    of_intact: bool = False

    @property
    def wanted(self) -> str:
        """In words."""
        measure = MEASURES[self.aim]
        if self.target is None:
            return f"the {measure.sense}"
        whose = "the intact side's " if self.of_intact else ""
        return f"nearest to {whose}{self.target:.3g} {measure.unit}"


def usual_target(aim: Aim, task: FootTask) -> float | None:
    """Value that is wanted where nobody says; None where the least or the most is."""
    return ROLLING * task.leg_length if MEASURES[aim].sense == "nearest" else None


@dataclass(frozen=True, eq=False)
class Together:
    """Outcomes of all pairs, with the recorded load.

    Parameters
    ----------
    values, alignments
        In SI.
    bands
        Median, lower and upper end.
    choices
        By aim.
    """

    values: Float[np.ndarray, " n"]
    alignments: Float[np.ndarray, " m"]
    bands: Float[np.ndarray, "three m judged n aims"]
    choices: Mapping[Aim, PairChoice]

    @classmethod
    def of(
        cls,
        values: Float[np.ndarray, " n"],
        alignments: Float[np.ndarray, " m"],
        drawn: Float[np.ndarray, "d m judged n aims"],
        answers: Sequence[AimAnswer],
        level: float,
    ) -> Together:
        """Judged as the answers for one value alone are."""
        given = (values, alignments)
        choices = {
            each.aim: choose_pair(*given, drawn[..., k], MEASURES[each.aim].sense, each.target, level)
            for k, each in enumerate(answers)
        }
        return cls(*given, band(drawn, level), choices)
