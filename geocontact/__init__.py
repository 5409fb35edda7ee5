"""From implant and body-scan meshes, motion and pressure data to contact areas, contact forces and material properties.

One function for every job; each returns a result that says what was found::

    import geocontact as gc
    result = gc.area("femoral.stl", "tibial.stl", unit="mm", motion="gait.csv", threshold=gc.mm(4))
    result                        # two sentences; in a notebook with its figure
    result.table(), result.write("out"), result.page("report.html")

SI units inside (m, rad, s, N, Pa): values enter with a unit argument or as `gc.mm(4)`; tables have the unit in each
column's name.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from geocontact.data.version import VERSION

if TYPE_CHECKING:
    from geocontact import chain
    from geocontact.analyses import knee, misalignment, prosthesis, shoulder, sit_to_stand
    from geocontact.analyses.area.result import area, pressure
    from geocontact.analyses.cop.result import centre_of_pressure
    from geocontact.analyses.gap.diagnose.result import diagnose
    from geocontact.analyses.gap.discriminability.result import discriminability
    from geocontact.analyses.gap.gather.result import gather
    from geocontact.analyses.gap.inject.result import inject
    from geocontact.analyses.loadcells.result import load_cells
    from geocontact.analyses.mat.result import mat
    from geocontact.analyses.modulus.result import modulus
    from geocontact.analyses.motion.functional_joint.result import functional_joint
    from geocontact.analyses.motion.inverse_dynamics.result import inverse_dynamics
    from geocontact.analyses.motion.inverse_kinematics.result import inverse_kinematics
    from geocontact.analyses.motion.scale.result import scale
    from geocontact.analyses.motion.virtual_markers.result import virtual_markers
    from geocontact.analyses.result import Result
    from geocontact.analyses.shape.result import fit_shape
    from geocontact.data.errors import InputError, InputWarning
    from geocontact.data.evolution import AreaEvolution
    from geocontact.data.motion import Motion
    from geocontact.data.parameter import Parameter
    from geocontact.data.units import GPa, MPa, cm, deg, inch, kN, kPa, lbf, m, mm, mmHg, ms, percent
    from geocontact.effects.catalogue import candidates
    from geocontact.geometry.contact_area.area import Refinement
    from geocontact.geometry.contact_area.evolution import ContactPair, Settings, area_evolution
    from geocontact.geometry.contact_area.maps import DistanceMaps
    from geocontact.geometry.plane import Plane
    from geocontact.geometry.proximity import Proximity
    from geocontact.geometry.regions import faces_where
    from geocontact.geometry.separation import separation, settle
    from geocontact.geometry.shapes import HalfSpace, Sphere, Tube
    from geocontact.geometry.surface import Surface
    from geocontact.geometry.sweep import Axis, sweep
    from geocontact.io.cases.gap_case import read_gap_case
    from geocontact.io.mesh.meshes import read_mesh
    from geocontact.io.motion.motion import read_motion
    from geocontact.study.result import cohort
    from geocontact.systems.base import Base, require_numbers
    from geocontact.systems.catalogue import system_of
    from geocontact.systems.external.simulator import simulator_base

__version__ = VERSION

_PLACES = {
    "InputError": "data.errors",
    "InputWarning": "data.errors",
    "Motion": "data.motion",
    "Plane": "geometry.plane",
    "Surface": "geometry.surface",
    "read_mesh": "io.mesh.meshes",
    "read_motion": "io.motion.motion",
    "AreaEvolution": "data.evolution",
    "Refinement": "geometry.contact_area.area",
    "ContactPair": "geometry.contact_area.evolution",
    "Settings": "geometry.contact_area.evolution",
    "area_evolution": "geometry.contact_area.evolution",
    "DistanceMaps": "geometry.contact_area.maps",
    "Proximity": "geometry.proximity",
    "faces_where": "geometry.regions",
    "separation": "geometry.separation",
    "settle": "geometry.separation",
    "HalfSpace": "geometry.shapes",
    "Sphere": "geometry.shapes",
    "Tube": "geometry.shapes",
    "Axis": "geometry.sweep",
    "sweep": "geometry.sweep",
    "area": "analyses.area.result",
    "pressure": "analyses.area.result",
    "centre_of_pressure": "analyses.cop.result",
    "fit_shape": "analyses.shape.result",
    "load_cells": "analyses.loadcells.result",
    "modulus": "analyses.modulus.result",
    "cohort": "study.result",
    "mat": "analyses.mat.result",
    "scale": "analyses.motion.scale.result",
    "functional_joint": "analyses.motion.functional_joint.result",
    "inverse_kinematics": "analyses.motion.inverse_kinematics.result",
    "inverse_dynamics": "analyses.motion.inverse_dynamics.result",
    "virtual_markers": "analyses.motion.virtual_markers.result",
    "diagnose": "analyses.gap.diagnose.result",
    "discriminability": "analyses.gap.discriminability.result",
    "inject": "analyses.gap.inject.result",
    "gather": "analyses.gap.gather.result",
    "Base": "systems.base",
    "require_numbers": "systems.base",
    "simulator_base": "systems.external.simulator",
    "Parameter": "data.parameter",
    "read_gap_case": "io.cases.gap_case",
    "system_of": "systems.catalogue",
    "candidates": "effects.catalogue",
    "m": "data.units",
    "cm": "data.units",
    "mm": "data.units",
    "inch": "data.units",
    "deg": "data.units",
    "ms": "data.units",
    "kN": "data.units",
    "lbf": "data.units",
    "kPa": "data.units",
    "MPa": "data.units",
    "GPa": "data.units",
    "mmHg": "data.units",
    "percent": "data.units",
    "Result": "analyses.result",
}

_ROOMS = {
    "knee": "analyses.knee",
    "misalignment": "analyses.misalignment",
    "prosthesis": "analyses.prosthesis",
    "shoulder": "analyses.shoulder",
    "sit_to_stand": "analyses.sit_to_stand",
    "chain": "chain",
}
"""Modules with names of their own."""

__all__ = [
    "AreaEvolution",
    "Axis",
    "Base",
    "ContactPair",
    "DistanceMaps",
    "GPa",
    "HalfSpace",
    "InputError",
    "InputWarning",
    "MPa",
    "Motion",
    "Parameter",
    "Plane",
    "Proximity",
    "Refinement",
    "Result",
    "Settings",
    "Sphere",
    "Surface",
    "Tube",
    "area",
    "area_evolution",
    "candidates",
    "centre_of_pressure",
    "chain",
    "cm",
    "cohort",
    "deg",
    "diagnose",
    "discriminability",
    "faces_where",
    "fit_shape",
    "functional_joint",
    "gather",
    "inch",
    "inject",
    "inverse_dynamics",
    "inverse_kinematics",
    "kN",
    "kPa",
    "knee",
    "lbf",
    "load_cells",
    "m",
    "mat",
    "misalignment",
    "mm",
    "mmHg",
    "modulus",
    "ms",
    "percent",
    "pressure",
    "prosthesis",
    "read_gap_case",
    "read_mesh",
    "read_motion",
    "read_surface",
    "require_numbers",
    "scale",
    "separation",
    "settle",
    "shoulder",
    "simulator_base",
    "sit_to_stand",
    "sweep",
    "system_of",
    "virtual_markers",
]


def __getattr__(name: str) -> Any:
    """Import what is asked for, so that `import geocontact` stays light."""
    if name in _PLACES:
        return getattr(import_module(f"geocontact.{_PLACES[name]}"), name)
    if name in _ROOMS:
        return import_module(f"geocontact.{_ROOMS[name]}")
    raise AttributeError(f"module 'geocontact' has no attribute {name!r}")


def __dir__() -> list[str]:
    """All public names, imported or not."""
    return sorted({*globals(), *__all__})


def read_surface(path: str, unit: str, assume_closed: bool = False) -> Surface:
    """Surface of a mesh file whose numbers are in `unit` (m, cm, mm or in), ready for queries.

    Parameters
    ----------
    path
        `.stl`, `.ply`, `.obj` or `.vtp`; see `read_mesh`.
    unit
        Unit of the file's numbers. Never guessed.
    assume_closed
        Take it for the boundary of a body although edges are open, so that distances inside it are negative.

    Raises
    ------
    InputError
        The file cannot be used.

    Examples
    --------
    >>> import geocontact as gc
    >>> ball = gc.read_surface("meshes/sphere_r20.stl", "mm")
    >>> ball.vertices.shape, ball.faces.shape, ball.closed
    ((1442, 3), (2880, 3), True)
    """
    from geocontact.geometry.surface import Surface
    from geocontact.io.mesh.meshes import read_mesh

    return Surface.of(read_mesh(path, unit), assume_closed)
