"""Contact areas of several pairs of bodies in one motion: `geocontact pairs`, `gc.area_pairs`.

>>> import geocontact as gc
>>> result = gc.area_pairs("meshes/knee_pairs.toml", rule="clip")
>>> print(result.sentences[-1])
all pairs: area within 4 mm 2575.6 … 3242.8 mm^2, most at 0.56 s
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.area.contact import MotionResult, area_table, tables_of
from geocontact.analyses.area.motion_outputs import figure_of, page_of, pressure_figure_of
from geocontact.analyses.area.pairs.bodies import TouchingBodies, TouchingPair, doubt_together, of_pair, read
from geocontact.analyses.area.pairs.options import PairsOptions
from geocontact.analyses.area.pairs.show import pair_curves, thinned_page
from geocontact.analyses.area.pairs.totals import (
    body_loads,
    counted_twice,
    loads_table,
    pair_loads,
    pair_loads_table,
    total_area,
    totals_table,
)
from geocontact.analyses.area.result import over_motion
from geocontact.analyses.frame.collector import current, listener, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.pages import Thinned
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.data.evolution import MM, MM2
from geocontact.io.text.tables import listed
from geocontact.view.curves.declared import CurveSheet

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class PairsResult(Result):
    """Contact of several pairs of bodies over one motion.

    Parameters
    ----------
    pairs
        The pairs, and how all bodies move.
    motions
        What was found of each pair, in their order.
    """

    options: PairsOptions
    pairs: TouchingBodies
    motions: tuple[MotionResult, ...]

    @property
    def folders(self) -> tuple[str, ...]:
        """The folder itself, and one for each pair."""
        return ("", *(one.name for one in self.motions))

    @property
    def title(self) -> str:
        """The pairs."""
        return f"Contact of {listed(self.pairs.names)}"

    @property
    def time(self) -> Float[np.ndarray, " t"]:
        """Time of the frames [s]."""
        return self.pairs.time

    @property
    def thresholds(self) -> Float[np.ndarray, " k"]:
        """Largest distance that counts as contact [m]."""
        return np.asarray(self.options.threshold)

    @property
    def area(self) -> Float[np.ndarray, "t k"]:
        """Sum over the pairs of the contact area on FIXED [m^2]."""
        return total_area(self.motions)

    @property
    def areas(self) -> dict[str, Float[np.ndarray, "t k"]]:
        """Contact area on FIXED of each pair [m^2]."""
        return {one.name: one.evolution.fixed.area for one in self.motions}

    @property
    def loads(self) -> dict[str, Float[np.ndarray, "t 6"]]:
        """Force [N] and moment about the common frame's origin [N m] on each body, by pairs that have a layer."""
        return body_loads(self.pair_loads, self.pairs.of_pairs)

    @property
    def pair_loads(self) -> dict[str, Float[np.ndarray, "t 6"]]:
        """The same of each pair that has a layer, on its FIXED; MOVING bears the opposite."""
        return pair_loads(self.pairs, self.motions)

    def tables(self) -> dict[str, pd.DataFrame]:
        """`totals`, `pairs` (rows of all), `loads`, `pair_loads` with a layer; of each pair those of `area`."""
        whole = [(one.name, area_table(one, pair.options)) for pair, one in self._both()]
        found = {"totals": totals_table(self.motions, self.time)}
        found["pairs"] = pd.concat([table.assign(pair=name) for name, table in whole], ignore_index=True)
        found["pairs"].insert(0, "pair", found["pairs"].pop("pair"))
        if loads := self.loads:
            found["loads"] = loads_table(loads, self.time)
            found["pair_loads"] = pair_loads_table(self.pair_loads, self.pairs.of_pairs, self.time)
        for pair, one in self._both():
            found |= {f"{one.name}/{name}": table for name, table in tables_of(pair.bodies, one, pair.options).items()}
        return found

    def _both(self) -> list[tuple[TouchingPair, MotionResult]]:
        return list(zip(self.pairs.pairs, self.motions, strict=True))

    def curves(self) -> Mapping[str, CurveSheet]:
        """Areas and least distances by pair."""
        return {"pairs": pair_curves(self.pairs, self.motions)}

    def figures(self) -> dict[str, Figure]:
        """`pairs`, and those of `area` for each pair."""
        found = super().figures()
        for pair, one in self._both():
            found[f"{one.name}/area"] = figure_of(pair.bodies, one)
            if one.pressure is not None:
                found[f"{one.name}/pressure"] = pressure_figure_of(pair.bodies, one, one.pressure)
        return found

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Thinned]:
        """All bodies together, and the page of each pair."""
        pages = {f"{one.name}/{REPORT}": page_of(pair.bodies, one) for pair, one in self._both()}
        return {REPORT: thinned_page(self.title, self.pairs, self.motions), **pages}

    def reservations(self, folder: str) -> tuple[str, ...]:
        """Those of one pair, or all."""
        own = {one.name: one.reservations for one in self.motions}
        return own.get(folder, self.warnings)


def run(pairs: TouchingBodies, o: PairsOptions) -> PairsResult:
    """Every pair after the other."""
    if pairs.free:
        reserve(
            f"{o.description}: [[free]] has no effect: bodies stay as recorded; `settle-pairs` lets them come to rest"
        )
    doubt_together(pairs, o.description)
    for body, one, other, whole in counted_twice(pairs.pairs):
        reserve(f"faces of {body} count in {one} and in {other}: where both touch, {whole} them twice")
    shared = tuple(current().warnings)
    with listener().preparing():
        motions = tuple(_evaluated(pair, o, shared) for pair in pairs.pairs)
    _say_total(pairs, motions)
    return PairsResult(options=o, pairs=pairs, motions=motions)


def _evaluated(pair: TouchingPair, o: PairsOptions, shared: tuple[str, ...]) -> MotionResult:
    with of_pair(o.description, pair.name):
        return over_motion(pair.bodies, pair.options, pair.name, pair.motion, shared)


def _say_total(pairs: TouchingBodies, motions: tuple[MotionResult, ...]) -> None:
    e, course = motions[0].evolution, pairs.pairs[0].motion.course
    summary: dict[str, object] = {"pairs": list(pairs.names)}
    for k, threshold in enumerate(e.thresholds):
        total = total_area(motions)[:, k] * MM2
        most = int(np.argmax(total))
        summary[f"area_mm2_at_{threshold * MM:g}_mm"] = [round(float(total.min()), 3), round(float(total.max()), 3)]
        say(
            f"all pairs: area within {threshold * MM:g} mm {total.min():.1f} … {total.max():.1f} mm^2, most at "
            f"{course.at(most)}"
        )
    note("total", summary)


area_pairs = Job("pairs", PairsOptions, read, run)
