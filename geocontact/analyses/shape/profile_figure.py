"""Radius over flexion, side by side: what a single radius of a femoral component hides."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from geocontact.geometry.fit.found import ShapeFit
from geocontact.geometry.fit.profile import SagittalProfile
from geocontact.view.curves.style import GREY, LINES, MARKERS, PALETTE, SINGLE, in_style, legend, panels

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure

MM = 1e3


@in_style
def profile_figure(profiles: Mapping[str, SagittalProfile], whole: ShapeFit) -> Figure:
    """Draw the radius over flexion with its 95 % intervals, and the one radius of the whole patch."""
    figure, (axes,) = panels(1, 1, SINGLE, 0.065)
    entries: list[tuple[Artist | tuple[Artist, ...], str]] = []
    for k, (name, p) in enumerate(profiles.items()):
        degrees, radius, half = np.degrees(p.angle), p.radius * MM, p.half_width * MM
        axes.fill_between(degrees, radius - half, radius + half, color=PALETTE[k], alpha=0.2, lw=0)
        line = axes.plot(degrees, radius, color=PALETTE[k], ls=LINES[k], marker=MARKERS[k], markersize=2.5)[0]
        entries.append((line, name))
    if whole.radius is not None and whole.axis is not None:
        line = axes.axhline(whole.radius * MM, color=GREY, lw=0.8, ls=":")
        entries.append((line, f"one cylinder, {whole.radius * MM:.2f} mm"))
    axes.set_xlabel("flexion [°]")
    axes.set_ylabel("sagittal radius [mm]")
    axes.set_ylim(bottom=0.0)
    legend(axes, entries)
    return figure
