"""The page of a scaled model: the static pose with its markers, factors, distances."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE
from geocontact.analyses.motion.marker_tasks import STANDING, MarkerErrors
from geocontact.analyses.motion.naming import Naming
from geocontact.analyses.motion.skeleton import markers_beside, scene_of, skeleton
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.view.page.content import IntervalRow, Intervals, Page, Section, Words

FACTORS = "How many times longer each segment is than in the model that was given; 1 keeps its size."
SKIN = (
    "Markers lie on skin and were put there by hand. Factors come from distances between them, so that the error of a "
    "short distance is large in its factor. Segments that are not named kept their size."
)


def scaling_page(
    title: str,
    model: Multibody,
    factors: Mapping[str, float],
    pose: Poses,
    both: tuple[Float[np.ndarray, "m 3"], Float[np.ndarray, "m 3"]],
    naming: Naming | None = None,
) -> Page:
    """The page of a scaled model.

    `both` are the markers of `pose` as they were seen and as the scaled model has them [m].
    """
    seen, modelled = (each[None] for each in both)
    values = np.asarray(pose.values)[:1]
    bones = [skeleton(model, values)] if np.isfinite(values).all() else []
    off = 1e3 * pose.distances[0]
    known = [int(k) for k in np.argsort(-off) if np.isfinite(off[k])]
    sections: list[Section] = [scene_of(model, [*bones, *markers_beside(seen, modelled)])]
    if factors:
        rows = [IntervalRow(name, by) for name, by in factors.items()]
        sections.append(Intervals("Scale factors", "times", rows, bars=True, words=FACTORS))
    sections += [
        Intervals("Distance of markers", "mm", [IntervalRow(pose.markers[k], off[k]) for k in known], bars=True),
        *([] if naming is None else [naming.section()]),
        INPUTS,
        OPTIONS,
        Words("What the numbers do not contain", [SKIN, NOT_A_DEVICE]),
    ]
    errors = MarkerErrors.of(pose)
    return Page(
        title=title,
        subtitle=f"{model.name or 'the model'} in its static pose",
        time=np.zeros(1),
        time_label="",
        headline=answer(factors, errors),
        facts=[
            ("Markers, root mean square", f"{1e3 * errors.rms:.1f} mm"),
            ("Largest distance", f"{1e3 * errors.largest:.1f} mm, {errors.marker}"),
            ("Mass", f"{sum(body.mass for body in model.bodies):.4g} kg"),
        ],
        sections=tuple(sections),
        plays=False,
    )


def answer(factors: Mapping[str, float], errors: MarkerErrors) -> list[str]:
    """How well the scaled model stands where the markers are, and which segments changed most."""
    good = errors.rms < STANDING.rms and errors.largest < STANDING.largest
    told = (
        f"The scaled model stands {1e3 * errors.rms:.1f} mm from the markers, root mean square, "
        f"{'within' if good else 'beyond'} what OpenSim advises ({STANDING.words})."
    )
    if not factors:
        return [told, "No segment was scaled."]
    least, most = min(factors, key=lambda name: factors[name]), max(factors, key=lambda name: factors[name])
    spread = f"Factors go from {factors[least]:.3f} ({least}) to {factors[most]:.3f} ({most})."
    return [told, spread if least != most else f"{most} is {factors[most]:.3f} times as long."]
