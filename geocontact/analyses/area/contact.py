"""Contact over one motion: what is found of it and doubted, and its tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Bool

from geocontact.analyses.area.bodies import Bodies
from geocontact.analyses.area.options import FLAT, AreaOptions
from geocontact.analyses.area.wear import wear_table, worn_over
from geocontact.analyses.frame.collector import listener, note, reserve, say
from geocontact.analyses.frame.layers import confined_modulus, measured_thickness
from geocontact.data.errors import InputError
from geocontact.data.evolution import AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.congruence import (
    EDGES,
    PER_MM,
    CongruenceEvolution,
    congruence_evolution,
    longer_radius,
    median_edges,
)
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.geometry.contact_area.pose_error import AreaUncertainty
from geocontact.geometry.curvature import corner_normals
from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import surface_quadrature
from geocontact.loads.foundation import Layer, Pressed, Skin, layer_on
from geocontact.loads.pressure_evolution import PressureEvolution, pressure_evolution
from geocontact.loads.pressure_pose_error import PressureUncertainty, pressure_uncertainty
from geocontact.loads.wear import LayerWear, Wearing

FEW = 0.9
"""Share of the contact area that has both curvatures, below which a warning says so."""
LEAST = 0.2
"""Share below which there is no index: it would be that of a few places."""


def congruence_of(bodies: Bodies, radius: float, name: str, motion: Motion) -> CongruenceEvolution:
    """Congruence of all frames, curvatures fitted within `radius` [m]; none over less than `LEAST` of the area."""
    with listener().progress(f"{name or 'frames'}, congruence", len(motion)) as step:
        every = congruence_evolution(bodies.moving, bodies.fixed, motion, bodies.settings, radius, step)
    label = f"{name}: " if name else ""
    found = _over_enough(bodies, radius, label, motion, every)
    _say_congruence(bodies, radius, name, found)
    return found


def _over_enough(
    bodies: Bodies, radius: float, label: str, motion: Motion, found: CongruenceEvolution
) -> CongruenceEvolution:
    """The same without what is over too little of the area: a reservation, or a refusal where there is nothing else."""
    few = found.share < LEAST
    if not few.any():
        return found
    remedy = _remedy(bodies, radius, motion, found)
    if not np.isfinite(found.index).any():
        what = (
            f"{label}no congruence of {bodies.moving.name} and {bodies.fixed.name} in any frame, although they are near"
        )
        raise InputError("", "`congruence`", what, remedy)
    for k, threshold in enumerate(bodies.settings.thresholds):
        if few[:, k].any():
            low, high = found.share[few[:, k], k].min(), found.share[few[:, k], k].max()
            reserve(
                f"{label}no index of congruence within {threshold * 1e3:g} mm in {few[:, k].sum()} of {len(few)} "
                f"frames: both curvatures are known over {low:.0%} to {high:.0%} of the area, and {LEAST:.0%} are "
                f"needed; {remedy}"
            )
    return found.above(LEAST)


def _remedy(bodies: Bodies, radius: float, motion: Motion, found: CongruenceEvolution) -> str:
    """A longer radius that works for the meshes; else what is the matter."""
    longer = longer_radius(bodies.moving, bodies.fixed, motion, bodies.settings, radius, found)
    edges = median_edges(bodies.moving, bodies.fixed)
    if longer is not None:
        return (
            f"too few vertices lie within {radius * 1e3:g} mm: edges of the meshes are {edges[0] * 1e3:.2g} and "
            f"{edges[1] * 1e3:.2g} mm at the median, give `congruence` {longer * 1e3:.3g}mm"
        )
    return (
        f"no radius to {EDGES[-1] * max(edges) * 1e3:.3g} mm does better, so the surfaces do not face each other there "
        "(turn over an open patch whose faces are wound inwards; look at the pose: where they overlap deeply their "
        "normals are not opposite)"
    )


def _say_congruence(bodies: Bodies, radius: float, name: str, found: CongruenceEvolution) -> None:
    """Range of the index, and what it is not over."""
    summary: dict[str, object] = {"radius_mm": radius * 1e3}
    note(f"{name} congruence".lstrip(), summary)
    label = f"{name}: " if name else ""
    for k, threshold in enumerate(bodies.settings.thresholds):
        index, share = found.index[:, k], found.share[:, k]
        there = np.isfinite(index)
        if not there.any():
            continue
        low, high = (float(end) * PER_MM for end in (index[there].min(), index[there].max()))
        summary[f"index_per_mm_at_{threshold * 1e3:g}_mm"] = [round(low, 6), round(high, 6)]
        say(
            f"{label}index of congruence within {threshold * 1e3:g} mm: {low:.4f} … {high:.4f} 1/mm "
            f"(0 fits exactly), curvatures fitted within {radius * 1e3:g} mm"
        )
        worst = float(share[there].min())
        if worst < FEW:
            reserve(
                f"{label}the index of congruence is over {worst:.0%} of the area within {threshold * 1e3:g} mm in the "
                "worst frame: elsewhere the surfaces do not face each other, or too few vertices lie within "
                f"`congruence` {radius * 1e3:g} mm"
            )


PIECE = 0.5e-3  # m; longest edge of a piece by default
AGREED = 0.01  # of the force; pieces of half the size may change it by no more without a word
STRAINED = 0.2  # largest strain that the linear law is trusted to


def pressures_of(
    bodies: Bodies, o: AreaOptions, name: str, motion: Motion, kept: Sequence[int]
) -> tuple[PressureEvolution, LayerWear | None]:
    """Loads of all frames; pressures of the frames in `kept` and of the one with the largest force; wear by these."""
    moving, counted = bodies.moving, bodies.settings.fixed_faces
    if not moving.closed:
        what = f"{moving.name} is open ({moving.topology.why_open}): it has no inside, so there is no depth"
        raise InputError("", "`pressure`", what, "close it, or see `assume_closed` moving")
    edge = PIECE if o.piece is None else o.piece

    def finer(faces: Bool[np.ndarray, " f"]) -> Layer:
        return elastic_layer(bodies, faces if counted is None else faces & counted, o, 0.5 * edge)

    layer, skin = elastic_layer(bodies, counted, o, edge), _skin(moving, o)
    wearing = None if bodies.wear is None else Wearing(layer.pieces, motion.poses)

    def each(one: Pressed) -> None:
        if wearing is not None:
            wearing.add(one.pressure)

    with listener().progress(f"pressure {name}".strip(), len(motion)) as step:
        found = pressure_evolution(layer, bodies.fixed, moving, motion, skin, kept, finer, o.workers, step, each)
    _say_pressures(found, name)
    if wearing is None or bodies.wear is None:
        return found, None
    return found, worn_over(o, bodies.wear, wearing, name, found)


PRESSED = 100
"""Draws of the pose whose pressures are computed by default."""


def pressure_error_of(
    bodies: Bodies, o: AreaOptions, name: str, motion: Motion, e: PressureEvolution | None
) -> PressureUncertainty | None:
    """Loads of drawn poses, and what is to be said of them; None without pressures or an error of the pose."""
    if bodies.error is None or e is None:
        return None
    count = min(o.draws or PRESSED, len(bodies.error.draws))
    with listener().progress(f"{name or 'frames'}, pressures with the error of the pose", len(motion)) as step:
        found = pressure_uncertainty(e.layer, bodies.moving, motion, e.skin, bodies.error, count, o.workers, step)
    low, high = found.largest_force
    share = found.share_where(e.heaviest)
    summary: dict[str, object] = {"draws": count, "largest_force_ci95_N": [low, high]}
    medial = ""
    if share is not None:
        summary["medial_share_at_largest_force_ci95"] = list(share)
        medial = f", {100.0 * share[0]:.0f} … {100.0 * share[1]:.0f} % of it medial where the force is largest"
    note(f"{name} pressure_error".lstrip(), summary)
    say(f"error of the pose: largest force {low:.4g} … {high:.4g} N (95 % of {count} draws){medial}")
    return found


def elastic_layer(bodies: Bodies, faces: Bool[np.ndarray, " f"] | None, o: AreaOptions, edge: float) -> Layer:
    """FIXED's layer in pieces of at most `edge` [m]."""
    fixed, split = bodies.fixed, bodies.settings.split
    try:
        pieces = surface_quadrature(fixed, edge, faces)
    except ValueError as error:
        raise InputError("", "`piece`", str(error), "give a longer edge") from error
    thickness = measured_thickness(fixed, pieces.point, pieces.normal, o.thickness, "`thickness`")
    sides = None if split is None else (split, bodies.settings.medial_side)
    modulus = confined_modulus(o.modulus, o.poisson)
    return layer_on(fixed, pieces, thickness, modulus, o.foundation or "linear", sides, o.facets != FLAT)


