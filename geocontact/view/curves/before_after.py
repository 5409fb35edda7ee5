"""What adding an effect to a model changes: measured against simulated before and after, trial by trial."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float

from geocontact.view.curves.quantity import CYCLE, Quantity, array, positions
from geocontact.view.curves.sheet import number, plain
from geocontact.view.curves.style import BLACK, DOUBLE, GREY, PALETTE, SMALL, empty, in_style

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIDE_BY_SIDE = 6  # trials that fit into two columns' width
COLOURS, DASHES = (PALETTE[1], PALETTE[0]), ("--", "-")  # before, after
SHADE = "0.92"  # behind trials that nothing was fitted to


@in_style
def before_after(
    cycle: Float[np.ndarray, " t"],
    measured: Float[np.ndarray, "trials t"],
    before: Float[np.ndarray, "trials t"],
    after: Float[np.ndarray, "trials t"],
    quantity: Quantity,
    effect: str,
    held_out: Sequence[int] = (),
    names: Sequence[str] = (),
    along: Quantity = CYCLE,
) -> Figure:
    """Draw each trial's curves, its residuals below, and the RMSE before → after; held-out trials are shaded.

    Both errors are taken over the same samples: those at which measured, before and after are all there (not NaN).
    The legend gives them pooled over the fitted and over the held-out trials; only the latter speak for the effect.

    Parameters
    ----------
    cycle
        Where the samples lie: [%], or what `along` says.
    measured, before, after
        SI units; simulated without and with the effect, at the same instants.
    effect
        Name of what was added, for the legend.
    held_out
        Numbers of the trials (from 0) that no parameter was fitted to.
    names
        Names of the trials; "trial 1", "trial 2", … if not given.
    """
    from matplotlib.patches import Patch

    x = positions(along, cycle)
    data = array("measured", measured, ("trials", len(x)))
    models = [array(name, y, data.shape) for name, y in (("before", before), ("after", after))]
    count = len(data)
    if count > SIDE_BY_SIDE:
        raise ValueError(f"{count} trials: at most {SIDE_BY_SIDE} fit side by side; choose some and say which")
    if not set(held_out) <= set(range(count)):
        raise ValueError(f"held_out: {sorted(set(held_out))}, expected numbers of trials from 0 to {count - 1}")
    titles = list(names) or [f"trial {k + 1}" for k in range(count)]
    if len(titles) != count:
        raise ValueError(f"names: {len(titles)} for {count} trials")
    data, models = quantity.shown(data), [quantity.shown(y) for y in models]
    common = np.isfinite(data) & np.isfinite(models[0]) & np.isfinite(models[1])
    if not common.any(axis=1).all():
        raise ValueError(f"{titles[np.argmin(common.any(axis=1))]}: no sample at which all three are there")
    kept = np.isin(np.arange(count), list(held_out))

    figure = empty(DOUBLE, 0.085)
    axes = figure.subplots(2, count, sharex=True, sharey="row", squeeze=False, height_ratios=(2, 1))
    for k in range(count):
        top, strip = axes[:, k]
        handles = _curves(top, strip, x, data[k], [y[k] for y in models])
        errors = " → ".join(number(rmse(data[k] - y[k], common[k])) for y in models)
        heads = (titles[k], f"RMSE {errors} {quantity.unit}")
        top.set_title("\n".join(plain(head, 110 // count) for head in heads), fontsize=SMALL)
        if kept[k]:
            top.set_facecolor(SHADE)
            strip.set_facecolor(SHADE)
        strip.set_xlabel(along.label)
    axes[0, 0].set_xlim(x[0], x[-1] if len(x) > 1 else None)
    axes[0, 0].set_ylabel(quantity.label)
    axes[1, 0].set_ylabel(f"measured −\nsimulated [{plain(quantity.unit)}]")
    labels = ["measured"]
    for word, y in zip(("without", "with"), models, strict=True):
        parts = [("fitted", ~kept), ("held out", kept)]
        pooled = [f"{part} {number(rmse((data - y)[of], common[of]))}" for part, of in parts if of.any()]
        labels.append(plain(f"{word} {effect}: RMSE {', '.join(pooled)} {quantity.unit}", 110))
    if kept.any():
        handles.append(Patch(facecolor=SHADE))
        labels.append("held out: no parameter was fitted to this trial")
    figure.legend(handles, labels, loc="outside upper left", labelspacing=0.3)
    figure.align_ylabels()
    return figure


def rmse(residual: Float[np.ndarray, "*s"], counted: Bool[np.ndarray, "*s"]) -> float:
    """Root of the mean square of the residuals that count."""
    return float(np.sqrt(np.mean(residual[counted] ** 2)))


def _curves(
    top: Axes, strip: Axes, x: Float[np.ndarray, " t"], measured: Float[np.ndarray, " t"], models: list[np.ndarray]
) -> list[Artist]:
    lines: list[Artist] = []
    lines += top.plot(x, measured, color=BLACK, lw=2.4, alpha=0.35, solid_capstyle="butt")
    strip.axhline(0.0, color=GREY, lw=0.6)
    for simulated, colour, dashes in zip(models, COLOURS, DASHES, strict=True):
        lines += top.plot(x, simulated, color=colour, ls=dashes)
        strip.plot(x, measured - simulated, color=colour, ls=dashes)
    return lines
