"""Single cycles of a recording beside the mean of their style, along the recording's own time."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.analyses.loadcells.cycles import Cut, stacked
from geocontact.data.ensemble import mean_and_sd
from geocontact.identify.signals.cycles import STEPS
from geocontact.view.page.content import Curve


def beside_their_mean(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, " t"], cuts: list[Cut], recording: str, side: str
) -> list[Curve]:
    """The force and, within each of its cycles, mean ± SD of that cycle's style; nothing between the cycles."""
    mean, lower, upper = (np.full(len(time), np.nan) for _ in range(3))
    styles = {style: mean_and_sd(trials) for style, trials in stacked(cuts, side).items()}
    for cut in cuts:
        if cut.recording != recording:
            continue
        inside = (time >= cut.span.start) & (time <= cut.span.end)
        place = 100.0 * (time[inside] - cut.span.start) / (cut.span.end - cut.span.start)
        level, spread = (np.interp(place, STEPS, each) for each in styles[cut.style])
        mean[inside], lower[inside], upper[inside] = level, level - spread, level + spread
    known = np.isfinite(values)
    for each in (mean, lower, upper):
        each[~known] = np.nan
    band = (lower, upper) if np.isfinite(lower).any() else (None, None)
    return [Curve("as recorded", values), Curve("mean of the cycles ± SD", mean, *band)]
