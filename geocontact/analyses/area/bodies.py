"""The bodies of an area analysis: what is read, measured areas to compare with, what is refused."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal

import numpy as np
import pandas as pd
from jaxtyping import Bool

from geocontact.analyses.area.export_model import model_to_copy
from geocontact.analyses.area.literature import Flexions, flexions_of
from geocontact.analyses.area.motions import expanded, motions_given
from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.area.refused import LITERATURE
from geocontact.analyses.area.wear import refuse_other_cycles, wear_factor_of
from geocontact.analyses.frame import places
from geocontact.analyses.frame.bodies import (
    check_surfaces,
    chosen_faces,
    naming_unit_of_moving,
    read_body_and_outer,
    refuse_two_spaces,
    unit_of_moving,
)
from geocontact.analyses.frame.collector import add_input, reserve, say
from geocontact.analyses.frame.shared_options import MedialSide, medial_side, refuse_other_axes
from geocontact.analyses.motion.gait_cycles import cutting_of
from geocontact.analyses.motion.styles import Cutting
from geocontact.data.errors import InputError
from geocontact.data.evolution import MM2
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.area import Refinement
from geocontact.geometry.contact_area.comparison import THRESHOLD, TIME, is_area, largest_difference
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.contact_area.pose_error import PoseError
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface
from geocontact.geometry.union import UnitedSurface
from geocontact.io.text.results import read_frame
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.units import LENGTH
from geocontact.loads.wear import WearFactor
from geocontact.view.surfaces.vtp_series import require_pyvista

PARTS = ("", "_lower", "_upper", "_medial", "_lateral")


@dataclass(frozen=True)
class Reference:
    """The user's table and the largest relative difference to it that is acceptable."""

    path: Path
    table: pd.DataFrame
    tolerance: float

    def accepts(self, rows: pd.DataFrame) -> bool:
        """Whether no row of a comparison is beyond the tolerance."""
        return largest_difference(rows) <= self.tolerance


def read_reference(path: Path) -> pd.DataFrame:
    """Reference table: `time [s]`, optionally `threshold [mm]`, and one or more area columns as in area.csv [mm^2]."""
    areas = (f"area_{body}{part} [mm^2]" for body in ("fixed", "moving") for part in PARTS)
    table = read_frame(path, (TIME, THRESHOLD, *areas), "give a CSV like area.csv")
    if TIME not in table or not any(is_area(name) for name in table.columns):
        what = f"has the columns {', '.join(map(str, table.columns))}"
        raise InputError(path, "", what, "it needs 'time [s]' and for example 'area_fixed [mm^2]'")
    for name in table.columns:
        if name in (TIME, THRESHOLD) or is_area(name):
            table[name] = pd.to_numeric(table[name], errors="coerce")
    if table[TIME].isna().any():
        raise InputError(path, f"row {int(table[TIME].isna().argmax()) + 2}", "time is not a number", "correct it")
    return table


def refuse_plane_beside(
    split: str, plane: Plane, fixed: Surface, counted: Bool[np.ndarray, " m"] | None, unit: str
) -> None:
    """InputError for a plane that leaves all faces of FIXED that count on one side."""
    faces = fixed.faces if counted is None else fixed.faces[counted]
    height = plane.height(fixed.vertices[np.unique(faces)])
    if height.min() < 0.0 < height.max():
        return
    low, high = ((end + plane.offset) / LENGTH[unit] for end in (height.min(), height.max()))
    axis = split.partition("=")[0].strip()
    what = f"{axis} = {plane.offset / LENGTH[unit]:.6g} {unit} does not cut {fixed.name}"
    what += (
        f", whose {'faces that count go' if counted is not None else 'faces go'} from {low:.4g} to {high:.4g} {unit}"
    )
    middle = float(f"{0.5 * (low + high):.2g}")
    raise InputError("", "`split`", what, f"write for example {axis}={middle:g}")


def refuse_zero_without_inside(thresholds: tuple[float, ...], moving: Surface, fixed: Surface) -> None:
    """InputError for a threshold of 0, which counts penetration, where no body has an inside."""
    if 0.0 in thresholds and not moving.closed and not fixed.closed:
        what = f"0 counts what is inside the other body, and neither {moving.name} nor {fixed.name} is closed"
        raise InputError("", "`threshold`", what, "give a length, or say `assume_closed`")


DRAWS, SEED = 400, 1
COLUMNS = ["x [m]", "y [m]", "z [m]"]


