"""Forces by an identified law beside those measured, and how sharply the data tell its modulus."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.identify.intervals.profile_likelihood import Profile
from geocontact.view.curves.quantity import FORCE, TIME
from geocontact.view.curves.style import DOUBLE, GREY, LINES, PALETTE, in_style, legend, panels

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False)
class ForcePair:
    """Measured and predicted force [N] over time [s]."""

    time: Float[np.ndarray, " n"]
    measured: Float[np.ndarray, " n"]
    predicted: Float[np.ndarray, " n"]


@in_style
def modulus_figure(pairs: Mapping[str, ForcePair], profiles: Mapping[str, Profile]) -> Figure:
    """Draw forces over time on the left (measured solid, predicted dashed), profiles of E* on the right.

    A profile is the rise of the sum of squares in units of the cut: the interval of 95 % ends where it is 1.
    """
    figure, (forces, shape) = panels(1, 2, DOUBLE, 0.075)
    entries: list[tuple[Artist | tuple[Artist, ...], str]] = []
    for k, (side, pair) in enumerate(pairs.items()):
        line = forces.plot(pair.time, pair.measured, color=PALETTE[k], label="_")[0]
        dashed = forces.plot(pair.time, pair.predicted, color=PALETTE[k], ls="--", lw=1.0)[0]
        entries += [(line, f"{side}, measured"), (dashed, f"{side}, by the law")]
    forces.set_xlabel(TIME.label)
    forces.set_ylabel(FORCE.label)
    legend(forces, entries)
    curves: list[tuple[Artist | tuple[Artist, ...], str]] = []
    for k, (side, p) in enumerate(profiles.items()):
        marker = "." if len(p.values) == 1 else ""
        curve = shape.plot(p.values * 1e-6, p.rise, color=PALETTE[k], ls=LINES[k], marker=marker)[0]
        shape.axvline(p.best * 1e-6, color=PALETTE[k], lw=0.5, ls=":")
        curves.append((curve, side))
    shape.axhline(1.0, color=GREY, lw=0.6)
    shape.set_ylim(0.0, 2.0)
    shape.set_xlabel("E* [MPa]")
    shape.set_ylabel("rise of the profile / cut at 95 %")
    legend(shape, curves)
    return figure
