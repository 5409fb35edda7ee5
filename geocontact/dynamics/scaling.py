"""A generic model made to measure: factors from distances of markers in a static trial, and the scaled model."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.data.multibody.joint import Affine, JointModel, TransformAxis
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import GROUND, Body, Multibody, coupler_stretch

Factors = Mapping[str, Float[np.ndarray, " 3"]]
"""Factors of bodies by name, along the axes of the body's frame; a body without any keeps its size."""


def measured_factor(
    model: Multibody,
    values: Float[np.ndarray, " n"],
    static: MarkerTrajectories,
    pairs: Sequence[tuple[str, str]],
) -> float:
    """Mean over pairs of markers of their distance in the trial over that in the model.

    Parameters
    ----------
    values
        Coordinates of the model in which the distances are taken [rad, m]; they matter for pairs on two bodies.
    static
        A trial in which the subject stands still; distances are means over its frames.

    ValueError for a marker that the model or the trial lacks, and for two that lie on each other.
    """
    places = model.marker_places(values[None])[0]
    names = [m.name for m in model.markers]
    ratios = []
    for pair in pairs:
        for name in pair:
            if name not in names or name not in static.names:
                where = "model" if name not in names else "static trial"
                raise ValueError(f"the {where} has no marker {name}")
        own = float(np.linalg.norm(np.subtract(*(places[names.index(name)] for name in pair))))
        seen = static.of(pair)
        distance = float(np.nanmean(np.linalg.norm(seen[:, 0] - seen[:, 1], axis=1)))
        if not (own > 0.0 and np.isfinite(distance)):
            raise ValueError(f"the distance of {pair[0]} and {pair[1]} cannot be measured")
        ratios.append(distance / own)
    return float(np.mean(ratios))


def scaled(model: Multibody, factors: Factors, mass: float | None = None, *, by_volume: bool = False) -> Multibody:
    """The model with its bodies scaled: joints, markers and mass centres move with them.

    Shifts along the axes of a joint that are no coordinate by themselves scale with the body that they are expressed in
    (the parent, but of a reversed joint), as in OpenSim, and so do coordinates that depend on others and are shifts.
    Moments of inertia are those of the same mass spread over the scaled body, exact for every factor; OpenSim takes a
    cylinder where factors differ.

    Parameters
    ----------
    mass
        Of the whole [kg], shared among the bodies as before; without it masses are as they were. ValueError where the
        bodies have none.
    by_volume
        Masses grow with the product of the factors of their body, before they share `mass`: OpenSim's
        `preserve_mass_distribution` false.
    """
    ones = np.ones(3)

    def of(name: str) -> Float[np.ndarray, " 3"]:
        return ones if name == GROUND else np.asarray(factors.get(name, ones), float)

    unknown = set(factors) - {body.name for body in model.bodies}
    if unknown:
        raise ValueError(f"there is no body {min(unknown)}")
    dense = {body.name: float(np.prod(of(body.name))) if by_volume else 1.0 for body in model.bodies}
    total = sum(dense[body.name] * body.mass for body in model.bodies)
    if mass is not None and not total > 0.0:
        raise ValueError("the bodies have no mass that could be shared")
    heavier = 1.0 if mass is None else mass / total
    bodies = tuple(_body(body, of(body.name), heavier * dense[body.name]) for body in model.bodies)
    joints = tuple(_joint(joint, of) for joint in model.joints)
    markers = tuple(replace(m, location=m.location * of(m.body)) for m in model.markers)
    couplers = tuple(
        replace(c, function=c.function.scaled(coupler_stretch(model, c.dependent, factors))) for c in model.couplers
    )
    pairs = tuple(replace(p, places=p.places * np.array([of(body) for body in p.bodies])) for p in model.pairs)
    return replace(model, bodies=bodies, joints=joints, markers=markers, couplers=couplers, pairs=pairs)


def _body(body: Body, by: Float[np.ndarray, " 3"], heavier: float) -> Body:
    """Second moments ∫ x xᵀ dm scale with the coordinates, and moments of inertia follow from them."""
    moments = 0.5 * np.trace(body.inertia) * np.eye(3) - body.inertia
    grown = heavier * moments * np.outer(by, by)
    inertia = np.trace(grown) * np.eye(3) - grown
    return Body(body.name, heavier * body.mass, body.centre * by, inertia)


def _joint(joint: JointModel, of: Callable[[str], Float[np.ndarray, " 3"]]) -> JointModel:
    """`of` gives the factors of a body, ones of the ground."""
    shifts = tuple(_shift(joint.axes[slot], joint.stretch(slot, of(joint.base))) for slot in (3, 4, 5))
    return replace(
        joint,
        axes=(*joint.axes[:3], *shifts),
        parent_offset=_moved(joint.parent_offset, of(joint.parent)),
        child_offset=_moved(joint.child_offset, of(joint.child)),
    )


def _shift(axis: TransformAxis, stretch: float) -> TransformAxis:
    function = axis.function
    if isinstance(function, Affine) and np.array_equal(function.slopes, [1.0]) and function.offset == 0.0:
        return axis  # the coordinate itself: a length that is measured, not one of the body
    return replace(axis, function=function.scaled(stretch))


def _moved(offset: RigidTransform, by: Float[np.ndarray, " 3"]) -> RigidTransform:
    return RigidTransform.from_components(offset.translation * by, offset.rotation)
