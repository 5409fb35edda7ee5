"""A muscle swells under the strap while it works: the pad is pressed for the part of a trial in which one rises."""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.hooks import Hooks, Pull, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: bulge [m], pressed by the pad's own stiffness; from and to a share of the trial."""
    begin, end = rng.uniform(0.1, 0.35), rng.uniform(0.5, 0.75)
    rising, falling = rng.uniform(0.02, 0.05), rng.uniform(0.04, 0.09)
    stiffness = scale.force / scale.stroke

    def hooks(bulge: float) -> Hooks:
        def swollen(p: Pull) -> Values:
            share = p.time / scale.duration
            works = 0.5 * (np.tanh((share - begin) / rising) - np.tanh((share - end) / falling))
            return np.asarray(stiffness * bulge * works)

        return Hooks(beside=(swollen,))

    def words(bulge: float) -> str:
        return f"a muscle swells by {bulge:.3g} m from {begin:.0%} to {end:.0%} of a trial"

    return Draw(1e-4 * scale.stroke, 0.5 * scale.stroke, hooks, words)


SWELLING = InjectionPlan("swelling", ("sit_to_stand",), "bulge while a muscle works", "", draw, placed=True)
