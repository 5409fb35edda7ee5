"""Tables of a study's statistics: mean curves, differences between conditions, agreement, trials that lie apart."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.data.trial import mean_and_sd
from geocontact.io.text.units import split_header
from geocontact.study.curves import STEPS, StudyCurves
from geocontact.study.statistics import LIMIT, SignFlips, reliability, scores, sign_flips
from geocontact.view.curves.bland_altman import limits_of_agreement

_SIGNS = {
    "\\": r"\textbackslash{}",
    "&": r"\&",
    "%": r"\%",
    "$": r"\$",
    "#": r"\#",
    "_": r"\_",
    "{": r"\{",
    "}": r"\}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "²": r"\textsuperscript{2}",
}
DIGITS = 4
LEAST = 3
"""Subjects that agreement is given for."""


def latex(table: pd.DataFrame) -> str:
    """The table with four significant digits; what is missing is empty."""
    numbers = [pd.api.types.is_numeric_dtype(kind) for kind in table.dtypes]
    head = " & ".join(_escaped(str(name)) for name in table.columns)
    rows = [" & ".join(_cell(value) for value in row) for row in table.itertuples(index=False)]
    body = "".join(f"{row} \\\\\n" for row in rows)
    columns = "".join("r" if number else "l" for number in numbers)
    return f"\\begin{{tabular}}{{{columns}}}\n\\toprule\n{head} \\\\\n\\midrule\n{body}\\bottomrule\n\\end{{tabular}}\n"


def _cell(value: object) -> str:
    if isinstance(value, (float, np.floating)):
        return "" if np.isnan(value) else f"{value:.{DIGITS}g}"
    return _escaped(str(value))


def _escaped(text: str) -> str:
    return "".join(_SIGNS.get(sign, sign) for sign in text)


def ensemble_table(curves: Sequence[StudyCurves]) -> pd.DataFrame:
    """Mean and standard deviation over subjects, for each quantity and condition along the curve."""
    parts = []
    for one in curves:
        for condition, values in one.groups.items():
            mean, sd = mean_and_sd(values)
            told = {**_quantity(one), "condition": condition, "cycle [%]": STEPS}
            parts.append(
                pd.DataFrame({**told, "subjects [-]": np.isfinite(values).sum(axis=0), "mean": mean, "sd": sd})
            )
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def value_table(curves: Sequence[StudyCurves]) -> pd.DataFrame:
    """Each subject's mean and largest value: their mean and standard deviation, for each quantity and condition."""
    rows = []
    for one in curves:
        for condition, values in one.groups.items():
            whole = values[np.isfinite(values).all(axis=1)]
            for value, found in (("mean", whole.mean(axis=1)), ("largest", whole.max(axis=1, initial=-np.inf))):
                mean, sd = mean_and_sd(found[:, None])
                told = {**_quantity(one), "value": value, "condition": condition, "subjects [-]": len(found)}
                rows.append({**told, "mean": mean[0], "sd": sd[0]})
    return pd.DataFrame(rows)


NAMED = 4
"""Conditions whose means are written out."""


def means_by_condition(curves: Sequence[StudyCurves]) -> list[str]:
    """The mean over the curve of each quantity by condition, of two conditions their difference in common subjects.

    SD is that of subjects, said of two or more. Without two conditions nothing is said.
    """
    lines = []
    for one in curves:
        name, unit = split_header(one.column)
        ending = f" {unit}" if unit and unit != "-" else ""
        known = {each: values[np.isfinite(values).all(axis=1)].mean(axis=1) for each, values in one.groups.items()}
        means = {each: found for each, found in known.items() if len(found)}
        if not 2 <= len(means) <= NAMED:
            continue
        parts = ", ".join(f"{each} {_mean(found)}{ending}" for each, found in means.items())
        apart = [a.mean(axis=1) - b.mean(axis=1) for other, *_, a, b in _pairs([one]) if other is one]
        minus = f": difference {_mean(apart[0])}{ending}" if len(means) == 2 and apart else ""
        lines.append(f"{name}, mean over the curve: {parts}{minus}")
    return lines


def _mean(values: Float[np.ndarray, " n"]) -> str:
    """ "1210", "1210 (SD 35)"."""
    text = f"{values.mean():.{DIGITS}g}".replace("-", "−")
    return f"{text} (SD {values.std(ddof=1):.3g})" if len(values) > 1 else text


def outlier_table(curves: Sequence[StudyCurves]) -> pd.DataFrame:
    """Trials whose curve lies apart from those of its condition, with their modified z score."""
    rows = []
    for one in curves:
        for condition in one.known:
            own = [k for k, each in enumerate(one.conditions) if each == condition]
            for k, score in zip(own, scores(one.matrix[own]), strict=True):
                if score > LIMIT:
                    rows.append({"name": one.names[k], **_quantity(one), "condition": condition, "score [-]": score})
    return pd.DataFrame(rows, columns=["name", "quantity", "unit", "condition", "score [-]"])


def differences_of(curves: Sequence[StudyCurves]) -> Iterator[tuple[StudyCurves, str, str, SignFlips]]:
    """Tests of each two conditions that have two or more subjects in common."""
    for one, first, second, a, b in _pairs(curves):
        if len(a) >= 2:
            yield one, first, second, sign_flips(a - b)


def difference_table(curves: Sequence[StudyCurves]) -> pd.DataFrame:
    """First condition minus second along the curve, with t and the p that is corrected for the whole curve."""
    parts = [
        pd.DataFrame(
            {
                **_quantity(one),
                "first": first,
                "second": second,
                "cycle [%]": STEPS,
                "difference": found.difference,
                "t [-]": found.t,
                "p [-]": found.p,
            }
        )
        for one, first, second, found in differences_of(curves)
    ]
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def agreement_table(curves: Sequence[StudyCurves]) -> pd.DataFrame:
    """Bias, limits of agreement and intraclass correlation of each subject's mean and largest value."""
    rows = []
    for one, first, second, a, b in _pairs(curves):
        if len(a) < LEAST:
            continue
        for value, x, y in (("mean", a.mean(axis=1), b.mean(axis=1)), ("largest", a.max(axis=1), b.max(axis=1))):
            limits, icc = limits_of_agreement(x - y), reliability(np.column_stack([x, y]))
            rows.append(
                {
                    **_quantity(one),
                    "value": value,
                    "first": first,
                    "second": second,
                    "subjects [-]": limits.count,
                    "bias": limits.bias,
                    "bias_lower": limits.bias_interval[0],
                    "bias_upper": limits.bias_interval[1],
                    "lower_limit": limits.lower,
                    "upper_limit": limits.upper,
                    "icc_agreement [-]": icc.agreement,
                    "icc_agreement_lower [-]": icc.agreement_interval[0],
                    "icc_agreement_upper [-]": icc.agreement_interval[1],
                    "icc_consistency [-]": icc.consistency,
                }
            )
    return pd.DataFrame(rows)


def _pairs(
    curves: Sequence[StudyCurves],
) -> Iterator[tuple[StudyCurves, str, str, Float[np.ndarray, "n 101"], Float[np.ndarray, "n 101"]]]:
    """Each two conditions with the curves of the subjects that have both, whole."""
    for one in curves:
        for first, second in combinations(one.known, 2):
            a, b = one.by_subject(first), one.by_subject(second)
            both = [each for each in a if each in b and np.isfinite(a[each] + b[each]).all()]
            if both:
                yield one, first, second, np.array([a[each] for each in both]), np.array([b[each] for each in both])


def _quantity(one: StudyCurves) -> dict[str, str]:
    name, unit = split_header(one.column)
    return {"quantity": name, "unit": unit or ""}
