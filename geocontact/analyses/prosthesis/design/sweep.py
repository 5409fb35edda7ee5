"""A sweep of one thing about a foot, with bands, in numbers and words."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.below_knee_prosthesis.design.choice import FootChoice
from geocontact.below_knee_prosthesis.design.foot_task import FootTask
from geocontact.below_knee_prosthesis.design.knob import AIMS, RESPONSES, Knob, Vary
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES, ROLLING, Aim

SHOWN: dict[Vary, tuple[float, str]] = {
    "fulcrum": (1e3, "mm"),
    "alignment": (float(np.degrees(1.0)), "deg"),
    "stiffness": (1.0, ""),
}
"""How many of what a value is shown in."""
DIGITS: dict[Vary, int] = {"fulcrum": 0, "alignment": 1, "stiffness": 2}
UNITS: dict[Vary, str] = {"fulcrum": "mm", "alignment": "deg", "stiffness": "-"}
NO_DIFFERENCE = 1e-3
"""Of an outcome's size: a smaller difference is none."""


def value_words(vary: Vary, value: float) -> str:
    """A value with its unit."""
    factor, unit = SHOWN[vary]
    return f"{factor * value:.{DIGITS[vary]}f}{unit and ' '}{unit}"


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
        ends = [0.5, 0.5 * (1.0 - self.level), 0.5 * (1.0 + self.level)]
        return np.asarray(np.quantile(self.free, ends, axis=0))

    @property
    def shown(self) -> Float[np.ndarray, " n"]:
        """Values in the unit that they are shown in."""
        return SHOWN[self.knob.vary][0] * self.knob.settings

    def table(self) -> pd.DataFrame:
        """Long: one row for each value, response and outcome."""
        rows, bands = [], self.bands
        for k, aim in enumerate(AIMS):
            for j, response in enumerate(RESPONSES):
                for i, value in enumerate(self.shown):
                    median, lower, upper = map(float, bands[:, j, i, k])
                    rows.append(
                        {
                            f"{self.knob.vary} [{UNITS[self.knob.vary]}]": float(value),
                            "response": response,
                            "outcome": aim,
                            "unit": MEASURES[aim].unit,
                            "median": median,
                            "lower": lower,
                            "upper": upper,
                        }
                    )
        return pd.DataFrame(rows)

    @property
    def ends(self) -> Float[np.ndarray, "two n aims"]:
        """Least and most of the medians over the responses of the person."""
        median = self.bands[0]
        return np.stack([median.min(axis=0), median.max(axis=0)])

    def ranges(self) -> pd.DataFrame:
        """Long: between which ends an outcome lies at each value, with the responses that make them."""
        rows, (median, lower, upper) = [], self.bands
        for k, aim in enumerate(AIMS):
            for i, value in enumerate(self.shown):
                least, most = int(median[:, i, k].argmin()), int(median[:, i, k].argmax())
                rows.append(
                    {
                        f"{self.knob.vary} [{UNITS[self.knob.vary]}]": float(value),
                        "outcome": aim,
                        "unit": MEASURES[aim].unit,
                        "least": float(median[least, i, k]),
                        "with": RESPONSES[least],
                        "most": float(median[most, i, k]),
                        "with it": RESPONSES[most],
                        "lower": float(lower[:, i, k].min()),
                        "upper": float(upper[:, i, k].max()),
                    }
                )
        return pd.DataFrame(rows)

    def differences(self) -> dict[str, list[str]]:
        """The last value in place of the first, draw by draw, in words, by response."""
        found: dict[str, list[str]] = {}
        for j, response in enumerate(RESPONSES):
            words = []
            for k, aim in enumerate(AIMS):
                off = self.free[:, j, -1, k] - self.free[:, j, 0, k]
                median, lower, upper = np.quantile(off, [0.5, 0.5 * (1.0 - self.level), 0.5 * (1.0 + self.level)])
                name, unit = MEASURES[aim].words.partition(",")[0], MEASURES[aim].unit
                small = NO_DIFFERENCE * float(np.abs(self.free[..., k]).mean())
                if max(abs(lower), abs(upper)) < small:
                    words.append(f"{name} the same")
                elif lower <= 0.0 <= upper:
                    words.append(f"{name} cannot tell ({lower:+.3g} to {upper:+.3g} {unit})")
                else:
                    words.append(f"{name} {median:+.3g} ({lower:+.3g} to {upper:+.3g}) {unit}")
            found[response] = words
        return found


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


def wanted_of(aim: Aim, task: FootTask) -> float | None:
    """What is wanted where the user does not say."""
    return ROLLING * task.leg_length if MEASURES[aim].sense == "nearest" else None


def answers_table(answers: tuple[AimAnswer, ...], vary: Vary) -> pd.DataFrame:
    """One row for each aim."""
    factor, unit = SHOWN[vary][0], UNITS[vary]
    rows = []
    for each in answers:
        choice = each.choice
        row: dict[str, object] = {
            "outcome": each.aim,
            "wanted": each.wanted,
            "told": choice.told,
            f"best {vary} [{unit}]": factor * choice.best,
            f"lower {vary} [{unit}]": factor * choice.lower,
            f"upper {vary} [{unit}]": factor * choice.upper,
            "better than present": choice.better,
            "unit": MEASURES[each.aim].unit,
        }
        for response in RESPONSES:
            median, lower, upper = choice.gain.get(response, (np.nan, np.nan, np.nan))
            row |= {f"{response}: verdict": choice.sides[response].verdict}
            row |= {f"{response}: gain": median, f"{response}: lower": lower, f"{response}: upper": upper}
        rows.append(row | {"why": choice.why})
    return pd.DataFrame(rows)