def _skin(moving: Surface, o: AreaOptions) -> Skin:
    """What MOVING brings: smooth facets unless flat, and a layer where its modulus is given."""
    normals = None if o.facets == FLAT else corner_normals(moving)
    if o.modulus_moving is None:
        return Skin(normals)
    centres = moving.vertices[moving.faces].mean(axis=1)
    thickness = measured_thickness(moving, centres, moving.face_normal, o.thickness_moving, "`thickness_moving`")
    return Skin(normals, thickness, confined_modulus(o.modulus_moving, o.poisson_moving))


def _say_pressures(e: PressureEvolution, name: str) -> None:
    force, again, layer, strain = e.loads[e.heaviest].pressing, e.finer, e.layer, e.strain
    off = abs(force - again) / again if again > 0.0 else 0.0
    if off > AGREED:
        reserve(f"pieces of half the size change the largest force by {off:.1%}; give a smaller `piece`")
    if not force > 0.0:
        reserve("the bodies never overlap: the elastic layer is not compressed, and all forces are 0")
    if layer.law == "linear" and strain > STRAINED:
        reserve(f"the strain of the layer is up to {strain:.0%}: use `foundation` logarithmic")
    note(
        f"pressure {name}".strip(),
        {
            "law": layer.law,
            "layer_modulus_Pa": layer.modulus,
            "pieces": len(layer.pieces.area),
            "largest_force_N": round(force, 6),
            "with_pieces_of_half_the_size_N": round(again, 6),
            "largest_pressure_Pa": max(load.peak for load in e.loads),
            "largest_strain": round(strain, 6),
            "thickness_mm": [round(float(v) * 1e3, 4) for v in (layer.thickness.min(), layer.thickness.max())],
            "facets": "flat" if e.skin.normals is None else "smooth",
            "layer_modulus_moving_Pa": None if e.skin.thickness is None else e.skin.modulus,
        },
    )
    label = f"{name}: " if name else ""
    peak = max(load.peak for load in e.loads)
    say(f"{label}{layer.law} foundation: force up to {force:.1f} N, pressure up to {peak * 1e-6:.2f} MPa")


