"""What is shown of a fit: static figures of residuals and profile, and the page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.frame.collector import if_it_fits
from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.data.motion import Course
from geocontact.geometry.fit.found import OUTLYING, ShapeFit
from geocontact.geometry.fit.patch import Fitting
from geocontact.geometry.fit.profile import SagittalProfile
from geocontact.geometry.fit.solver import across
from geocontact.view.curves.declared import Curve, Curves, CurveSheet, Limit, stroke
from geocontact.view.curves.sheet import plain
from geocontact.view.curves.style import (
    BLACK,
    DOUBLE,
    GREY,
    SMALL,
    empty,
    in_style,
)
from geocontact.view.page.content import Page, Picture, Scene, SceneBody, Section, Table, Words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


FINEST = 1e-6  # m; what the colours resolve at least
BEYOND = 1.5  # times the distance from which on a point is an outlier


def outlying(fit: ShapeFit) -> float:
    """Distance beyond which a point is called an outlier: three times the noise [m]."""
    return max(OUTLYING * fit.quality.noise, FINEST)


def colour_end(fit: ShapeFit) -> float:
    """Distance from the shape, to either side, at which the colours end [m]."""
    return BEYOND * outlying(fit)


MM = 1e3
MOST = 20_000  # points drawn; more are thinned out, always in the same way
SIDES = dict.fromkeys(("cylinder", "sphere"), "above 0 outside") | {"plane": "above 0 where its normal points"}
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
    axes.set_title("\n".join(words), fontsize=SMALL)


def profile_curves(profiles: Mapping[str, SagittalProfile], whole: ShapeFit) -> CurveSheet:
    """The radius over flexion with its 95 % intervals, and the one radius of the whole patch."""
    angle = np.unique(np.concatenate([p.angle for p in profiles.values()]))
    curves = []
    for k, (name, p) in enumerate(profiles.items()):
        radius, lower, upper = np.full((3, len(angle)), np.nan)
        there = np.searchsorted(angle, p.angle)
        radius[there], lower[there], upper[there] = (
            MM * each for each in (p.radius, p.radius - p.half_width, p.radius + p.half_width)
        )
        curves.append(Curve(name, radius, lower, upper, stroke(k, k)))
    one = whole.radius is not None and whole.axis is not None
    limits = [Limit(f"one cylinder, {whole.radius * MM:.2f} mm", whole.radius * MM)] if one and whole.radius else []
    over = Course("flexion", "°", np.degrees(angle))
    return CurveSheet([Curves("Sagittal radius", "mm", curves, limits=limits, over=over, words=OVER_FLEXION)])


ROUND = 72  # sides of the drawn cylinder, rings of the drawn sphere
SHAPE = "fitted {}"
BESIDE = (
    "Points and the section of the shape, the map of the residuals, and their distribution; dashed: three times "
    "the noise, beyond which a point is called an outlier."
)
OVER_FLEXION = (
    "Radius of circles fitted to windows of the outline as seen along the axis, with 95 % intervals; a single radius "
    "holds where the curve is level."
)
WAYS = {  # by axis: which way a mesh's axes point in the body is not known here
    f"{sign}{axis}": tuple(turn * float(axis == other) for other in "xyz")
    for axis in "xyz"
    for sign, turn in (("+", 1.0), ("−", -1.0))
}
DISTANCES = (
    "Distances are geometric. Outliers are ignored (biweight, its scale from the median distance), unless ordinary "
    "least squares was requested."
)
INTERVAL = (
    "The interval of the radius comes from leaving out one part of the patch after the other, so it does not shrink "
    "as the mesh gets finer. It holds for this patch only: other faces give another radius."
)


def fit_page(
    fitted: Fitting,
    drawings: Mapping[str, bytes],
    title: str,
    sentences: Sequence[str] = (),
    curves: Sequence[Curves] = (),
) -> Page:
    """The page of one fit.

    Parameters
    ----------
    drawings
        SVG of the figures by name, of which `fit` is shown where it is there.
    curves
        Those of `profile_curves`, where they were asked for.
    sentences
        What was found.
    """
    sections: list[Section] = [_scene(fitted), *curves]
    sections += [Picture("The fit", BESIDE, drawings[name], wide=True) for name in ("fit",) if name in drawings]
    sections += [_fits(fitted), INPUTS, OPTIONS, Words("How far to trust it", _words(fitted))]
    patch = fitted.patch
    chosen = f"Fitted to {int(patch.faces.sum())} of {len(patch.faces)} faces of {patch.surface.name}"
    return Page(
        title=title,
        subtitle=f"{chosen}; the others are left grey",
        time=np.zeros(1),
        time_label="time [s]",
        headline=headline(sentences),
        facts=_facts(fitted.whole),
        sections=tuple(sections),
    )


def _facts(fit: ShapeFit) -> list[tuple[str, str]]:
    lines = []
    if fit.radius is not None:
        interval = fit.radius_interval
        known = "" if interval is None else f" (95 % interval {interval[0] * MM:.3f} … {interval[1] * MM:.3f} mm)"
        lines.append(("Radius", f"{fit.radius * MM:.3f} mm{if_it_fits(known)}"))
    q = fit.quality
    lines += [
        ("Distance of the points", f"rms {fit.rms * MM:.3f} mm, mean {fit.mean_abs * MM:.3f} mm"),
        ("Inliers", f"{int(q.inlier.sum())} of {len(q.residual)} points"),
    ]
    return lines


def _scene(fitted: Fitting) -> Scene:
    shape = fitted.whole.shape
    residual = fitted.residual
    distance = np.where(np.isnan(residual), np.inf, residual)
    limit, end = outlying(fitted.whole), colour_end(fitted.whole)
    bodies = [
        SceneBody(
            fitted.patch.surface.name,
            fitted.patch.surface.vertices,
            fitted.patch.surface.faces,
            distance=distance[None],
        )
    ]
    vertices, faces = drawn(fitted)
    bodies.append(SceneBody(SHAPE.format(shape), vertices, faces, opacity=0.2))
    return Scene(
        bodies=bodies,
        thresholds=(limit, -limit),
        span=(-end, end),
        value_name=f"distance to the fitted {shape}: {SIDES[shape]}; the lines are three times the noise",
        sides=True,
        directions=WAYS,
    )


def drawn(fitted: Fitting) -> tuple[Float[np.ndarray, "k 3"], Int[np.ndarray, "l 3"]]:
    """Triangles of the shape [m], as far as the patch reaches."""
    fit = fitted.whole
    offset = fitted.patch.surface.vertices[np.isfinite(fitted.residual)] - fit.point
    frame = across(np.array([0.0, 0.0, 1.0]) if fit.axis is None else fit.axis)
    local = offset @ frame.T
    lower, upper = local.min(axis=0), local.max(axis=0)
    if fit.radius is None:
        u, v = np.meshgrid([lower[0], upper[0]], [lower[1], upper[1]], indexing="ij")
        grid = np.stack([u, v, np.zeros((2, 2))], axis=-1)
    elif fit.axis is None:
        turn, rise = np.meshgrid(
            np.linspace(0.0, 2.0 * np.pi, ROUND + 1), np.linspace(0.01, np.pi - 0.01, ROUND // 2), indexing="ij"
        )
        ring = np.stack([np.cos(turn) * np.sin(rise), np.sin(turn) * np.sin(rise), np.cos(rise)], axis=-1)
        grid = fit.radius * ring
    else:
        turn, height = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, ROUND + 1), [lower[2], upper[2]], indexing="ij")
        grid = np.stack([fit.radius * np.cos(turn), fit.radius * np.sin(turn), height], axis=-1)
    rows, columns = grid.shape[:2]
    corner = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (part.ravel() for part in (corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]))
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return grid.reshape(-1, 3) @ frame + fit.point, faces


def _fits(fitted: Fitting) -> Table:
    header = ("points", "radius [mm]", "95 % interval [mm]", "rms [mm]", "mean [mm]", "inliers", "arc [°]")
    rows = []
    for name, fit in {"whole patch": fitted.whole, **fitted.sides}.items():
        interval = fit.radius_interval
        radius = "–" if fit.radius is None else f"{fit.radius * MM:.3f}"
        span = "–" if interval is None else f"{interval[0] * MM:.3f} … {interval[1] * MM:.3f}"
        distances = (f"{fit.rms * MM:.3f}", f"{fit.mean_abs * MM:.3f}")
        counts = (f"{int(fit.quality.inlier.sum())}", f"{np.degrees(fit.arc):.0f}")
        rows.append((f"{name}: {len(fit.quality.residual)}", radius, span, *distances, *counts))
    return Table("Fitted shapes", header, rows)


def _words(fitted: Fitting) -> list[str]:
    words = [DISTANCES]
    if fitted.whole.radius is not None:
        words.append(INTERVAL)
        if fitted.whole.rms_inliers > 0.01 * fitted.whole.radius:
            words.append(
                f"The points depart from the {fitted.whole.shape} by more than a hundredth of its radius: the surface "
                "is not one, and its radius is a mean of several."
            )
    return [*words, NOT_A_DEVICE]
