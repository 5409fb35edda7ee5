"""A model made to measure: reads, computes, writes, says what it found."""

from __future__ import annotations

from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.json_file import plain, write_json
from geocontact.analyses.motion.inverse_kinematics.write import printed
from geocontact.analyses.motion.marker_tasks import marker_tasks
from geocontact.analyses.motion.markers import markers_given, with_marker_set
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.cli.scale import ScaleOptions
from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_kinematics import Poses, inverse_kinematics
from geocontact.dynamics.scaling import measured_factor, scaled
from geocontact.dynamics.tree import tree_of
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.opensim.osim_scaler import write_scaled_model
from geocontact.io.text.tables import listed

ABSURD = 0.5, 2.0
"""A factor beyond these is a mistake: markers exchanged, or another unit."""
MOVED = 0.02
"""m that a marker may move in a static trial without a word."""


def analyse(static: Path, o: ScaleOptions) -> int:
    """Run the whole analysis."""
    record = Record("scale", {"static": static, **asdict(o)})
    with record.catching_warnings(), written_whole(o.out) as draft:
        model = read_multibody(o.model)
        record.add_input("--model", o.model, bodies=len(model.bodies), markers=len(model.markers))
        model = with_marker_set(record, model, o.model, o.marker_set)
        whole = markers_given(static, o.axes, o.time)
        seen = _standing(record, whole)
        record.add_input("static", static, frames=len(whole), markers=len(seen.names))
        if o.mass is not None and not (np.isfinite(o.mass) and o.mass > 0.0):
            raise InputError("", "--mass", f"{o.mass:g} kg is not a mass", "write for example 72.6")
        factors = _factors(model, whole, o.scale)
        tasks = marker_tasks(record, model, seen, o.tasks)
        try:
            made = scaled(model, {name: by * np.ones(3) for name, by in factors.items()}, o.mass)
        except ValueError as error:
            raise InputError(o.model, "", str(error), "correct the model") from error
        try:
            pose = inverse_kinematics(tree_of(made), seen, tasks)
        except ValueError as error:
            raise InputError(static, "", str(error), "compare the names in the file with the model's") from error
        if not pose.settled.all():
            record.warn("the static pose did not settle: markers and model may not belong together")
        moved = made if o.keep_markers else _placed(made, seen, pose)
        by = {name: factor * np.ones(3) for name, factor in factors.items()}
        standing = {n: float(v) for n, v in zip(pose.names, pose.values[0], strict=True) if np.isfinite(v)}
        write_scaled_model(o.model, draft / "scaled.osim", moved, by, standing)
        _tell(record, factors, pose, moved, draft)
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def _standing(record: Record, seen: MarkerTrajectories) -> MarkerTrajectories:
    """One frame: the mean over the trial of each marker where it was seen."""
    there = np.isfinite(seen.positions).all(axis=2).any(axis=0)
    positions: Float[np.ndarray, "m 3"] = np.full(seen.positions.shape[1:], np.nan)
    positions[there] = np.nanmean(seen.positions[:, there], axis=0)
    off = np.linalg.norm(seen.positions - positions, axis=2)
    moved = [(float(np.nanmax(off[:, k])), seen.names[k]) for k in np.flatnonzero(there)]
    far, name = max(moved)
    if far > MOVED:
        record.warn(f"{seen.source}: {name} moves {1e3 * far:.0f} mm away from its mean: is this standing still?")
    return MarkerTrajectories(seen.time[:1], positions[None], seen.names, seen.source)


def _factors(model: Multibody, seen: MarkerTrajectories, texts: tuple[str, ...]) -> dict[str, float]:
    rest = np.array([c.default for c in model.coordinates])
    names = tuple(body.name for body in model.bodies)
    found: dict[str, float] = {}
    for text in texts:
        bodies, equals, pairs = text.partition("=")
        ends = [pair.partition("/") for pair in pairs.split(",")]
        if not equals or not all(slash for _, slash, _ in ends):
            example = "write femur_r=R.Hip/R.Knee"
            raise InputError("", "--scale", f"'{text}' is not bodies and pairs of markers", example)
        try:
            factor = measured_factor(model, rest, seen, [(a.strip(), b.strip()) for a, _, b in ends])
        except ValueError as error:
            raise InputError(seen.source, "--scale", str(error), "compare the names") from error
        if not ABSURD[0] <= factor <= ABSURD[1]:
            what = f"'{text}' makes {bodies} {factor:.3g} times as large"
            raise InputError(seen.source, "--scale", what, "are markers exchanged, or is the unit another?")
        for name in (each.strip() for each in bodies.split(",")):
            if name not in names or name in found:
                what = f"body '{name}' is named twice" if name in found else f"no body '{name}'"
                raise InputError("", "--scale", what, f"bodies are: {listed(names)}")
            found[name] = factor
    return found


def _placed(model: Multibody, seen: MarkerTrajectories, pose: Poses) -> Multibody:
    """Markers that were seen where they were, in the static pose; others, and fixed ones, where scaling put them."""
    poses = model.poses(pose.values)
    places = seen.of(tuple(m.name for m in model.markers))[0]
    markers = tuple(
        m if m.fixed or not np.isfinite(place).all() else replace(m, location=poses[m.body][0].inv().apply(place))
        for m, place in zip(model.markers, places, strict=True)
    )
    return replace(model, markers=markers)


def _tell(record: Record, factors: dict[str, float], pose: Poses, made: Multibody, draft: Path) -> None:
    off = 1e3 * pose.distances[0]
    told = {
        "factors": factors,
        "mass_kg": sum(body.mass for body in made.bodies),
        "static_rms_mm": float(np.sqrt(np.nanmean(off**2))),
        "markers_mm": dict(zip(pose.markers, off.tolist(), strict=True)),
        "static_pose": {
            f"{c.name} [{'deg' if c.kind == 'rotational' else 'm' if c.kind == 'translational' else 'rad or m'}]": value
            for c, value in zip(made.coordinates, printed(made.coordinates, pose.values)[0].tolist(), strict=True)
        },
    }
    record.results.update(plain(told))
    write_json(draft / "scale.json", told)
    sizes = ", ".join(f"{name} {by:.3f}" for name, by in factors.items()) or "no body"
    worst = pose.markers[int(np.nanargmax(off))]
    rms = float(np.sqrt(np.nanmean(off**2)))
    record.say(f"scaled: {sizes}; markers {rms:.1f} mm from the scaled model, root mean square, most at {worst}")
