"""Factors by which a model's segments are scaled: what is read of model and static trial, and the factors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.motion.checked_trial import check_trial, standing_on
from geocontact.analyses.motion.marker_tasks import marker_tasks, names_told, renamed
from geocontact.analyses.motion.markers import markers_given, turn_of, with_marker_set
from geocontact.analyses.motion.model_setup import KnownSetup, known_setup, setup_measures, setup_tasks
from geocontact.analyses.motion.naming import AUTO, Naming, named_markers
from geocontact.analyses.motion.scale.measured_lengths import doubt_lengths
from geocontact.analyses.motion.scale.options import ScaleOptions
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTasks, MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.scaling import Factors, measured_factor
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.text.tables import listed
from geocontact.trial_checks.recorded import TrialInputs

MOVED = 0.02
"""m that a marker may move in a static trial without a word."""


@dataclass(frozen=True)
class Standing:
    """A model, a static trial and its mean as one frame, factors by body, and what each marker counts.

    `naming` is the marker set that is known by name, `known` the set-up of the model; `measured` are the pairs of
    markers that gave the factors, as `scale` takes them.
    """

    model: Multibody
    recorded: MarkerTrajectories
    markers: MarkerTrajectories
    factors: Factors
    tasks: MarkerTasks
    naming: Naming | None = None
    known: KnownSetup | None = None
    measured: tuple[str, ...] = ()


def read(o: ScaleOptions) -> Standing:
    """Everything the options name."""
    model = read_multibody(o.model)
    add_input("`model`", o.model, bodies=len(model.bodies), markers=len(model.markers))
    model = with_marker_set(model, o.model, o.marker_set)
    whole = renamed(markers_given(o.static, o.axes, o.time, o.c3d_unit), model, o.markers_map)
    known = None if o.model_setup is None else known_setup(model, o.model_setup)
    asked = AUTO if known is not None and o.naming is None else o.naming
    naming = None if asked is None else named_markers(model, whole, asked)
    model = model if naming is None else naming.model
    on = standing_on(whole, o.static, turn_of(o.axes), o.c3d_unit)
    check_trial(
        TrialInputs(None, whole, on.plates, o.mass, stands_at=on.stands_at, surely=on.surely, turn=turn_of(o.axes))
    )
    seen = _standing(whole)
    add_input("static", o.static, frames=len(whole), markers=len(seen.names))
    texts = o.scale if o.scale or naming is None else _known_pairs(naming, known)
    measured = _measured(o, model, whole, texts)
    factors = factors_told(model, measured, texts)
    doubt_lengths(model, measured, texts, named=naming is not None and not o.scale)
    tasks = marker_tasks(model, seen, o.tasks, known=_known_tasks(naming, known))
    return Standing(model, whole, seen, factors, tasks, naming, known, texts)


def _known_pairs(naming: Naming, known: KnownSetup | None) -> tuple[str, ...]:
    return naming.measures if known is None else setup_measures(known, naming)


def _known_tasks(naming: Naming | None, known: KnownSetup | None) -> MarkerTasks | None:
    if naming is None:
        return None
    return MarkerTasks(naming.weights) if known is None else setup_tasks(known, naming, standing=True)


def _measured(
    o: ScaleOptions, model: Multibody, standing: MarkerTrajectories, texts: tuple[str, ...]
) -> MarkerTrajectories:
    """Trial and times of the distances of markers."""
    if o.sizes is None and o.sizes_time is None:
        return standing
    if not any("/" in text for text in texts):
        named = "`sizes`" if o.sizes is not None else "`sizes_time`"
        raise InputError("", named, "has no effect: no body is measured", "name pairs of markers with `scale`")
    file, time = o.sizes or o.static, o.sizes_time if o.sizes_time is not None or o.sizes is not None else o.time
    seen = renamed(markers_given(file, o.axes, time, o.c3d_unit), model, o.markers_map)
    if o.sizes is not None:
        add_input("`sizes`", o.sizes, frames=len(seen), markers=len(seen.names))
        check_trial(TrialInputs(markers=seen, turn=turn_of(o.axes)))
    return seen


def _standing(seen: MarkerTrajectories) -> MarkerTrajectories:
    """One frame: the mean over the trial of each marker where it was seen."""
    there = np.isfinite(seen.positions).all(axis=2).any(axis=0)
    positions: Float[np.ndarray, "m 3"] = np.full(seen.positions.shape[1:], np.nan)
    positions[there] = np.nanmean(seen.positions[:, there], axis=0)
    off = np.linalg.norm(seen.positions - positions, axis=2)
    moved = [(float(np.nanmax(off[:, k])), seen.names[k]) for k in np.flatnonzero(there)]
    far, name = max(moved)
    if far > MOVED:
        reserve(f"{seen.source}: {name} moves {1e3 * far:.0f} mm away from its mean: is this standing still?")
    return MarkerTrajectories(seen.time[:1], positions[None], seen.names, seen.source)


AXES = "xyz"
ABSURD = 0.5, 2.0
"""A factor beyond these is a mistake: markers exchanged, or another unit."""


def factors_told(model: Multibody, seen: MarkerTrajectories, texts: tuple[str, ...]) -> Factors:
    """Factors of bodies along their axes, as the option `scale` takes them.

    femur_r,femur_l=R.Hip/R.Knee,L.Hip/L.Knee is the mean over the pairs, pelvis=1.05 a number; femur_r:xz=... is
    along these axes only. An axis of which nothing is said keeps its length.
    """
    rest = np.array([c.default for c in model.coordinates])
    names = tuple(body.name for body in model.bodies)
    found: dict[str, Float[np.ndarray, " 3"]] = {}
    for text in texts:
        bodies, equals, size = text.partition("=")
        factor = _factor(model, rest, seen, text, size) if equals else None
        if factor is None:
            example = "write femur_r=R.Hip/R.Knee, femur_r:y=R.Hip/R.Knee, or femur_r=1.05"
            raise InputError("", "`scale`", f"'{text}' is not bodies and pairs of markers", example)
        if not ABSURD[0] <= factor <= ABSURD[1]:
            what = f"'{text}' makes {bodies} {factor:.3g} times as large"
            raise InputError(seen.source, "`scale`", what, "are markers exchanged, or is the unit another?")
        for name, axes in _named(bodies):
            if name not in names:
                raise InputError("", "`scale`", f"no body '{name}'", f"bodies are: {listed(names)}")
            along = found.setdefault(name, np.full(3, np.nan))
            if np.isfinite(along[axes]).any():
                raise InputError("", "`scale`", f"body '{name}' is named twice", "name each axis of a body once")
            along[axes] = factor
    return {name: np.where(np.isfinite(along), along, 1.0) for name, along in found.items()}


def labelled(factors: Mapping[str, Float[np.ndarray, " 3"]]) -> dict[str, float]:
    """One number for a body that grows alike along all axes, else one for each axis: `femur_r y`."""
    found = {}
    for name, along in factors.items():
        if np.ptp(along) == 0.0:
            found[name] = float(along[0])
        else:
            found.update({f"{name} {axis}": float(by) for axis, by in zip(AXES, along, strict=True)})
    return found


def _named(bodies: str) -> list[tuple[str, list[int]]]:
    """Bodies and which of their axes."""
    found = []
    for each in bodies.split(","):
        name, colon, axes = each.strip().rpartition(":")
        if not colon:
            name, axes = axes, AXES
        if not axes or set(axes) - set(AXES) or len(set(axes)) < len(axes):
            raise InputError(
                "", "`scale`", f"'{axes}' is not one or more of the axes x, y and z", "write femur_r:xz=1.05"
            )
        found.append((name, [AXES.index(axis) for axis in axes]))
    return found


def _factor(
    model: Multibody, rest: Float[np.ndarray, " n"], seen: MarkerTrajectories, text: str, size: str
) -> float | None:
    """The number typed, or the one that pairs of markers measure; None for a text that is neither."""
    ends = [pair.partition("/") for pair in size.split(",")]
    if not all(slash for _, slash, _ in ends):
        return _number(size)
    try:
        return measured_factor(model, rest, seen, [(a.strip(), b.strip()) for a, _, b in ends])
    except ValueError as error:
        raise InputError(seen.source, "`scale`", str(error), names_told(seen, model)) from error


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if isfinite(value) else None
