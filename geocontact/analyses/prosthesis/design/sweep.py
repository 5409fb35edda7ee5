"""A sweep of one thing about a foot, alone or with its alignment, in tables and words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.below_knee_prosthesis.design.aims import Aim
from geocontact.below_knee_prosthesis.design.drawn import OF_MAP
from geocontact.below_knee_prosthesis.design.intact_step import NOT_INTACT
from geocontact.below_knee_prosthesis.design.knob import AIMS, JUDGED, RESPONSES, Vary
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES
from geocontact.below_knee_prosthesis.design.sensitivities import FootSensitivity, Unit
from geocontact.below_knee_prosthesis.design.sweep import AimAnswer, Sweep, Together

SHOWN: dict[Vary, tuple[float, str]] = {
    "fulcrum": (1e3, "mm"),
    "alignment": (float(np.degrees(1.0)), "deg"),
    "stiffness": (1.0, ""),
}
"""How many of what a value is shown in."""
DIGITS: dict[Vary, int] = {"fulcrum": 0, "alignment": 1, "stiffness": 2}
UNITS: dict[Vary, str] = {"fulcrum": "mm", "alignment": "deg", "stiffness": "-"}
BAND = ("median", "lower", "upper")


def value_words(vary: Vary, value: float) -> str:
    """A value with its unit."""
    factor, unit = SHOWN[vary]
    return f"{factor * value:.{DIGITS[vary]}f}{unit and ' '}{unit}"


def shown_values(sweep: Sweep) -> Float[np.ndarray, " n"]:
    """Values in the unit that they are shown in."""
    return SHOWN[sweep.knob.vary][0] * sweep.knob.settings


def sweep_table(sweep: Sweep) -> pd.DataFrame:
    """Long: one row for each value, response and outcome."""
    rows, bands, vary = [], sweep.bands, sweep.knob.vary
    for k, aim in enumerate(AIMS):
        for j, response in enumerate(RESPONSES):
            for i, value in enumerate(shown_values(sweep)):
                row: dict[str, object] = {f"{vary} [{UNITS[vary]}]": float(value), "response": response}
                row |= {"outcome": aim, "unit": MEASURES[aim].unit}
                rows.append(row | dict(zip(BAND, map(float, bands[:, j, i, k]), strict=True)))
    return pd.DataFrame(rows)


def ranges_table(sweep: Sweep) -> pd.DataFrame:
    """Long: between which ends an outcome lies at each value, with the responses that make them."""
    rows, (median, lower, upper), vary = [], sweep.bands, sweep.knob.vary
    for k, aim in enumerate(AIMS):
        for i, value in enumerate(shown_values(sweep)):
            least, most = int(median[:, i, k].argmin()), int(median[:, i, k].argmax())
            rows.append(
                {
                    f"{vary} [{UNITS[vary]}]": float(value),
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


def difference_words(sweep: Sweep, asked: Aim) -> dict[str, str]:
    """The last value in place of the first, draw by draw, by response: of the foot's own outcomes and what is asked."""
    found: dict[str, str] = {}
    for j, response in enumerate(RESPONSES):
        words = []
        for k, aim in enumerate(AIMS):
            if aim not in (*OF_MAP, asked):
                continue
            off = sweep.difference(j, k)
            name, unit = MEASURES[aim].words.partition(",")[0], MEASURES[aim].unit
            if off.small:
                words.append(f"{name} the same")
            elif off.unsure:
                words.append(f"{name} not identified ({off.lower:+.3g} to {off.upper:+.3g} {unit})")
            else:
                words.append(f"{name} {off.median:+.3g} ({off.lower:+.3g} to {off.upper:+.3g}) {unit}")
        found[response] = "; ".join(words)
    return found


def answers_table(answers: tuple[AimAnswer, ...], vary: Vary) -> pd.DataFrame:
    """One row for each aim."""
    factor, unit = SHOWN[vary][0], UNITS[vary]
    rows = []
    for each in answers:
        choice = each.choice
        row: dict[str, object] = {
            "outcome": each.aim,
            "wanted": each.wanted,
            "identified": choice.told,
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


def together_table(together: Together, vary: Vary) -> pd.DataFrame:
    """Long: one row for each pair, response and outcome."""
    factor, turn, rows = SHOWN[vary][0], SHOWN["alignment"][0], []
    for k, aim in enumerate(AIMS):
        for j, response in enumerate(JUDGED):
            for m, angle in enumerate(together.alignments):
                for n, value in enumerate(together.values):
                    row: dict[str, object] = {f"{vary} [{UNITS[vary]}]": factor * float(value)}
                    row |= {"alignment [deg]": turn * float(angle), "response": response}
                    row |= {"outcome": aim, "unit": MEASURES[aim].unit}
                    rows.append(row | dict(zip(BAND, map(float, together.bands[:, m, j, n, k]), strict=True)))
    return pd.DataFrame(rows)


def pairs_table(together: Together, vary: Vary, answers: Sequence[AimAnswer]) -> pd.DataFrame:
    """One row for each aim."""
    factor, turn, rows = SHOWN[vary][0], SHOWN["alignment"][0], []
    what, turned = f"{vary} [{UNITS[vary]}]", "alignment [deg]"
    for each in answers:
        one = together.choices[each.aim]
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
    says = "is better than" if one.better else "is not shown to be better than"
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


OF_ONE_STEP = (
    "what the intact side has is of one step, and no error of it is in the bands; its rate of loading is the plate's, "
    "that of a prosthetic foot its stiffness times its speed"
)


NOT_THERE = (": not computed of the intact leg", ": an intact foot has none")


def intact_words(values: Mapping[Aim, float]) -> str:
    """Outcomes that the intact foot has, and those that it does not have, in a sentence."""
    has = "; ".join(f"{MEASURES[aim].words} {value:.3g} {MEASURES[aim].unit}" for aim, value in values.items())
    lacks = " and no ".join(MEASURES[aim].words.partition(",")[0] for aim in NOT_INTACT)
    return f"aimed at, of one step of the intact foot: {has}; without socket and keel there is no {lacks}"


def intact_table(values: Mapping[Aim, float]) -> pd.DataFrame:
    """One row for each outcome; those that a step of an intact foot does not have are empty."""
    rows = [
        {
            "outcome": aim,
            "intact side": values.get(aim, np.nan),
            "unit": MEASURES[aim].unit,
            "aimed at": aim in values,
            "words": f"{MEASURES[aim].words}{'' if aim in values else NOT_THERE[aim in NOT_INTACT]}",
        }
        for aim in AIMS
    ]
    return pd.DataFrame(rows)
