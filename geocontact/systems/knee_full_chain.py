"""Knee implant over its full chain: measured pose → two meshes → areas of the sides → Hertz's law → load cells.

Inputs `flexion [rad]`, `adduction [rad]`, `rotation [rad]`, `tx [m]`, `ty [m]`, `tz [m]`: pose of the femoral in the
tibial component (`systems.knee_posed`). Outputs, of `CELLS` the four load cells `PM [N]`, `AM [N]`, `AL [N]`, `PL [N]`,
of `SIDES` the forces `force_medial [N]`, `force_lateral [N]`.

    area of each side of FIXED within `threshold` of MOVING; F = (4/3) E* a³/R, a = sqrt(area/π) per side;
    cells by the regression read backwards (`loads.loadcells`).

Meshes `moving` (femoral component) and `fixed` (tibial insert). Parameter E_star [Pa]; constants R [m], threshold [m],
side (1 right, -1 left), for the cells cell_posterior and cell_anterior [m], x of the rows of cells in FIXED's frame.
Table `regression` (cell, medial [-], lateral [-]) in the place of the published weights.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float

from geocontact.chain.interface_law import INTERFACE_LAW
from geocontact.chain.links import Balance, Law, Loads, Motion, Sensor
from geocontact.chain.magnitudes import Magnitudes
from geocontact.chain.system import System
from geocontact.data.cell_regression import CellRegression
from geocontact.data.errors import InputWarning
from geocontact.data.gap_case import CaseMesh
from geocontact.data.parameter import Parameter
from geocontact.geometry.contact_area.sided_areas import SidedAreas
from geocontact.geometry.plane import Plane
from geocontact.geometry.regions import faces_where
from geocontact.geometry.surface import Surface
from geocontact.geometry.union import united
from geocontact.loads.loadcells import CELLS as CELL_NAMES
from geocontact.loads.loadcells import PUBLISHED, cell_forces
from geocontact.systems.base import Base, require_numbers
from geocontact.systems.knee import STRAPS, measured_forces, stiffness
from geocontact.systems.knee_posed import ANGLES, POSE, SHIFTS, PosedKnee

SIDE_NAMES = ("force_medial", "force_lateral")
MESHES = ("moving", "fixed")
ROWS = ("cell_posterior", "cell_anterior")
OFFSET = 0.8
"""Largest constant error of a pose over the reach of the areas' grid, so that a search stays on it.

At a threshold of 4 mm that is 1.9 mm and 0.054 rad: more than fluoroscopy or a registration to markers is wrong by.
"""


def regression_of(tables: Mapping[str, pd.DataFrame]) -> CellRegression:
    """Weights of the cells; ValueError when a table of the case does not give them."""
    if "regression" not in tables:
        return PUBLISHED
    table = tables["regression"]
    columns = ("cell", "medial [-]", "lateral [-]")
    if any(name not in table.columns for name in columns) or sorted(table["cell"]) != sorted(CELL_NAMES):
        raise ValueError(f"knee chain: regression needs {', '.join(columns)} and a row for {', '.join(CELL_NAMES)}")
    medial, lateral = (tuple(table[name].astype(float)) for name in columns[1:])
    return CellRegression("regression", "table of the case", tuple(table["cell"]), medial, lateral)


def to_cells(loads: Loads, rows: tuple[float, float], regression: CellRegression) -> Float[np.ndarray, "t c"]:
    """Each cell's load."""
    return cell_forces(loads.normal, loads.arm, rows, regression)


def counted(one: CaseMesh, surface: Surface) -> Bool[np.ndarray, " f"] | None:
    """Faces that the case lets count, None for all."""
    return faces_where(surface, one.region, one.metres_per_number) if one.region else None


def geometry_of(meshes: Mapping[str, CaseMesh], threshold: float, side: float) -> PosedKnee:
    """Link of the two surfaces; ValueError when the numbers cannot be."""
    if side not in (1.0, -1.0):
        raise ValueError(f"knee chain: side is {side:g}; write 1 for a right or -1 for a left knee")
    if not threshold > 0.0:
        raise ValueError(f"knee chain: threshold is {threshold:g} m; it must be positive, 0.004 in the paper")
    if meshes["moving"].region:
        raise ValueError("knee chain: faces of the moving mesh are not counted; give the region to [mesh.fixed]")
    moving, fixed = (Surface.of(meshes[name].mesh) for name in MESHES)
    _warn_of_inner_surfaces(moving)
    _warn_of_inner_surfaces(fixed)
    pair = SidedAreas(moving, fixed, threshold, Plane.across("z"), counted(meshes["fixed"], fixed))
    x = fixed.vertices[fixed.faces.ravel(), 0]
    return PosedKnee.of(pair, side, (float(x.min()), float(x.max())))


def _warn_of_inner_surfaces(surface: Surface) -> None:
    """A reservation where closed surfaces of one file lie inside or across others: their area counts as contact."""
    found = united(surface)
    if found is not None:
        warnings.warn(InputWarning(found.reservation), stacklevel=4)


def build(
    parameters: tuple[Parameter, ...],
    constants: Mapping[str, float],
    tables: Mapping[str, pd.DataFrame],
    meshes: Mapping[str, CaseMesh],
    outputs: tuple[str, ...] = CELL_NAMES,
) -> System:
    """The chain down to `outputs`; ValueError when a number, table or mesh that it needs is missing or wrong."""
    cells = outputs == CELL_NAMES
    require_numbers("knee chain", ("E_star", "R"), parameters, constants, positive=("E_star", "R"))
    require_numbers("knee chain", ("threshold", "side", *(ROWS if cells else ())), (), constants)
    total: Callable[[Loads], Float[np.ndarray, "t c"]] = measured_forces
    if cells:
        posterior, anterior = (constants[name] for name in ROWS)
        if not anterior > posterior:
            raise ValueError(f"knee chain: cell_anterior {anterior:g} m is not in front of cell_posterior")
        total = partial(to_cells, rows=(posterior, anterior), regression=regression_of(tables))
    units = {**dict.fromkeys(ANGLES, "rad"), **dict.fromkeys(SHIFTS, "m"), **dict.fromkeys(outputs, "N")}
    geometry = geometry_of(meshes, constants["threshold"], constants["side"])
    law = Law(INTERFACE_LAW, deflection="m^2").lacking(*STRAPS)
    return System(
        name="knee_chain",
        motion=Motion(POSE),
        geometry=geometry.having({"R": "R"}),
        law=law.having({"k": stiffness}),
        balance=Balance(outputs, total),
        sensor=Sensor(outputs),
        parameters=parameters,
        constants=dict(constants),
        scale=Magnitudes(),
        units=units,
        lengths=tuple(name for name in ("R",) if name in constants),
        bias=dict(zip(POSE, (OFFSET * geometry.areas.reach[:, 0]).tolist(), strict=True)),
    )


CELLS = Base("knee_chain", POSE, CELL_NAMES, build, MESHES)
SIDES = Base("knee_chain", POSE, SIDE_NAMES, partial(build, outputs=SIDE_NAMES), MESHES)
