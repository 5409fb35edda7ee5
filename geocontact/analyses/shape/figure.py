"""The static figure of a fit: the points beside the shape, the map of what is left over, and how it is distributed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.analyses.shape.colours import colour_end
from geocontact.geometry.fit.directions import across
from geocontact.geometry.fit.found import ShapeFit
from geocontact.view.curves.style import BLACK, DOUBLE, GREY, empty, in_style
from geocontact.view.curves.text import plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MM = 1e3
MOST = 20_000  # points drawn; more are thinned out, always in the same way
RESIDUALS = "RdBu_r"  # diverging, white on the shape
SHARE = 98.0  # per cent of the residuals that the distribution shows


@dataclass(frozen=True, eq=False)
class _Seen:
    """Points as the panels show them [mm, deg]: beside the section of the shape, and unrolled."""

    section: Float[np.ndarray, "n 2"]
    section_labels: tuple[str, str]
    unrolled: Float[np.ndarray, "n 2"]
    unrolled_labels: tuple[str, str]


@in_style
def fit_figure(fit: ShapeFit, points: Float[np.ndarray, "n 3"], title: str) -> Figure:
    """Draw a fit, two columns wide: (a) section, (b) residuals unrolled, (c) their distribution.

    Parameters
    ----------
    fit
        Of these points.
    points
        What was fitted to [m].
    title
        Heading of the figure.
    """
    some = np.sort(np.random.default_rng(0).permutation(len(points))[:MOST])
    residual = fit.quality.residual * MM
    limit = max(float(np.percentile(np.abs(residual), SHARE)), 1e-9)
    end = colour_end(fit) * MM
    seen = _seen(fit, points[some])
    figure = empty(DOUBLE, 0.075)
    section, unrolled, spread = figure.subplots(1, 3, width_ratios=(1.0, 1.25, 0.8))
    for axes, xy, labels in (
        (section, seen.section, seen.section_labels),
        (unrolled, seen.unrolled, seen.unrolled_labels),
    ):
        dots = axes.scatter(
            *xy.T, c=residual[some], s=2.0, lw=0.0, cmap=RESIDUALS, vmin=-end, vmax=end, rasterized=True
        )
        axes.set_xlabel(labels[0])
        axes.set_ylabel(labels[1])
    figure.colorbar(dots, ax=unrolled, label="distance to the shape [mm]", extend="both", shrink=0.8)
    _outline(section, fit, seen.section)
    _distribution(spread, fit, residual, limit)
    figure.suptitle(plain(title, 110), fontsize=8)
    return figure


def _seen(fit: ShapeFit, points: Float[np.ndarray, "n 3"]) -> _Seen:
    offset = (points - fit.point) * MM
    if fit.axis is None:
        pole = offset.mean(axis=0)
        frame = across(pole if np.linalg.norm(pole) > 0.0 else np.array([0.0, 0.0, 1.0]))
        return _of_sphere(*(offset @ (frame * np.sign(frame[2] @ pole or 1.0)).T).T)
    u, v, w = (offset @ across(fit.axis).T).T
    if fit.radius is None:
        labels, beside = ("in the plane [mm]", "above the plane [mm]"), ("in the plane, u [mm]", "in the plane, v [mm]")
        return _Seen(np.column_stack([u, w]), labels, np.column_stack([u, v]), beside)
    angle = np.arctan2(v, u)
    middle = float(np.angle(np.exp(1j * angle).mean()))
    turned = np.degrees(np.angle(np.exp(1j * (angle - middle))))
    labels, beside = ("across, u [mm]", "across, v [mm]"), ("angle about the axis [°]", "along the axis [mm]")
    return _Seen(np.column_stack([u, v]), labels, np.column_stack([turned, w]), beside)


def _of_sphere(u: Float[np.ndarray, " n"], v: Float[np.ndarray, " n"], w: Float[np.ndarray, " n"]) -> _Seen:
    """Meridian section, and an equal-area map about the pole (Lambert)."""
    aside = np.hypot(u, v)
    polar = np.arctan2(aside, w)
    share = 2.0 * np.degrees(np.sin(0.5 * polar)) / np.maximum(aside, 1e-12)
    labels, beside = ("off the pole [mm]", "along it [mm]"), ("equal-area map, u [°]", "equal-area map, v [°]")
    return _Seen(np.column_stack([aside, w]), labels, np.column_stack([share * u, share * v]), beside)


def _outline(axes: Axes, fit: ShapeFit, section: Float[np.ndarray, "n 2"]) -> None:
    if fit.radius is None:
        axes.axhline(0.0, color=BLACK, lw=0.8)
        return
    turn = np.linspace(-0.5 * np.pi, (0.5 if fit.axis is None else 1.5) * np.pi, 361)
    axes.plot(fit.radius * MM * np.cos(turn), fit.radius * MM * np.sin(turn), color=BLACK, lw=0.8)
    reach = 1.05 * max(float(np.abs(section).max()), fit.radius * MM)
    if fit.radius * MM > 4.0 * float(np.ptp(section, axis=0).max()):  # a flat arc: show the points, not the circle
        lower, upper = section.min(axis=0), section.max(axis=0)
        axes.set_xlim(lower[0], upper[0])
        axes.set_ylim(lower[1], upper[1])
    else:
        axes.set_xlim(-reach if fit.axis is not None else 0.0, reach)
        axes.set_ylim(-reach, reach)
    axes.set_aspect("equal", adjustable="box")


def _distribution(axes: Axes, fit: ShapeFit, residual: Float[np.ndarray, " n"], limit: float) -> None:
    edges = np.linspace(-1.5 * limit, 1.5 * limit, 61)
    axes.hist(np.clip(residual, edges[0], edges[-1]), edges.tolist(), color=GREY, lw=0.0)
    for sign in (-1.0, 1.0):
        axes.axvline(3.0 * sign * fit.quality.noise * MM, color=BLACK, lw=0.6, ls="--")
    axes.set_xlim(edges[0], edges[-1])
    axes.set_xlabel("distance [mm]")
    axes.set_ylabel("points")
    words = [f"rms {fit.rms * MM:.3g} mm", f"inliers {int(fit.quality.inlier.sum())} of {len(residual)}"]
    if fit.radius is not None:
        words.insert(0, f"R = {fit.radius * MM:.2f} mm")
    axes.set_title("\n".join(words), fontsize=7)