def pose_error_of(o: AreaOptions) -> PoseError | None:
    """The error that the options describe; None where they describe none."""
    draws, seed = o.draws or DRAWS, SEED if o.seed is None else o.seed
    if o.pose_sd is not None:
        return PoseError.normal(np.asarray(o.pose_sd), o.pose_axes or "fixed", draws, seed)
    if o.markers is None or o.marker_sd is None:
        return None
    table = read_side_table(o.markers, COLUMNS)
    if missing := [name for name in COLUMNS if name not in table.columns]:
        raise InputError(o.markers, "line 1", f"no column {', '.join(missing)}", "write x [mm], y [mm], z [mm]")
    try:
        return PoseError.of_markers(table[COLUMNS].to_numpy(float), o.marker_sd, draws, seed)
    except ValueError as error:
        raise InputError(o.markers, "", str(error), "give the markers in MOVING's frame") from error


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
    flexions
        Flexion of the frames by motion, as far as it is known; None unless published areas are asked for.
    cutting
        Events that cut the motions into cycles; None without.
    stems
        Names of the motions' files.
    wear
        Wear factor of FIXED's layer; None unless wear is asked for.
    """

    moving: Surface
    fixed: Surface
    settings: Settings
    motions: tuple[tuple[str, Motion], ...]
    reference: Reference | None
    error: PoseError | None = None
    inner: Mapping[Literal["moving", "fixed"], UnitedSurface] = field(default_factory=dict)
    flexions: Flexions | None = None
    cutting: Cutting | None = None
    stems: tuple[str, ...] = ()
    wear: WearFactor | None = None

    @property
    def title(self) -> str:
        """Heading of figures and pages."""
        return f"MOVING {self.moving.name} on FIXED {self.fixed.name}"


def read(o: AreaOptions) -> Bodies:
    """Everything the options name."""
    return read_moved(o, lambda moving: motions_given(o, moving))


def read_moved(
    o: AreaOptions, moved: Callable[[Surface], Sequence[tuple[str, Motion]]], *, areas: bool = True
) -> Bodies:
    """The same with motions, by the names of their sub-folders, that `moved` gives for the surface of MOVING.

    `areas` is whether the bodies' areas are written, rather than only what a layer bears.
    """
    if o.paraview:
        require_pyvista()
    model_to_copy(o)
    split = None
    if o.split is not None:
        split = places.splitting_plane(o.split, o.unit), medial_side(o.split, o.side, o.medial)
    reference = None
    if o.compare is not None and o.compare != LITERATURE:
        table = read_reference(o.compare)
        reference = Reference(o.compare, table, TOLERANCE if o.tolerance is None else o.tolerance)
        add_input("`compare`", o.compare)
    error = pose_error_of(o)
    if o.markers is not None:
        add_input("`markers`", o.markers)
    closed = {body: o.assume_closed in (body, "both") for body in ("moving", "fixed")}
    with naming_unit_of_moving(o):
        moving, outer_moving = read_body_and_outer(
            "moving", o.moving, unit_of_moving(o), o.place_moving, closed["moving"], o.merge_tolerance, areas=areas
        )
    fixed, outer_fixed = read_body_and_outer(
        "fixed", o.fixed, o.unit, o.place_fixed, closed["fixed"], o.merge_tolerance, areas=areas
    )
    refuse_two_spaces(moving, fixed)
    beside = (*(Path(each).name for each in o.motion or ()), *(() if o.side is None else (f"`side` {o.side}",)))
    check_surfaces(moving, fixed, bodies=o.bodies, layered=o.pressure, beside=beside)
    refuse_zero_without_inside(o.threshold, moving, fixed)
    if split is not None:
        refuse_other_axes(fixed.space, fixed.name, o.side, o.medial)
    settings = _settings(o, split, moving, fixed)
    if o.split is not None and split is not None:
        refuse_plane_beside(o.split, split[0], fixed, settings.fixed_faces, o.unit)
        say(f"medial is {split[1].words} of {fixed.name}")
    motions = tuple(moved(moving))
    flexions = flexions_of(o, expanded(o.motion or ()), motions)
    cutting = cutting_of(o.events, o.cycle_side, o.part)
    stems = tuple(path.stem for path in expanded(o.motion or ()))
    wear = wear_factor_of(o)
    refuse_other_cycles(wear, cutting, motions, stems)
    bodies = Bodies(
        moving, fixed, settings, motions, reference, error, flexions=flexions, cutting=cutting, stems=stems, wear=wear
    )
    return _outer(o, bodies, {"moving": outer_moving, "fixed": outer_fixed})


def _outer(o: AreaOptions, bodies: Bodies, found: Mapping[Literal["moving", "fixed"], UnitedSurface | None]) -> Bodies:
    """The bodies with their outer surfaces where these are asked for, and known where they are not."""
    if o.outer is not None and not any(found[body] for body in found if o.outer in (body, "both")):
        reserve(f"`outer` {o.outer} leaves nothing out: no closed surface lies inside or across another one")
    inner = {}
    for body, united in found.items():
        if united is None:
            continue
        if o.outer not in (body, "both"):
            inner[body] = united
            continue
        say(
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


def refinement_of(thresholds: tuple[float, ...], bounds: float | None) -> Refinement:
    """When the refined rule stops, for thresholds [m] and the bounds asked for."""
    if bounds is not None:
        return Refinement(bounds=bounds, pieces=PATIENT)
    return Refinement(pieces=BRIEF if min(thresholds) >= FINE else FEW)


def _settings(o: AreaOptions, split: tuple[Plane, MedialSide] | None, moving: Surface, fixed: Surface) -> Settings:
    return Settings(
        thresholds=o.threshold,
        rule=o.rule,
        refinement=refinement_of(o.threshold, o.bounds),
        fixed_faces=chosen_faces("`region`", o.region, fixed, o.unit),
        moving_faces=chosen_faces("`region_moving`", o.region_moving, moving, unit_of_moving(o)),
        split=None if split is None else split[0],
        medial_side=0 if split is None else split[1].sign,
        sensitivity=tuple((max(o.threshold) or ZERO_REACH) * SENSITIVITY),
    )
