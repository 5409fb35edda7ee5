r"""How the largest force spreads over people: `geocontact elbow population`, `gc.misalignment.population`.

>>> import geocontact as gc
>>> from pathlib import Path
>>> text = 'k = { value = 222, unit = "N/m" }\nl = { value = 169, unit = "mm" }\nz = { value = 127, unit = "mm" }\n'
>>> text += "".join(f'{name} = {{ unit = "mm", normal = {{ mean = 0, sd = 15 }} }}\n' for name in "xy")
>>> _ = Path("people.toml").write_text(text)
>>> result = gc.misalignment.population("people.toml", range=gc.deg(0, 120), limit=10.0, samples=20_000)
>>> print(result.sentences[0])
largest |F| of 20000 synthetic people: median … N (… … …), 95 % below … N (… … …)
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import as_it_fits, if_it_fits, judge, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import write_json
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.misalignment.population.drawn import (
    SHOWN,
    Drawn,
    Population,
    described,
    drawn,
    exceedance_table,
    influence_table,
    quantile_table,
    read,
    sample_table,
)
from geocontact.analyses.misalignment.population.options import PopulationOptions
from geocontact.analyses.misalignment.population.show import population_curves, population_page
from geocontact.axis_misalignment.planar_joint import FATES
from geocontact.identify.goodness_of_fit import MUCH, Doubt, GoodnessOfFit
from geocontact.identify.intervals.quantile_intervals import IntervalEstimate

if TYPE_CHECKING:
    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class PopulationResult(Result):
    """Largest forces of synthetic people: drawn, not measured.

    Parameters
    ----------
    drawn
        People, forces, and everything found of them, in SI.
    summary
        What `population.json` holds, with units in the keys.
    """

    options: PopulationOptions
    drawn: Drawn
    summary: dict[str, Any]

    @property
    def peak(self) -> Float[np.ndarray, " n"]:
        """Largest size of the constraint force of each person [N]."""
        return self.drawn.peak

    @property
    def quantiles(self) -> dict[float, float]:
        """Quantiles of the largest force by share [N]."""
        return {share: one.value for share, one in self.drawn.quantiles.items()}

    @property
    def exceeding(self) -> float:
        """Share of the people whose force is above the limit [-]."""
        return self.drawn.beyond.value

    def tables(self) -> dict[str, pd.DataFrame]:
        """`quantiles`, `exceedance`, `influence`, and `samples` with `keep`."""
        d = self.drawn
        found = {"quantiles": quantile_table(d), "exceedance": exceedance_table(d), "influence": influence_table(d)}
        return {**found, "samples": sample_table(d)} if self.options.keep else found

    def curves(self) -> dict[str, CurveSheet]:
        """`population`: the probability of more, and density of the largest force."""
        return {"population": population_curves(self.drawn)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Exceedance, figure, quantiles, where the spread comes from."""
        return {REPORT: population_page(self.drawn, self.curves()["population"].panels)}

    def write_files(self, folder: Path) -> None:
        """population.json besides."""
        write_json(folder / "population.json", self.summary)
        super().write_files(folder)


def run(population: Population, o: PopulationOptions) -> PopulationResult:
    """Quantiles of the largest force, how often it is above the limit, and what that depends on."""
    found = drawn(population.sampling, population.drift, o)
    judge(goodness_of(found))
    _reserve(found)
    _report(found)
    summary = as_it_fits(described(found))
    note("samples_per_second_of_one_core", found.rate)
    note("population", summary)
    return PopulationResult(options=o, drawn=found, summary=summary)


def goodness_of(d: Drawn) -> GoodnessOfFit:
    """Samples of which the law has no force: with half of them the description is of no people.

    Such samples count as beyond every force, so that a quantile is infinite from their share on.
    """
    doubts = []
    share = float(np.mean(~np.isfinite(d.peak)))
    for fate, words in FATES.items():
        hit = d.fate == fate
        if hit.any():
            first = zip(SHOWN.items(), d.people[int(np.argmax(hit))], strict=True)
            told = ", ".join(f"{name} = {value * per_si:.4g} {unit}" for (name, (unit, per_si)), value in first)
            what = f"{int(hit.sum())} of {len(hit)} samples count as beyond every force: {words}"
            asked = "; are the units of the description right?" if share >= MUCH else ""
            doubts.append(Doubt(f"{what} (the first: {told}){asked}", share >= MUCH, float(hit.mean())))
    return GoodnessOfFit(tuple(doubts), ("samples with a force",))


def _reserve(d: Drawn) -> None:
    if d.indices is None:
        why = "some samples have no force, or all the same" if d.sampling.independent else "factors are correlated"
        reserve(f"no shares of the variance, for {why}: the regression on ranks is all there is")


def _report(d: Drawn) -> None:
    middle, high = d.quantiles[0.5], d.quantiles[0.95]
    low = f"median {_interval_words(middle)}, 95 % below {_interval_words(high)}"
    say(f"largest |F| of {len(d.peak)} synthetic people: {low}")
    b = d.beyond
    interval = if_it_fits(f" ({b.lower:.4%} … {b.upper:.4%})")
    say(f"above {d.limit:g} N: {b.value:.4%}{interval}")
    say(f"{d.rate} samples per second of one core; grid of angles: error below {max(d.grid_error, 1e-9):.1e} N")


def _interval_words(e: IntervalEstimate) -> str:
    interval = if_it_fits(f" ({e.lower:.3f} … {e.upper:.3f})")
    return f"{e.value:.3f} N{interval}" if math.isfinite(e.value) else "infinite"


population = Job("elbow population", PopulationOptions, read, run)
