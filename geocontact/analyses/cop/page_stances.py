"""Parts of the page: the centre of pressure along the foot, and the stances over 0 … 100 %."""

from __future__ import annotations

import numpy as np
from jaxtyping import Int

from geocontact.analyses.cop.along_foot import NAMES, SHARE, along_foot, stance_table, stances
from geocontact.analyses.cop.foot_loads import FootLoads, loads_table
from geocontact.analyses.figure_files import drawing
from geocontact.view.curves.sheet import sheet
from geocontact.view.page.content import Curve, Curves, Picture

PERCENT = 100.0
STANCES = (
    "Every complete stance as a line, from where the normal force reaches the gate until it falls below: 0 to 100 % of "
    "its own duration. stances.csv has the values."
)


def foot_curves(r: FootLoads, shown: Int[np.ndarray, " k"]) -> list[Curves]:
    """Place of each centre from the heel [% of the foot's length]."""
    within = along_foot(r)
    if within is None:
        return []
    shares = [str(name) for name in within.columns if str(name).endswith(SHARE)]
    curves = [
        Curve(name.removesuffix(SHARE).replace("_", " "), within[name].to_numpy(float)[shown] * PERCENT)
        for name in shares
    ]
    return [Curves("Centre of pressure along the foot, from the heel", "% of foot length", curves)]


def stance_pictures(r: FootLoads) -> list[Picture]:
    """Normal force, and the centre along the foot where that is known, over the stance; none without a stance."""
    if not r.options.stances or not stances(r):
        return []
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    table = stance_table(r, loads_table(r))
    panels = [("normal [N]", "normal force [N]", 1.0)]
    if r.axis is not None:
        panels.append((f"{NAMES[r.options.point]}{SHARE}", "centre from the heel [% of foot length]", PERCENT))
    figure = sheet(4.6 * len(panels), 3.2)
    FigureCanvasAgg(figure)
    for axes, (name, label, factor) in zip(np.ravel(figure.subplots(1, len(panels))), panels, strict=True):
        for _, one in table.groupby("stance [-]"):
            axes.plot(one["cycle [%]"], one[name] * factor, lw=1.0)
        axes.set_xlabel("stance [%]")
        axes.set_ylabel(label)
    return [Picture("Over the stance", STANCES, drawing(figure), wide=len(panels) > 1)]
