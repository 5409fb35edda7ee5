"""The figures of a benchmark as a table: what was asked for, the bar, and what each answerer reached."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import binomtest

from geocontact.gap_benchmark.answers import Plain, constant_answer, oracle_answer
from geocontact.gap_benchmark.score import GAPS, Rate, Score, answers, reduction_errors, score, visible

ANSWERERS = ("diagnosis", "regression", "regression_aware", "constant", "oracle")
"""Who is scored; "regression" knows nothing of trial-to-trial variation, "regression_aware" does."""
OPPONENTS = ("regression", "regression_aware")
AHEAD = 0.15
"""Share of first-ranked right, before the better opponent."""
DRAWS = 2000


@dataclass(frozen=True)
class ScoreRow:
    """A figure: its name in `Score`, what it is called, its bar, and whether a value reaches it (None: no bar)."""

    figure: str
    words: str
    bar: str = ""
    reached: Callable[[float], bool] | None = None


ROWS = (
    ScoreRow("false_alarms", "false alarms", "≤ 5 %", lambda v: v <= 0.05),
    ScoreRow("sure_alarms", "false alarms with p ≥ 0.9", "none", lambda v: v == 0.0),
    ScoreRow("harm", "named, and held out worse", "none", lambda v: v == 0.0),
    ScoreRow("harm_in_sum", "– in the sum over channels"),
    ScoreRow("harm_in_channel", "– significantly in a channel"),
    ScoreRow("first_right", "first-ranked right where visible", "≥ 92 %", lambda v: v >= 0.92),
    ScoreRow("first_right_anew", "– where visible though all is placed anew in every trial"),
    ScoreRow("in_small_set", "truth in a set of ≤ 3 where visible", "≥ 97 %", lambda v: v >= 0.97),
    ScoreRow("named_right", "visible, and named, nothing else"),
    ScoreRow("named_right_anew", "– where visible though all is placed anew in every trial"),
    ScoreRow("missed", "visible, called no gap"),
    ScoreRow("confidently_wrong", "confidently wrong", "≤ 2 %", lambda v: v <= 0.02),
    ScoreRow("both_found", "both of two found", "≥ 70 %", lambda v: v >= 0.70),
    ScoreRow("one_of_two", "at least one of two in question"),
    ScoreRow("unknown_called", "outside the table called unknown", "≥ 90 %", lambda v: v >= 0.90),
    ScoreRow("absorbed_recognised", "absorbed recognised", "≥ 97 %", lambda v: v >= 0.97),
    ScoreRow("reduction_error", "error of reduction, mean", "≤ 0.025", lambda v: v <= 0.025),
    ScoreRow("reduction_error_median", "error of reduction, median"),
    ScoreRow("coverage", "true reduction inside ci95", "90–99 %", lambda v: 0.90 <= v <= 0.99),
    ScoreRow("brier", "Brier score (with constant and oracle)"),
    ScoreRow("calibration_error", "error of stated probabilities, mean"),
)


@dataclass(frozen=True)
class Lead:
    """How far the diagnosis is ahead of an opponent on first-ranked right, the same visible cases.

    Parameters
    ----------
    points
        Difference of the shares.
    low, high
        Conservative 95 % interval: of the two shares of cases that only one has right, each exact at 97.5 %.
    p_value
        Exact, of as many disagreements in favour (McNemar 1947 Psychometrika 12:153).
    """

    only_ours: int
    only_theirs: int
    count: int
    points: float
    low: float
    high: float
    p_value: float


def answered(labels: Mapping[str, Plain], given: Mapping[str, Mapping[str, Plain]]) -> dict[str, dict[str, Plain]]:
    """Diagnoses by answerer and case: those that are given, the constant's and the oracle's."""
    constant = constant_answer(labels.values())
    return {
        **{who: {name: diagnoses[name] for name in labels} for who, diagnoses in given.items()},
        "constant": dict.fromkeys(labels, constant),
        "oracle": {name: oracle_answer(label) for name, label in labels.items()},
    }


def scores(labels: Mapping[str, Plain], given: Mapping[str, Mapping[str, Plain]]) -> dict[str, Score]:
    """Scores of every answerer on the same cases."""
    return {who: score(labels, diagnoses) for who, diagnoses in answered(labels, given).items()}


def lead(labels: Mapping[str, Plain], ours: Mapping[str, Plain], theirs: Mapping[str, Plain]) -> Lead:
    """First-ranked right, case by case."""
    names = [name for name, label in labels.items() if label["kind"] in GAPS and visible(label)]
    pairs = [(_first_right(labels[n], ours[n]), _first_right(labels[n], theirs[n])) for n in names]
    mine = Rate.of(a and not b for a, b in pairs)
    other = Rate.of(b and not a for a, b in pairs)
    apart = mine.hits + other.hits
    (a, b), (c, d) = mine.interval(0.975), other.interval(0.975)
    p = float(binomtest(mine.hits, apart, 0.5).pvalue) if apart else 1.0
    points = (mine.hits - other.hits) / len(pairs) if pairs else float("nan")
    return Lead(mine.hits, other.hits, len(pairs), points, a - d, b - c, p)


def _first_right(label: Plain, diagnosis: Plain) -> bool:
    return answers(diagnosis)[:1] == list(label["effects"])


def error_interval(labels: Mapping[str, Plain], diagnoses: Mapping[str, Plain]) -> tuple[float, float]:
    """95 % interval of the mean error of reduction: bootstrap over cases, all channels of a case together."""
    cases = [[e for e, _ in reduction_errors(label, diagnoses[name])] for name, label in labels.items()]
    sums = np.array([(sum(each), len(each)) for each in cases if each])
    if not len(sums):
        return 0.0, float("inf")
    drawn = sums[np.random.default_rng(0).integers(0, len(sums), (DRAWS, len(sums)))].sum(axis=1)
    low, high = np.quantile(drawn[:, 0] / drawn[:, 1], [0.025, 0.975])
    return float(low), float(high)


def markdown(
    labels: Mapping[str, Plain], given: Mapping[str, Mapping[str, Plain]], extra: Sequence[tuple[str, str, str]] = ()
) -> list[str]:
    """Lines of the table; a figure that falls short of its bar is marked with a cross, one that reaches it is ticked.

    Parameters
    ----------
    labels, given
        Truth by case, and diagnoses by answerer and case.
    extra
        Further rows of the diagnosis alone: words, bar, value.
    """
    found = scores(labels, given)
    whose = [who for who in ANSWERERS if who in found]
    lines = ["| figure | bar | " + " | ".join(who.replace("_", ", ") for who in whose) + " |"]
    lines.append("|---|---|" + "---|" * len(whose))
    everybody = answered(labels, given)
    for row in ROWS:
        cells = [cell(row, found[who], mark=who == "diagnosis") for who in whose]
        if row.figure == "reduction_error":
            spans = [error_interval(labels, everybody[who]) for who in whose]
            cells = [f"{text} [{low:.4f}, {high:.4f}]" for text, (low, high) in zip(cells, spans, strict=True)]
        lines.append(f"| {row.words} | {row.bar} | " + " | ".join(cells) + " |")
    empty = " |" * (len(whose) - 1)
    for who in OPPONENTS:
        if who in given:
            one = lead(labels, given["diagnosis"], given[who])
            text = f"{_mark(one.points >= AHEAD)} {100 * one.points:+.0f} [{100 * one.low:+.0f}, {100 * one.high:+.0f}]"
            text += f", {one.only_ours}:{one.only_theirs} of {one.count}, p = {one.p_value:.2g}"
            name = who.replace("_", ", ")
            lines.append(f"| first-ranked right, points ahead of {name} | ≥ 15 | {text} |{empty}")
    lines += [f"| {words} | {bar} | {value} |{empty}" for words, bar, value in extra]
    return lines


def cell(row: ScoreRow, one: Score, *, mark: bool) -> str:
    """A figure with its exact interval."""
    value: Any = getattr(one, row.figure)
    number = value.value if isinstance(value, Rate) else float(value)
    text = str(value) if isinstance(value, Rate) else f"{number:.4f}"
    if not mark or row.reached is None or np.isnan(number):
        return text
    return f"{_mark(row.reached(number))} {text}"


def _mark(reached: bool) -> str:
    return "✓" if reached else "✗"
