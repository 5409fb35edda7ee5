"""A model made to measure."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.analyses.json_file import plain
from geocontact.analyses.motion.marker_errors import STANDING, MarkerErrors
from geocontact.analyses.motion.printed import printed
from geocontact.analyses.motion.scale.factors import labelled
from geocontact.analyses.motion.scale.options import ScaleOptions
from geocontact.analyses.motion.scale.read import Standing
from geocontact.analyses.motion.scale.result import ScaleResult
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_kinematics import Poses, inverse_kinematics
from geocontact.dynamics.scaling import scaled
from geocontact.dynamics.tree import tree_of


def run(given: Standing, o: ScaleOptions, record: Record) -> ScaleResult:
    """Sizes and mass, the static pose, and markers where they were seen in it."""
    try:
        made = scaled(given.model, given.factors, o.mass, by_volume=o.mass_by_volume)
    except ValueError as error:
        raise InputError(o.model, "", str(error), "correct the model") from error
    try:
        pose = inverse_kinematics(tree_of(made), given.markers, given.tasks)
    except ValueError as error:
        raise InputError(o.static, "", str(error), "is it the right file?") from error
    if not pose.settled.all():
        record.warn("the static pose did not settle: markers and model may not belong together")
    moved = made if o.keep_markers else _placed(made, given.markers, pose)
    summary = _summary(given, pose, moved)
    record.results.update(plain(summary))
    _tell(record, given, pose)
    which = [[m.name for m in made.markers].index(name) for name in pose.markers]
    return ScaleResult(
        record=record,
        options=o,
        standing=given,
        factors=given.factors,
        model=moved,
        pose=pose,
        seen=given.markers.of(pose.markers)[0],
        modelled=made.marker_places(pose.values)[0, which],
        summary=summary,
    )


def _placed(model: Multibody, seen: MarkerTrajectories, pose: Poses) -> Multibody:
    """Markers that were seen where they were, in the static pose; others, and fixed ones, where scaling put them."""
    poses = model.poses(pose.values)
    places = seen.of(tuple(m.name for m in model.markers))[0]
    markers = tuple(
        m if m.fixed or not np.isfinite(place).all() else replace(m, location=poses[m.body][0].inv().apply(place))
        for m, place in zip(model.markers, places, strict=True)
    )
    return replace(model, markers=markers)


def _summary(given: Standing, pose: Poses, made: Multibody) -> dict[str, object]:
    """Numbers of the scaling, as `scale.json` holds them."""
    off = 1e3 * pose.distances[0]
    units = {"rotational": "deg", "translational": "m"}
    values = printed(made.coordinates, pose.values)[0].tolist()
    return {
        "factors": labelled(given.factors),
        "mass_kg": sum(body.mass for body in made.bodies),
        "static_rms_mm": float(np.sqrt(np.nanmean(off**2))),
        "markers_mm": dict(zip(pose.markers, off.tolist(), strict=True)),
        "static_pose": {
            f"{c.name} [{units.get(c.kind, 'rad or m')}]": v for c, v in zip(made.coordinates, values, strict=True)
        },
    }


def _tell(record: Record, given: Standing, pose: Poses) -> None:
    errors = MarkerErrors.of(pose)
    errors.warn(record, STANDING)
    sizes = ", ".join(f"{name} {by:.3f}" for name, by in labelled(given.factors).items()) or "no body"
    record.say(f"scaled: {sizes}; markers {errors.words(STANDING)}")
