"""What a map of thickness may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import Expression, Length, MeshUnit, Spelled
from geocontact.analyses.frame.options import Options
from geocontact.data.plausible import MERGED, Plausible
from geocontact.data.units import mm

LAYER = Plausible("the largest thickness of a layer", mm, (0.01, 200.0), (0.5, 50.0), why="cartilage to thick liners")


@dataclass(frozen=True)
class ThicknessOptions(Options):
    """Thickness between two surfaces, such as cartilage on bone or a liner: along normals and by the nearest distance.

    Parameters
    ----------
    outer
        Mesh of the outer surface, whose faces get a thickness: the articular one.
    inner
        Mesh of the inner surface: that of the bone, or the back of a liner.
    unit
        Unit of both meshes; never guessed.
    unit_inner
        Unit of INNER's mesh and of `place_inner` where it is not `unit`.
    place_inner
        Pose of INNER in the frame of OUTER: a file with a 4x4 matrix, or model.osim:body.
    region
        Faces of OUTER that count: "ny>0.25" in x y z nx ny nz (mesh unit), a file of face numbers, or picked
        landmarks: polygon:FILE.csv, or sphere:FILE.csv:NAME:12mm.
    most
        Largest thickness: where INNER is farther away, a face of OUTER has none; 20mm by default.
    merge_tolerance
        Merge vertices of both meshes that lie within this distance; a warning has how many, and the largest shift.
        Only equal ones by default.
    paraview
        Also write OUTER with its thickness for ParaView (thickness.vtp).
    """

    writes: ClassVar[str] = """
    Writes thickness.csv, thickness.png, thickness.svg, report.html and run.json into OUT.
    """

    outer: Path
    inner: Path
    _: KW_ONLY
    unit: MeshUnit
    unit_inner: MeshUnit | None = None
    place_inner: str | None = None
    region: Expression | None = None
    most: Annotated[Length, Spelled(default="20"), LAYER] = 20e-3
    merge_tolerance: Annotated[Length | None, MERGED] = None
    paraview: bool = False
