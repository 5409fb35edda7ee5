"""VTK, float64: the implicit distance (one call for all points) and the static cell locator (one call per point)."""

from __future__ import annotations

from typing import Any

import numpy as np
from jaxtyping import Float

from benchmarks.engines.engine import Engine, Query, peer
from benchmarks.pairs import Pair


def poly_data(pair: Pair) -> Any:
    """B as VTK holds it, in double precision."""
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(pair.fixed.local), deep=1))
    cells = vtk.vtkCellArray()
    cells.SetData(3, numpy_to_vtkIdTypeArray(pair.fixed.faces.astype(np.int64).ravel(), deep=1))
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    return data


def implicit_distance(pair: Pair) -> Query:
    """vtkImplicitPolyDataDistance; its sign is dropped."""
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

    function = vtk.vtkImplicitPolyDataDistance()
    function.SetInput(poly_data(pair))

    def query(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        out = vtk.vtkDoubleArray()
        function.FunctionValue(numpy_to_vtk(np.ascontiguousarray(points), deep=1), out)
        return np.asarray(np.abs(vtk_to_numpy(out)))

    return query


def static_locator(pair: Pair) -> Query:
    """vtkStaticCellLocator.FindClosestPoint in a Python loop."""
    import vtk

    locator = vtk.vtkStaticCellLocator()
    locator.SetDataSet(poly_data(pair))
    locator.BuildLocator()
    cell = vtk.vtkGenericCell()

    def query(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        closest, face, part, squared = [0.0, 0.0, 0.0], vtk.mutable(0), vtk.mutable(0), vtk.mutable(0.0)
        out = np.empty(len(points))
        for i, point in enumerate(points):
            locator.FindClosestPoint(point, closest, cell, face, part, squared)
            out[i] = squared.get()
        return np.sqrt(out)

    return query


def engines() -> list[Engine]:
    """Both, naive."""
    return [
        Engine("VTK implicit distance", "vtk", peer(implicit_distance), every=25, goal=80.0),
        Engine("VTK static cell locator", "vtk", peer(static_locator), every=25, goal=80.0),
    ]
