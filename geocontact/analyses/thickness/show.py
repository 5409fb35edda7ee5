"""What is shown of a thickness: how it is distributed, and the surface coloured by it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.data.motion import Course
from geocontact.geometry.surface import Surface
from geocontact.geometry.thickness import ThicknessMap
from geocontact.view.curves.declared import Curve, Curves, CurveSheet
from geocontact.view.page.content import FaceMap, Page, Scene, SceneBody, Words

MM = 1e3
SHARES = np.linspace(0.0, 1.0, 101)
MEASURES = {"along": "along the normal", "nearest": "nearest distance"}


def thickness_curves(found: ThicknessMap) -> CurveSheet:
    """Thickness below which a share of the area lies, by both measures."""
    over = Course("share of the area", "-", SHARES)
    curves = [Curve(words, found.quantiles(getattr(found, name), SHARES) * MM) for name, words in MEASURES.items()]
    words = "Sorted by thickness, faces weighted with their area; only those that have a thickness."
    return CurveSheet([Curves("Thickness", "mm", curves, over=over, words=words)])


def on_faces(
    found: ThicknessMap, values: Float[np.ndarray, " k"], faces: int, none: float = 0.0
) -> Float[np.ndarray, " f"]:
    """Values of the faces that count among all; `none` where there is none."""
    every = np.full(faces, none)
    every[found.face] = np.where(np.isnan(values), none, values)
    return every


def thickness_page(outer: Surface, inner: Surface, found: ThicknessMap, title: str, sentences: Sequence[str]) -> Page:
    """The page of one map."""
    count = len(outer.faces)
    maps = [
        FaceMap(f"thickness, {words}", "mm", 0, on_faces(found, getattr(found, name) * MM, count)[None])
        for name, words in MEASURES.items()
    ]
    scene = Scene(
        bodies=(
            SceneBody(outer.name, outer.vertices, outer.faces),
            SceneBody(inner.name, inner.vertices, inner.faces, opacity=0.25),
        ),
        thresholds=(found.most,),
        span=(0.0, found.most),
        value_name="thickness",
        maps=maps,
    )
    return Page(
        title=title,
        subtitle=f"{len(found.face)} of {count} faces of {outer.name} count; those without a thickness are left grey",
        time=np.zeros(1),
        time_label="time [s]",
        headline=headline(sentences),
        facts=facts(found),
        sections=(scene, *thickness_curves(found).panels, INPUTS, OPTIONS, Words("How to read it", _words(found))),
    )


def facts(found: ThicknessMap) -> list[tuple[str, str]]:
    """Mean, range and volume."""
    lines = []
    for name, words in MEASURES.items():
        values = getattr(found, name)
        if np.isfinite(values).any():
            mean, sd = found.mean_sd(values)
            span = f"{np.nanmin(values) * MM:.2f} … {np.nanmax(values) * MM:.2f} mm"
            lines.append((f"Thickness, {words}", f"mean {mean * MM:.2f} mm, SD {sd * MM:.2f} mm, {span}"))
    lines.append(("Area with a thickness", f"{found.covered:.1%} of {found.area.sum() * MM**2:.0f} mm²"))
    lines.append(("Thickness times area", f"{found.volume * MM**3:.0f} mm³"))
    return lines


def _words(found: ThicknessMap) -> list[str]:
    way = "along" if found.outwards else "against"
    measured = (
        f"From the centroid of each face of the outer surface: {way} its normal to where the inner surface is met, and "
        f"to the nearest point of the inner surface. Beyond {found.most * MM:g} mm a face has no thickness."
    )
    differ = (
        "The nearest distance is never more than the one along the normal. They differ where the surfaces are not "
        "parallel: near edges and where the outer surface is rough."
    )
    volume = "Thickness times area is the volume of the layer where it is thin beside the radii of its surfaces."
    return [measured, differ, volume, NOT_A_DEVICE]