@dataclass(frozen=True, eq=False)
class MotionResult:
    """Contact of two bodies over one motion.

    Parameters
    ----------
    name
        Of its sub-folder; empty when there is one motion.
    motion
        Poses of MOVING in FIXED.
    evolution
        Areas, bounds and separation of every frame.
    maps
        Distances of the vertices in some frames; in all of them with `save_map`.
    pressure
        Loads of every frame; None unless `pressure` was asked for.
    comparison
        Differences to measured areas; None unless `compare` names some.
    uncertainty
        Error of the poses carried into FIXED's area; None unless one was given.
    congruence
        How alike the surfaces are curved in contact; None unless asked for.
    reservations
        What is to be doubted about this motion, each one line.
    published
        Published areas beside these; None unless asked for.
    pressure_error
        Error of the poses carried into the loads; None unless both were asked for.
    wear
        Wear of FIXED's layer; None unless asked for.
    """

    name: str
    motion: Motion
    evolution: AreaEvolution
    maps: DistanceMaps
    pressure: PressureEvolution | None
    comparison: pd.DataFrame | None
    uncertainty: AreaUncertainty | None
    congruence: CongruenceEvolution | None
    reservations: tuple[str, ...]
    published: pd.DataFrame | None = None
    pressure_error: PressureUncertainty | None = None
    wear: LayerWear | None = None


def tables_of(bodies: Bodies, one: MotionResult, o: AreaOptions) -> dict[str, pd.DataFrame]:
    """`area`, and `pressure`, `wear`, `comparison`, `literature` and `pose_error` where they were asked for."""
    found = {"area": area_table(one, o)}
    if one.pressure is not None:
        found["pressure"] = one.pressure.table(one.motion.time)
    if one.wear is not None:
        found["wear"] = wear_table(one.wear, bodies.fixed)
    if one.pressure_error is not None:
        found["pressure_error"] = one.pressure_error.table(one.motion.time)
    if one.comparison is not None:
        found["comparison"] = one.comparison
    if one.published is not None:
        found["literature"] = one.published
    if one.uncertainty is not None:
        found["pose_error"] = one.uncertainty.table(one.motion.time, one.evolution.thresholds)
    return found


def area_table(one: MotionResult, o: AreaOptions) -> pd.DataFrame:
    """A row per frame and threshold, with congruence, the angle that a sweep prescribes and the offset of adduction."""
    table = one.evolution.table()
    if one.congruence is not None:
        table = table.assign(**one.congruence.columns())
    if one.motion.coordinate is not None:
        name, angle = one.motion.coordinate
        table[f"{name} [deg]"] = np.repeat(np.degrees(angle), len(one.evolution.thresholds))
    if o.adduction is not None:
        table["adduction offset [deg]"] = np.round(np.degrees(o.adduction[1]), 9)
    return table
