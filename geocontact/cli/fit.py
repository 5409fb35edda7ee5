"""`geocontact fit`: the options of the command; the work is in `fit_analysis`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

Dashed = Parameter(allow_leading_hyphen=True)
Flag = Parameter(negative="")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class FitOptions:
    """Options of the fit as typed.

    Parameters
    ----------
    shape
        What is fitted.
    unit
        Unit of the meshes; never guessed.
    out
        Folder for the results.
    region
        Faces that count: "outward>0.5 and flexion>30" in x y z nx ny nz (mesh unit), and with --axis or --centre radial
        outward, with --axis and --sagittal flexion [deg], with --other distance; or a file of face numbers.
    axis
        x,y,z,dx,dy,dz (point in the mesh unit), a file of these, or a fit.json of a cylinder.
    hold_axis
        The cylinder is to be parallel to --axis.
    centre
        x,y,z (mesh unit), or a fit.json of a sphere: what radial and outward are counted from instead of an axis.
    sagittal
        Directions of 0 and 90 degrees of flexion as seen from the axis: -y,x has distal at -y and posterior at +x.
    other
        Mesh that the distance is to.
    place
        Where MESH sits in its body: a file with a 4x4 matrix, or model.osim:body.
    place_other
        The same for the other mesh, in the frame of MESH.
    points
        What the shape is fitted to: vertices of the faces that count, or their centroids.
    robust
        Points far off do not count; --no-robust is plain least squares.
    split
        x, y or z (or z=1.5): medial and lateral points are fitted apart as well, cylinders along the axis of the whole.
    medial
        Side of the splitting plane that is medial; - unless given.
    profile
        Also tell the radius as a function of flexion: -30:120:5 in degrees, about --axis or the fitted cylinder's axis.
    window
        Degrees of flexion over which the radius of the profile is taken; 30 unless given.
    paraview
        Also write the surface with its residuals for ParaView (fit.vtp).
    parquet
        Also write the profile as .parquet.
    """

    shape: Literal["cylinder", "sphere", "plane"]
    unit: Literal["m", "cm", "mm", "in"]
    out: Path
    region: Annotated[str | None, Dashed] = None
    axis: Annotated[str | None, Dashed] = None
    hold_axis: Annotated[bool, Flag] = False
    centre: Annotated[str | None, Dashed] = None
    sagittal: Annotated[str | None, Dashed] = None
    other: Path | None = None
    place: str | None = None
    place_other: str | None = None
    points: Literal["vertices", "faces"] = "vertices"
    robust: bool = True
    split: str | None = None
    medial: Annotated[Literal["-", "+"] | None, Dashed] = None
    profile: Annotated[str | None, Dashed] = None
    window: float | None = None
    paraview: Annotated[bool, Flag] = False
    parquet: Annotated[bool, Flag] = False


def fit(mesh: Path, /, *, options: FitOptions) -> int:
    """Cylinder, sphere or plane that fits a surface best, by distance and robustly, with the map of what is left over.

    Writes fit.json, fit.png, fit.svg, report.html and run.json into OUT, and profile.csv, profile.png, profile.svg with
    --profile. Which faces count decides the radius: say it with --region.

    Parameters
    ----------
    mesh
        Surface to fit to (.stl .ply .obj .vtp).
    """
    from geocontact.analyses.shape.run import analyse  # numpy and friends: not for --help

    return analyse(mesh, options)
