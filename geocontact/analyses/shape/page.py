"""The page of a fit: the surface coloured by its distance to the shape, the numbers, and what they depend on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.finished_page import INPUTS, OPTIONS
from geocontact.analyses.page_words import NOT_A_DEVICE, headline
from geocontact.analyses.shape.colours import colour_end, outlying
from geocontact.analyses.shape.fitting import Fitting
from geocontact.geometry.fit.directions import across
from geocontact.geometry.fit.found import ShapeFit
from geocontact.view.page.content import Page, Picture, Scene, SceneBody, Section, Table, Words

MM = 1e3
ROUND = 72  # sides of the drawn cylinder, rings of the drawn sphere
SHAPE = "fitted {}"
BESIDE = (
    "Points beside the section of the shape, the map of what is left over, and its distribution; dashed: three times "
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
DRAWINGS = {"fit": ("The fit", BESIDE), "profile": ("Radius over flexion", OVER_FLEXION)}
DISTANCES = (
    "Distances are geometric. Points far off do not count (biweight, its scale from the median distance), unless plain "
    "least squares was asked for."
)
INTERVAL = (
    "The interval of the radius comes from leaving out one part of the patch after the other, so that it does not "
    "shrink as the mesh gets finer. It says nothing of another patch: which faces count decides the radius."
)


def fit_page(fitted: Fitting, drawings: Mapping[str, bytes], title: str, sentences: Sequence[str] = ()) -> Page:
    """The page of one fit.

    Parameters
    ----------
    drawings
        SVG of the figures by name; those that `DRAWINGS` names are shown.
    sentences
        What was found.
    """
    sections: list[Section] = [_scene(fitted)]
    sections += [Picture(*DRAWINGS[name], drawings[name], wide=name == "fit") for name in DRAWINGS if name in drawings]
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
        lines.append(("Radius", f"{fit.radius * MM:.3f} mm{known}"))
    q = fit.quality
    lines += [
        ("Distance of the points", f"rms {fit.rms * MM:.3f} mm, mean {fit.mean_abs * MM:.3f} mm"),
        ("Inliers", f"{int(q.inlier.sum())} of {len(q.residual)} points"),
    ]
    return lines


def _scene(fitted: Fitting) -> Scene:
    shape = fitted.whole.shape
    residual = fitted.residual
    distance = np.where(np.isnan(residual), np.inf, np.abs(residual))
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
        thresholds=(outlying(fitted.whole),),
        span=(0.0, colour_end(fitted.whole)),
        value_name=f"distance to the fitted {shape}, to either side; the line is three times the noise",
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
