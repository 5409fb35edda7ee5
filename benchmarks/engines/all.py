"""Every engine, ours first."""

from __future__ import annotations

from benchmarks.engines import (
    fcl_distance,
    fcpw_cpu,
    libigl,
    open3d_scene,
    ours,
    trimesh_closest,
    vtk_locator,
    warp_cpu,
)
from benchmarks.engines.engine import Engine

MODULES = (ours, warp_cpu, fcpw_cpu, open3d_scene, libigl, vtk_locator, fcl_distance, trimesh_closest)


def all_engines() -> list[Engine]:
    """All rows in the order of the table."""
    return [engine for module in MODULES for engine in module.engines()]


def engine_named(name: str) -> Engine:
    """The one row of that name."""
    return next(engine for engine in all_engines() if engine.name == name)
