"""The page of coordinates over time, and how far each marker is from the model."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.frame.collector import contradicted
from geocontact.analyses.frame.pages import INPUTS, OPTIONS, thinned
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.analyses.motion.gait_cycles import cycles_curves
from geocontact.analyses.motion.inverse_kinematics.segment_fit import SegmentFit
from geocontact.analyses.motion.inverse_kinematics.segments import Segments
from geocontact.analyses.motion.marker_tasks import MarkerErrors
from geocontact.analyses.motion.naming import Naming
from geocontact.analyses.motion.panels import panels_of
from geocontact.analyses.motion.skeleton import markers_beside, scene_of, skeleton
from geocontact.data.motion import Course
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.identify.signals.gait_cycles import GaitCycles
from geocontact.view.curves.declared import Curve, Curves, CurveSheet
from geocontact.view.page.content import Page, Readout, Row, Scene, Section, Table, Words

SKIN = (
    "Markers lie on skin, which slides over bone by centimetres, and the model's joints are not the subject's: the "
    "distances above show how well both agree, not how wrong the angles are. Angles of joints that few markers "
    "determine, and rotations about the long axis of a segment, are the least certain."
)


def kinematics_page(
    title: str,
    model: Multibody,
    found: Poses,
    seen: MarkerTrajectories,
    cycles: GaitCycles,
    sentences: Sequence[str] = (),
    naming: Naming | None = None,
) -> Page:
    """The page of coordinates over time."""
    shown = thinned(len(found.time), [*np.asarray(found.values).T, *found.distances.T])
    off = 1e3 * found.distances
    sections: list[Section] = [
        _picture(model, found, seen, shown),
        Readout([Row("markers, root mean square", "mm", [_size(row) for row in off[shown]])]),
        *kinematics_curves(model, found).at(shown),
        *cycles_curves(cycles),
        _markers(found),
        *([] if naming is None else [naming.section()]),
        INPUTS,
        OPTIONS,
        Words("What the numbers do not contain", [SKIN, NOT_A_DEVICE]),
    ]
    return Page(
        title=title,
        subtitle=f"{len(found.names)} coordinates of {model.name or 'the model'} from {len(found.markers)} markers",
        time=found.time[shown],
        time_label="time [s]",
        headline=[*answer(found), *headline(sentences[1:], most=1)],
        facts=[
            ("Distance of markers, root mean square", f"{np.sqrt(np.nanmean(off**2)):.1f} mm"),
            ("Largest distance", f"{np.nanmax(off):.1f} mm"),
        ],
        sections=tuple(sections),
        numbers=shown + 1,
        total=len(found.time),
    )


def segments_page(
    title: str,
    model: Multibody,
    found: Poses,
    cycles: GaitCycles,
    sentences: Sequence[str],
    segments: Segments,
    fit: SegmentFit,
) -> Page:
    """The same from poses of segments or orientations of sensors."""
    shown = thinned(len(found.time), [*np.asarray(found.values).T, *fit.angles.T])
    values = np.asarray(found.values)[shown]
    sections: list[Section] = [
        *([scene_of(model, [skeleton(model, values)])] if np.isfinite(values).all(axis=1).any() else []),
        Readout(fit.rows(shown)),
        *kinematics_curves(model, found, fit).at(shown),
        *cycles_curves(cycles),
        fit.section(segments),
        INPUTS,
        OPTIONS,
        Words("What the numbers do not contain", [STILL, NOT_A_DEVICE]),
    ]
    return Page(
        title=title,
        subtitle=f"{len(found.names)} coordinates of {model.name or 'the model'} from {len(fit.names)} segments",
        time=found.time[shown],
        time_label="time [s]",
        headline=headline(sentences, most=2),
        facts=[("Angle of segments, root mean square", f"{np.degrees(fit.rms):.1f} deg")],
        sections=tuple(sections),
        numbers=shown + 1,
        total=len(found.time),
    )


STILL = (
    "Angles count from the pose of the calibration: where the person stood otherwise than the model does by default, "
    "all frames are off by as much, which the angles of the segments do not show. Sensors on skin and segments from "
    "video move against the bones."
)


def answer(found: Poses) -> list[str]:
    """How well the markers fit and where worst; before it how many coordinates no frame determines, if any."""
    errors, free = MarkerErrors.of(found), int((~found.determined.any(axis=0)).sum())
    said = [f"{free} of {len(found.names)} coordinates are not determined."] if free else []
    fit = "are off by" if contradicted() else "fit within"
    said.append(
        f"Markers {fit} {1e3 * errors.rms:.1f} mm RMS; worst {errors.marker}, {1e3 * errors.largest:.1f} mm at "
        f"{errors.time:.3g} s."
    )
    return said


def kinematics_curves(model: Multibody, found: Poses, fit: SegmentFit | None = None) -> CurveSheet:
    """Angles and shifts of joints, and how far each marker or segment is from the model, over time."""
    angular = np.array([c.kind == "rotational" for c in model.coordinates])
    values, off = np.asarray(found.values), 1e3 * found.distances
    markers = [Curve(n, d) for n, d in zip(found.markers, off.T, strict=True)]
    panels = [
        *panels_of(model, "deg", np.degrees(values), angular),
        *panels_of(model, "m", values, ~angular),
        *([Curves("Distance of markers", "mm", markers)] if fit is None else fit.curves()),
    ]
    return CurveSheet(panels, Course("time", "s", found.time))


def _picture(model: Multibody, found: Poses, seen: MarkerTrajectories, shown: Int[np.ndarray, " k"]) -> Scene:
    """The skeleton, and the markers that count: as they were seen, and as the model has them."""
    values = np.asarray(found.values)[shown]
    whole = np.isfinite(values).all(axis=1)
    own = [m.name for m in model.markers]
    which = [own.index(name) for name in found.markers]
    modelled = np.full((len(shown), len(which), 3), np.nan)
    modelled[whole] = model.marker_places(values[whole])[:, which]
    bones = [skeleton(model, values)] if whole.any() else []
    return scene_of(model, [*bones, *markers_beside(seen.of(found.markers)[shown], modelled)])


def _markers(found: Poses) -> Table:
    rows = [
        (name, _size(d), f"{np.nanmax(d, initial=0.0):.1f}", f"{np.isnan(d).sum()}")
        for name, d in zip(found.markers, 1e3 * found.distances.T, strict=True)
    ]
    return Table("Markers", ("marker", "rms [mm]", "largest [mm]", "frames not seen"), rows)


def _size(distances: Float[np.ndarray, " k"]) -> str:
    """Root mean square of those that are known, as text."""
    known = distances[np.isfinite(distances)]
    return f"{np.sqrt(np.mean(known**2)):.1f}" if len(known) else "-"
