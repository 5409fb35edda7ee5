"""From implant and body-scan meshes, motion and pressure data to contact areas, contact forces and material properties.

The main job in three lines::

    import geocontact as gc
    moving, fixed = gc.read_surface("femoral.stl", "mm"), gc.read_surface("tibial.stl", "mm")
    evolution = gc.area_evolution(moving, fixed, gc.read_motion("gait.csv"))

SI units inside (m, rad, s, N, Pa); `evolution.table()` is a data frame with the unit in each column's name.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from geocontact.analyses.area.page import write_report
    from geocontact.data.errors import InputError, InputWarning
    from geocontact.data.evolution import AreaEvolution
    from geocontact.data.motion import Motion
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
    from geocontact.io.mesh.meshes import read_mesh
    from geocontact.io.motion.motion import read_motion

__version__ = "0.1.0"

_PLACES = {
    "InputError": "data.errors",
    "InputWarning": "data.errors",
    "AreaEvolution": "data.evolution",
    "Motion": "data.motion",
    "Refinement": "geometry.contact_area.area",
    "ContactPair": "geometry.contact_area.evolution",
    "Settings": "geometry.contact_area.evolution",
    "area_evolution": "geometry.contact_area.evolution",
    "DistanceMaps": "geometry.contact_area.maps",
    "Plane": "geometry.plane",
    "Proximity": "geometry.proximity",
    "faces_where": "geometry.regions",
    "separation": "geometry.separation",
    "settle": "geometry.separation",
    "HalfSpace": "geometry.shapes",
    "Sphere": "geometry.shapes",
    "Tube": "geometry.shapes",
    "Surface": "geometry.surface",
    "Axis": "geometry.sweep",
    "sweep": "geometry.sweep",
    "read_mesh": "io.mesh.meshes",
    "read_motion": "io.motion.motion",
    "write_report": "analyses.area.page",
}

__all__ = [
    "AreaEvolution",
    "Axis",
    "ContactPair",
    "DistanceMaps",
    "HalfSpace",
    "InputError",
    "InputWarning",
    "Motion",
    "Plane",
    "Proximity",
    "Refinement",
    "Settings",
    "Sphere",
    "Surface",
    "Tube",
    "area_evolution",
    "faces_where",
    "read_mesh",
    "read_motion",
    "read_surface",
    "separation",
    "settle",
    "sweep",
    "write_report",
]


def __getattr__(name: str) -> Any:
    """Import what is asked for, so that `import geocontact` stays light."""
    if name in _PLACES:
        return getattr(import_module(f"geocontact.{_PLACES[name]}"), name)
    raise AttributeError(f"module 'geocontact' has no attribute {name!r}")


def read_surface(path: str, unit: str, assume_closed: bool = False) -> Surface:
    """Surface of a mesh file whose numbers are in `unit` (m, cm, mm or in), ready for queries; see `read_mesh`."""
    from geocontact.geometry.surface import Surface
    from geocontact.io.mesh.meshes import read_mesh

    return Surface.of(read_mesh(path, unit), assume_closed)
