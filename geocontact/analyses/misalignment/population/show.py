"""What is shown of a population: distribution of the largest force, exceedance, page."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import contradicted, if_it_fits
from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, rounded
from geocontact.analyses.misalignment.planar import MODEL, STATES, WITHOUT_FORCE, page_table
from geocontact.analyses.misalignment.population.drawn import Drawn, influence_table, quantile_table
from geocontact.data.motion import Course
from geocontact.identify.intervals.sampling import Indices
from geocontact.view.curves.declared import Curve, Curves, CurveSheet, Shade
from geocontact.view.page.content import (
    IntervalRow,
    Intervals,
    Page,
    Readout,
    Row,
    Section,
    Table,
    Words,
)

BINS = 80


def population_curves(d: Drawn) -> CurveSheet:
    """Probability that the largest force is above a level, with its interval, and density of the finite ones."""
    value, lower, upper = (
        100.0 * np.array([getattr(one, end) for one in d.exceedance]) for end in ("value", "lower", "upper")
    )
    limit = [Shade(f"limit {d.limit:g} N", d.limit, d.limit)]
    known = d.peak[np.isfinite(d.peak)]
    counts, edges = np.histogram(known, BINS, (0.0, float(d.levels[-1])))
    density = Curve("density", np.repeat(counts / (max(len(known), 1) * np.diff(edges)), 2))
    tail = Curve("share of the samples, 95 % interval", np.where(value > 0.0, value, np.nan), lower, upper)
    panels = [
        Curves("Probability of more", "%", [tail], spans=limit, log=True, words=TAIL),
        Curves(
            "Density of the largest |F|",
            "1/N",
            [density],
            spans=limit,
            over=Course("largest |F|", "N", np.repeat(edges, 2)[1:-1]),
        ),
    ]
    return CurveSheet(panels, Course("force", "N", d.levels))


TAIL = "The band is what the number of samples leaves open (exact interval)."
DRAWN = (
    "The people are synthetic: drawn from the distributions in the description, which are as good as what they were "
    "taken from. Intervals give the error of drawing a finite number of them, nothing else. Samples whose limb or link "
    "comes to a pole or a fold have no force; they count as beyond every force."
)
SHARES = "First-order: what knowing the factor takes away. Total: what is left if all others are known."
INFLUENCE = (
    "Shares of the variance (Sobol): first, what knowing the factor would take away; total, what would be left if all "
    "others were known. They need independent factors and a force for every sample. Coefficients of ranks see what "
    "rises or falls throughout, those of the distance from the median what acts either way, as offsets do."
)


def population_page(d: Drawn, panels: Sequence[Curves]) -> Page:
    """The page of a population, whose slider goes along the forces; `panels` are those of `population_curves`."""
    shares = [100.0 * np.array([getattr(one, end) for one in d.exceedance]) for end in ("value", "lower", "upper")]
    names = ("probability of more", "lower end, 95 %", "upper end, 95 %")[: 1 if contradicted() else 3]
    readout = [Row(name, "%", [f"{v:.4f}" for v in values]) for name, values in zip(names, shares, strict=False)]
    numbers = _numbers(d)
    sections: list[Section] = [
        *panels,
        *_shares(d),
        Readout(readout, "At this force"),
        numbers,
        page_table("Quantiles of the largest |F|", quantile_table(d)),
        page_table("Where the spread comes from", _influences(d)),
        INPUTS,
        OPTIONS,
        Words("How to read where the spread comes from", [INFLUENCE]),
        Words("What the numbers do not contain", [DRAWN, MODEL, NOT_A_DEVICE]),
    ]
    return Page(
        title=f"Largest force of {len(d.peak)} synthetic people",
        subtitle="Exoskeleton beside a joint: forces over a population",
        time=d.levels,
        time_label="force [N]",
        headline=answer(d),
        facts=[(row[0], row[1]) for row in numbers.rows[:4]],
        start_frame=int(np.argmin(np.abs(d.levels - d.limit))),
        sections=tuple(sections),
        plays=False,
    )


def _shares(d: Drawn) -> list[Section]:
    """Bars of both shares of every factor, the largest total first; none where they could not be known."""
    if d.indices is None:
        return []
    kinds = {
        "total": (d.indices.total, d.indices.total_interval),
        "first-order": (d.indices.first, d.indices.first_interval),
    }
    rows = [
        IntervalRow(_factor(d, k), float(share[k]), float(ends[k][0]), float(ends[k][1]), kind)
        for k in _ordered(d.indices)
        for kind, (share, ends) in kinds.items()
    ]
    return [Intervals("Share of the variance, by factor", "share", rows, bars=True, words=SHARES)]


def _factor(d: Drawn, k: int) -> str:
    return " and ".join(_named(name) for name in d.sampling.factors[k].names)


MEANING = {
    "k": "stiffness of cuff and fixation",
    "l": "length of the link",
    "z": "distance of attachment and forearm",
    "x": "offset across the upper arm",
    "y": "offset along the upper arm",
}
"""What the quantities are, as on the pages of `elbow fit`."""


def _named(name: str) -> str:
    return f"{MEANING[name]} ({name})"


COLUMNS = {
    "rank_coefficient": "coefficient of ranks",
    "distance_rank_coefficient": "of the distance from the median",
    "sobol_first": "first-order share",
    "sobol_first_lower": "lower",
    "sobol_first_upper": "upper",
    "sobol_total": "total share",
    "sobol_total_lower": "lower ",
    "sobol_total_upper": "upper ",
}
"""Columns of the table of influences as the page calls them."""


def _influences(d: Drawn) -> pd.DataFrame:
    rows = influence_table(d).dropna(axis="columns", how="all")
    return (
        rows.assign(quantity=[_named(name) for name in rows["quantity"]]).drop(columns="factor").rename(columns=COLUMNS)
    )


def _force(value: float, digits: int = 3) -> str:
    """In N, in words where samples without a force reach that far."""
    return f"{value:.{digits}f} N" if np.isfinite(value) else "no finite force"


def _ordered(indices: Indices) -> list[int]:
    """Factors by their total share, the largest first."""
    return [int(k) for k in np.argsort(-indices.total, kind="stable")]


def answer(d: Drawn) -> list[str]:
    """How many are above the limit, the middle of them, and what makes them differ."""
    b, middle, high = d.beyond, d.quantiles[0.5], d.quantiles[0.95]
    told = (
        f"In {b.value:.2%} of {len(d.peak)} synthetic people the largest force is above {d.limit:g} N"
        f"{if_it_fits(f' (95 % interval {b.lower:.2%} … {b.upper:.2%})')}."
    )
    median = f"The median is {middle.value:.3g} N" if np.isfinite(middle.value) else "Half of them have no finite force"
    tail = f"95 % stay below {high.value:.3g} N" if np.isfinite(high.value) else "the 95 % quantile is infinite"
    most = ""
    if d.indices is not None:
        k = _ordered(d.indices)[0]
        most = f" Most of the spread comes from the {_factor(d, k)}: a total share of {d.indices.total[k]:.0%}."
    return [told, f"{median}; {tail}.{most}"]


def _numbers(d: Drawn) -> Table:
    b, middle, high = d.beyond, d.quantiles[0.5], d.quantiles[0.95]
    without = ", ".join(f"{int((d.fate == fate).sum())} {STATES[fate]}" for fate in WITHOUT_FORCE)
    rows = [
        (f"above {d.limit:g} N", f"{b.value:.2%}", f"{b.lower:.2%} … {b.upper:.2%}, exact"),
        ("median of the largest |F|", _force(middle.value), f"{_force(middle.lower)} … {_force(middle.upper)}"),
        ("95 % stay below", _force(high.value), f"{_force(high.lower)} … {_force(high.upper)}"),
        ("samples without a force", str(int((d.fate > 0).sum())), f"{without}: they count as beyond every force"),
        ("error of the grid of angles", f"{rounded(d.grid_error, 2)} N", "largest of those checked with a finer one"),
    ]
    if contradicted():
        rows = [(what, value, "") for what, value, _ in rows]
    return Table("Forces and exceedance", ("what", "value", "interval or note"), rows)
