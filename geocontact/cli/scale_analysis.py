"""A model made to measure: reads, computes, writes, says what it found."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.cli.marker_input import markers_given
from geocontact.cli.output import written_whole
from geocontact.cli.record import Record
from geocontact.cli.scale import ScaleOptions
from geocontact.data.errors import InputError
from geocontact.data.marker_tasks import MarkerTasks
from geocontact.data.marker_trajectories import MarkerTrajectories
from geocontact.data.multibody import Multibody
from geocontact.dynamics.inverse_kinematics import Poses, inverse_kinematics
from geocontact.dynamics.scaling import measured_factor, scaled
from geocontact.dynamics.tree import tree_of
from geocontact.io.marker_weights import read_marker_weights
from geocontact.io.osim_multibody import read_multibody
from geocontact.io.osim_scaler import write_scaled_model
from geocontact.io.tables import listed

ABSURD = 0.5, 2.0
"""A factor beyond these is a mistake: markers exchanged, or another unit."""


def analyse(static: Path, o: ScaleOptions) -> int:
    """Run the whole analysis."""
    record = Record("scale", {"static": static, **asdict(o)})
    with record.catching_warnings(), written_whole(o.out) as draft:
        model = read_multibody(o.model)
        record.add_input("--model", o.model, bodies=len(model.bodies), markers=len(model.markers))
        seen = _standing(markers_given(static, o.axes, o.time))
        record.add_input("static", static, markers=len(seen.names))
        if o.mass is not None and not (np.isfinite(o.mass) and o.mass > 0.0):
            raise InputError("", "--mass", f"{o.mass:g} kg is not a mass", "write for example 72.6")
        factors = _factors(model, seen, o.scale)
        made = scaled(model, {name: by * np.ones(3) for name, by in factors.items()}, o.mass)
        tasks = MarkerTasks({m.name: 1.0 for m in model.markers}) if o.tasks is None else read_marker_weights(o.tasks)
        if o.tasks is not None:
            record.add_input("--tasks", o.tasks)
        try:
            pose = inverse_kinematics(tree_of(made), seen, tasks)
        except ValueError as error:
            raise InputError(static, "", str(error), "compare the names in the file with the model's") from error
        moved = made if o.keep_markers else _placed(made, seen, pose)
        write_scaled_model(o.model, draft / "scaled.osim", moved, {k: v * np.ones(3) for k, v in factors.items()})
        _tell(record, factors, pose, moved, draft)
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def _standing(seen: MarkerTrajectories) -> MarkerTrajectories:
    """One frame: the mean over the trial of each marker where it was seen."""
    there = np.isfinite(seen.positions).all(axis=2).any(axis=0)
    positions: Float[np.ndarray, "m 3"] = np.full(seen.positions.shape[1:], np.nan)
    positions[there] = np.nanmean(seen.positions[:, there], axis=0)
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
    """Markers that were seen where they were, in the static pose; others where scaling put them."""
    poses = model.poses(pose.values)
    places = seen.of(tuple(m.name for m in model.markers))[0]
    markers = tuple(
        replace(m, location=poses[m.body][0].inv().apply(place)) if np.isfinite(place).all() else m
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
        "static_pose": dict(zip(pose.names, pose.values[0].tolist(), strict=True)),
    }
    record.results.update(told)
    (draft / "scale.json").write_text(json.dumps(told, indent=2) + "\n", encoding="utf-8")
    sizes = ", ".join(f"{name} {by:.3f}" for name, by in factors.items()) or "no body"
    worst = pose.markers[int(np.nanargmax(off))]
    record.say(
        f"scaled: {sizes}; markers of the scaled model {told['static_rms_mm']:.1f} mm from the static trial, root mean "
        f"square, most at {worst}"
    )
