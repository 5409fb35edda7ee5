"""A sweep of one thing about a foot, alone or with its alignment: bands and best values, in numbers and words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import listener
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.design.trial import FootAndTrial
from geocontact.below_knee_prosthesis.design.choice import FootChoice, PairChoice, choose_pair
from geocontact.below_knee_prosthesis.design.drawn import Draws, TrialErrors, draws, task_again
from geocontact.below_knee_prosthesis.design.foot_map import CarriedLoad
from geocontact.below_knee_prosthesis.design.foot_task import FootTask
from geocontact.below_knee_prosthesis.design.knob import AIMS, JUDGED, RESPONSES, Knob, Response, Vary
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES, ROLLING, Aim
from geocontact.below_knee_prosthesis.design.sensitivities import FootSensitivity, Unit, Unknown, sensitivities
from geocontact.data.errors import InputError

SHOWN: dict[Vary, tuple[float, str]] = {
    "fulcrum": (1e3, "mm"),
    "alignment": (float(np.degrees(1.0)), "deg"),
    "stiffness": (1.0, ""),
}
"""How many of what a value is shown in."""
DIGITS: dict[Vary, int] = {"fulcrum": 0, "alignment": 1, "stiffness": 2}
UNITS: dict[Vary, str] = {"fulcrum": "mm", "alignment": "deg", "stiffness": "-"}
NO_DIFFERENCE = 1e-3
"""Share of an outcome's size: a smaller difference is none."""


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
    """Value that is wanted where the user does not say; None where the least or the most is."""
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
        ends = [0.5, 0.5 * (1.0 - level), 0.5 * (1.0 + level)]
        return cls(*given, np.asarray(np.quantile(drawn, ends, axis=0)), choices)

    def table(self, vary: Vary) -> pd.DataFrame:
        """Long: one row for each pair, response and outcome."""
        factor, turn, rows = SHOWN[vary][0], SHOWN["alignment"][0], []
        for k, aim in enumerate(AIMS):
            for j, response in enumerate(JUDGED):
                for m, angle in enumerate(self.alignments):
                    for n, value in enumerate(self.values):
                        median, lower, upper = map(float, self.bands[:, m, j, n, k])
                        row: dict[str, object] = {
                            f"{vary} [{UNITS[vary]}]": factor * float(value),
                            "alignment [deg]": turn * float(angle),
                            "response": response,
                            "outcome": aim,
                            "unit": MEASURES[aim].unit,
                        }
                        rows.append(row | {"median": median, "lower": lower, "upper": upper})
        return pd.DataFrame(rows)

    def pairs(self, vary: Vary, answers: Sequence[AimAnswer]) -> pd.DataFrame:
        """One row for each aim."""
        factor, turn, rows = SHOWN[vary][0], SHOWN["alignment"][0], []
        what, turned = f"{vary} [{UNITS[vary]}]", "alignment [deg]"
        for each in answers:
            one = self.choices[each.aim]
            (lower, upper), (least, most) = one.as_good, one.alignments
            row: dict[str, object] = {"outcome": each.aim, "wanted": each.wanted}
            row |= {f"best {what}": factor * one.value, f"best {turned}": turn * one.alignment}
            row |= {f"lower {what}": factor * lower, f"upper {what}": factor * upper}
            row |= {f"lower {turned}": turn * least, f"upper {turned}": turn * most}
            row |= {f"best {what} alone": factor * one.alone, "better than alone": one.better}
            row["unit"] = MEASURES[each.aim].unit
            for response, (median, low, high) in one.gain.items():
                row |= {f"{response}: gain": median, f"{response}: lower": low, f"{response}: upper": high}
            rows.append(row)
        return pd.DataFrame(rows)


