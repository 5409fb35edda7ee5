"""Alignment varied together with fulcrum or stiffness, in numbers and words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.prosthesis.design.sweep import SHOWN, UNITS, AimAnswer, value_words
from geocontact.below_knee_prosthesis.design.choose_pair import PairChoice, choose_pair
from geocontact.below_knee_prosthesis.design.knob import AIMS, JUDGED, Vary
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES, Aim


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
