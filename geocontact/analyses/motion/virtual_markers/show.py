"""The page of a model as it moves, with its markers."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.frame.pages import INPUTS, OPTIONS, thinned
from geocontact.analyses.frame.words import NOT_A_DEVICE, counted, rounded
from geocontact.analyses.motion.skeleton import JOINT, MARKER, scene_of, skeleton
from geocontact.data.motion import Course
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.view.curves.declared import Curve, Curves, CurveSheet
from geocontact.view.page.content import Linkage, Page, Scene, Section, Words

MM = 1e3
EXTREMES = ((np.nanargmin, np.nanmin), (np.nanargmax, np.nanmax))
"""Extremes of the heights: which marker is lowest, which highest."""
MODELLED = "Markers sit on rigid segments: they do not slide as those on skin do, and hold no noise of cameras."


def markers_page(
    title: str,
    model: Multibody,
    values: Float[np.ndarray, "t n"],
    markers: MarkerTrajectories,
) -> Page:
    """The page along coordinates [rad, m]."""
    shown = thinned(len(markers.time), list(markers.positions.reshape(len(markers.time), -1).T))
    places = markers.positions[shown]
    sections: list[Section] = [
        _picture(model, values[shown], places),
        *markers_curves(markers).at(shown),
        INPUTS,
        OPTIONS,
        Words("What the numbers do not contain", [MODELLED, NOT_A_DEVICE]),
    ]
    return Page(
        title=title,
        subtitle=f"Markers of {model.name or 'the model'} by forward kinematics, in the ground's frame",
        time=markers.time[shown],
        time_label="time [s]",
        headline=answer(model, markers),
        sections=tuple(sections),
        numbers=shown + 1,
        total=len(markers.time),
    )


def markers_curves(markers: MarkerTrajectories) -> CurveSheet:
    """Every axis of the markers over time."""
    panels = [
        Curves(
            f"{axis} of the markers",
            "mm",
            [Curve(n, MM * markers.positions[:, k, i]) for k, n in enumerate(markers.names)],
        )
        for i, axis in enumerate("xyz")
    ]
    return CurveSheet(panels, Course("time", "s", markers.time))


def answer(model: Multibody, markers: MarkerTrajectories) -> list[str]:
    """How many markers were followed for how long, how far they travel, and between which heights."""
    time, places = markers.time, markers.positions
    reach = np.linalg.norm(np.nanmax(places, axis=0) - np.nanmin(places, axis=0), axis=1)
    heights = MM * (places @ model.up)
    near, far = int(np.nanargmin(reach)), int(np.nanargmax(reach))
    low, high = (int(pick(end(heights, axis=0))) for pick, end in EXTREMES)
    told = f"{counted(len(markers.names), 'marker')} over {time[-1] - time[0]:.3g} s in {counted(len(time), 'frame')}"
    ends = (f"{rounded(MM * reach[k], 3)} mm ({markers.names[k]})" for k in (near, far))
    span = " to ".join(ends)
    least = f"{rounded(np.nanmin(heights[:, low]))} mm ({markers.names[low]})"
    most = f"{rounded(np.nanmax(heights[:, high]))} mm ({markers.names[high]})"
    return [
        f"{told}: they move within boxes of {span} across.",
        f"Heights over the ground's origin are {least} to {most}; markers.trc holds all places.",
    ]


def _picture(model: Multibody, values: Float[np.ndarray, "k n"], places: Float[np.ndarray, "k m 3"]) -> Scene:
    none: Int[np.ndarray, "0 2"] = np.zeros((0, 2), dtype=np.int64)
    own = Linkage("markers of the model", places, none, "model", MARKER, JOINT)
    bones = [skeleton(model, values)] if np.isfinite(values).all(axis=1).any() else []
    return scene_of(model, [*bones, own])