def pair_words(vary: Vary, answer: AimAnswer, together: Together) -> str:
    """Whether turning the foot as well is any better, for one aim."""
    one, measure = together.choices[answer.aim], MEASURES[answer.aim]

    def shown(value: float) -> str:
        return value_words(vary, value)

    turn = SHOWN["alignment"][0]
    gains = ", ".join(
        f"{name} nearer by {median:.3g} ({lower:.3g} to {upper:.3g}) {measure.unit}"
        for name, (median, lower, upper) in one.gain.items()
    )
    pair = f"{vary} {shown(one.value)} with the foot turned by {turn * one.alignment:+.0f} deg"
    says = "is better than" if one.better else "cannot be told to be better than"
    near = " to ".join(map(shown, one.as_good))
    turns = f"{turn * one.alignments[0]:+.0f} to {turn * one.alignments[1]:+.0f} deg"
    return f"{pair} {says} {shown(one.alone)} alone: {gains}; as good may be {near} and {turns}"


STEPS: dict[Unit, tuple[float, str]] = {
    "m": (1e3, "mm"),
    "rad": (float(np.degrees(1.0)), "deg"),
    "-": (1.0, "-"),
    "factor": (1.0, "factor"),
}


def sensitivities_table(found: Sequence[FootSensitivity]) -> pd.DataFrame:
    """Long: one row for each number, response and outcome."""
    rows = []
    for each in found:
        factor, shown = STEPS[each.unit]
        for response, change in each.change.items():
            for aim, value in zip(AIMS, change, strict=True):
                row: dict[str, object] = {"number": each.name, "by": factor * each.by, "in": shown}
                row |= {"response": response, "outcome": aim, "unit": MEASURES[aim].unit, "change": float(value)}
                rows.append(row)
    return pd.DataFrame(rows)


VALUES: dict[Vary, Float[np.ndarray, " n"]] = {
    "fulcrum": np.linspace(0.066, 0.151, 9),
    "alignment": np.radians(np.linspace(-6.0, 6.0, 9)),
    "stiffness": np.linspace(0.6, 1.6, 9),
}
ALIGNMENTS = np.radians([-6.0, -3.0, 0.0, 3.0, 6.0])
"""That go together with every value."""


@dataclass(frozen=True, eq=False)
class VariedFoot:
    """A foot varied along a trial.

    Parameters
    ----------
    task
        What the foot carries.
    drawn
        Outcomes over the values, with what is not known drawn.
    ends, shapes
        First, present and last value, and the foot along the stance at each, with the numbers as they are.
    held
        How long joint torques alone hold the leg at each of the ends [s].
    hangs_on
        How far outcomes on the present foot hang on each number.
    """

    task: FootTask
    drawn: Draws
    ends: Knob
    shapes: Mapping[Response, tuple[CarriedLoad, ...]]
    held: tuple[float, ...]
    hangs_on: tuple[FootSensitivity, ...]


def varied_foot(given: FootAndTrial, knob: Knob, o: ProsthesisDesignOptions) -> VariedFoot:
    """Draws over the values, and both ends beside the present one; InputError where the foot finds no equilibrium."""
    trial, ends = given.trial, _ends(knob)
    pitch = min(o.pitch_error, trial.offset.pitch_sd) if trial.offset.pitch_sd > 0.0 else o.pitch_error
    errors = TrialErrors(marker=o.marker_error, pitch=pitch, force=o.force_noise)
    try:
        task = trial.task()
        with listener().progress("feet", o.feet) as step:
            drawn = draws(
                knob,
                given.foot,
                task,
                lambda rng: task_again(trial, errors, rng),
                given.sd,
                feet=o.feet,
                walks=o.walks,
                seed=o.seed,
                step=step,
                alignments=ALIGNMENTS.tolist() if o.together else (),
            )
        unknown = Unknown(given.sd, errors.pitch, errors.gain)
        hangs_on = sensitivities(given.foot, task, trial.fulcrum, knob.terrain, unknown)
        maps = ends.maps(given.foot, task)
        shapes = ends.carried(maps, task)
        held = ends.other_feet(maps, task, tracking=0.0).moved().held
    except (ArithmeticError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        remedy = "check `mass`, the plate and how flat the foot stood"
        raise InputError(o.markers, "", str(error), remedy) from error
    return VariedFoot(task, drawn, ends, shapes, tuple(held.tolist()), hangs_on)


def _ends(knob: Knob) -> Knob:
    """The first value, the present one and the last, in order."""
    return Knob(knob.vary, np.unique([knob.settings[0], knob.present, knob.settings[-1]]), knob.fulcrum, knob.terrain)
