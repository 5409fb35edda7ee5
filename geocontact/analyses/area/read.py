"""What an area analysis rests on: two bodies, what of them counts, motions and measured areas, as the options say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from geocontact.analyses import quantities
from geocontact.analyses.area.motions import motions_given
from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.area.pose_error.along import pose_error_of
from geocontact.analyses.area.reference_areas import Reference, read_reference
from geocontact.analyses.area.refusals import refuse_plane_beside, refuse_zero_without_inside
from geocontact.analyses.bodies import chosen_faces, read_body_and_outer, refuse_two_spaces
from geocontact.analyses.run_record import Record
from geocontact.analyses.sides import MedialSide, medial_side, refuse_other_axes
from geocontact.data.evolution import MM2
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.area import Refinement
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.contact_area.pose_error import PoseError
from geocontact.geometry.pieces.union import UnitedSurface
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface
from geocontact.view.surfaces.vtp_series import require_pyvista

BRIEF, PATIENT = 40_000, 1_000_000  # triangles divided per area, without and with bounds asked for
FEW = (
    8_000  # without, where thresholds are finer than `FINE`: all that nearly touches is doubtful, however often divided
)
FINE = 0.05e-3  # m
TOLERANCE = 0.02
SENSITIVITY = np.linspace(0.0, 1.5, 13)  # shares of the largest threshold at which the page shows the area as well
ZERO_REACH = 1e-3  # m; what these shares are of where the threshold is zero


@dataclass(frozen=True, eq=False)
class Bodies:
    """Two bodies, how their contact is counted, and how one moves in the frame of the other.

    Parameters
    ----------
    moving, fixed
        The bodies, each in its own frame [m].
    settings
        What counts as contact, and how it is counted.
    motions
        Name of the sub-folder, empty when there is one motion, and poses of MOVING in FIXED.
    reference
        Measured areas to compare with; None without.
    error
        By which poses may be off; None without.
    inner
        Outer surfaces of bodies whose file holds closed surfaces inside or across others, where these count.
    """

    moving: Surface
    fixed: Surface
    settings: Settings
    motions: tuple[tuple[str, Motion], ...]
    reference: Reference | None
    error: PoseError | None = None
    inner: Mapping[Literal["moving", "fixed"], UnitedSurface] = field(default_factory=dict)

    @property
    def title(self) -> str:
        """Heading of figures and pages."""
        return f"MOVING {self.moving.name} on FIXED {self.fixed.name}"


def read(o: AreaOptions, record: Record) -> Bodies:
    """Everything the options name."""
    if o.paraview:
        require_pyvista()
    split = None
    if o.split is not None:
        split = quantities.splitting_plane(o.split, o.unit), medial_side(o.split, o.side, o.medial)
    reference = None
    if o.compare is not None:
        table = read_reference(o.compare)
        reference = Reference(o.compare, table, TOLERANCE if o.tolerance is None else o.tolerance)
        record.add_input("`compare`", o.compare)
    error = pose_error_of(o)
    if o.markers is not None:
        record.add_input("`markers`", o.markers)
    closed = {body: o.assume_closed in (body, "both") for body in ("moving", "fixed")}
    moving, outer_moving = read_body_and_outer(record, "moving", o.moving, o.unit, o.place_moving, closed["moving"])
    fixed, outer_fixed = read_body_and_outer(record, "fixed", o.fixed, o.unit, o.place_fixed, closed["fixed"])
    refuse_two_spaces(moving, fixed)
    refuse_zero_without_inside(o.threshold, moving, fixed)
    if split is not None:
        refuse_other_axes(fixed.space, fixed.name, o.side, o.medial)
    settings = _settings(record, o, split, moving, fixed)
    if o.split is not None and split is not None:
        refuse_plane_beside(o.split, split[0], fixed, settings.fixed_faces, o.unit)
        record.say(f"medial is {split[1].words} of {fixed.name}")
    bodies = Bodies(moving, fixed, settings, tuple(motions_given(record, o, moving)), reference, error)
    return _outer(record, o, bodies, {"moving": outer_moving, "fixed": outer_fixed})


def _outer(
    record: Record, o: AreaOptions, bodies: Bodies, found: Mapping[Literal["moving", "fixed"], UnitedSurface | None]
) -> Bodies:
    """The bodies with their outer surfaces where these are asked for, and known where they are not."""
    if o.outer is not None and not any(found[body] for body in found if o.outer in (body, "both")):
        record.warn(f"`outer` {o.outer} leaves nothing out: no closed surface lies inside or across another one")
    inner = {}
    for body, united in found.items():
        if united is None:
            continue
        if o.outer not in (body, "both"):
            inner[body] = united
            continue
        record.say(
            f"{united.surface.name} holds {united.words}: its outer surface counts, "
            f"{united.inner_area * MM2:.1f} mm^2 inside are left out"
        )
        marked = bodies.settings.moving_faces if body == "moving" else bodies.settings.fixed_faces
        faces = None if marked is None else marked[united.face]
        if body == "moving":
            settings = replace(bodies.settings, moving_faces=faces)
            bodies = replace(bodies, moving=united.surface, settings=settings)
        else:
            settings = replace(bodies.settings, fixed_faces=faces)
            bodies = replace(bodies, fixed=united.surface, settings=settings)
    return replace(bodies, inner=inner)


def _settings(
    record: Record, o: AreaOptions, split: tuple[Plane, MedialSide] | None, moving: Surface, fixed: Surface
) -> Settings:
    pieces = BRIEF if min(o.threshold) >= FINE else FEW
    refinement = Refinement(pieces=pieces) if o.bounds is None else Refinement(bounds=o.bounds, pieces=PATIENT)
    return Settings(
        thresholds=o.threshold,
        rule=o.rule,
        refinement=refinement,
        fixed_faces=chosen_faces(record, "`region`", o.region, fixed, o.unit),
        moving_faces=chosen_faces(record, "`region_moving`", o.region_moving, moving, o.unit),
        split=None if split is None else split[0],
        medial_side=0 if split is None else split[1].sign,
        sensitivity=tuple((max(o.threshold) or ZERO_REACH) * SENSITIVITY),
    )
