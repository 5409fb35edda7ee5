"""What the fit of a shape may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.checks import refuse
from geocontact.analyses.frame.marks import Degrees, Excludes, Expression, Length, MeshUnit, Requires, Spelled, Typed
from geocontact.analyses.frame.options import Options
from geocontact.analyses.frame.shared_options import Medial, Side, medial_side
from geocontact.data.plausible import JOINT_ANGLE, MERGED, Plausible
from geocontact.data.units import deg

NEEDS = {
    "radial": "`axis` or `centre`",
    "outward": "`axis` or `centre`",
    "flexion": "`axis` and `sagittal`",
    "distance": "`other`",
}
"""Names that a region may use, by the options that say where they are counted from."""

WINDOW = Plausible("a window of flexion", deg, (1.0, 180.0))
AngleRange = Annotated[
    tuple[float, float, float], Typed("rad", "degree_range", "gc.deg(-30, 120, 5)"), Spelled(dashed=True), JOINT_ANGLE
]
Profile = Requires("profile")


@dataclass(frozen=True)
class ShapeOptions(Options):
    """Cylinder, sphere or plane that fits a surface best, by distance and robustly, with the map of the residuals.

    Parameters
    ----------
    mesh
        Surface to fit to (.stl .ply .obj .off .vtp .step).
    shape
        What is fitted.
    unit
        Unit of the meshes; never guessed.

    Which faces count, and how they are placed
    ------------------------------------------
    region
        Faces that count: "outward>0.5 and flexion>30" in x y z nx ny nz (mesh unit), and with `axis` or `centre` radial
        outward, with `axis` and `sagittal` flexion [deg], with `other` distance; or a file of face numbers, or picked
        landmarks: polygon:FILE.csv, or sphere:FILE.csv:NAME:12mm.
    axis
        x,y,z,dx,dy,dz (point in the mesh unit), a file of these, a fit.json of a cylinder, or two landmarks picked on
        the mesh: FILE.csv:A:B.
    hold_axis
        The cylinder is to be parallel to `axis`.
    centre
        x,y,z (mesh unit), a fit.json of a sphere, or a landmark FILE.csv:NAME: what radial and outward are counted from
        instead of an axis.
    sagittal
        Directions of 0 and 90 degrees of flexion as seen from the axis: -y,x has distal at -y and posterior at +x.
    other
        Mesh that the distance is to.
    unit_other
        Unit of the other mesh and of `place_other` where it is not `unit`.
    place
        Pose of the mesh in its body: a file with a 4x4 matrix, or model.osim:body.
    place_other
        The same for the other mesh, in the frame of the first.
    merge_tolerance
        Merge vertices of the meshes that lie within this distance, where corners that faces share differ by rounding; a
        warning has how many, and the largest shift. Only equal ones by default.

    How it is fitted
    ----------------
    points
        What the shape is fitted to: vertices of the faces that count, or their centroids.
    robust
        Ignore outliers; otherwise ordinary least squares.

    Sides and profile
    -----------------
    split
        x, y or z (or z=1.5): medial and lateral points are fitted apart as well, cylinders along the axis of the whole;
        needs `side` or `medial`.
    side
        Side of the body, for `split` z: right says that medial is -z, left that it is +z, in a frame whose z points to
        the subject's right (ISB, OpenSim).
    medial
        Side of the splitting plane that is medial, instead of `side`.
    profile
        Also compute the radius as a function of flexion: start, stop and step, typed -30:120:5 in degrees, about
        `axis` or the fitted cylinder's axis.
    window
        Flexion over which the radius of the profile is taken; 30 degrees by default.

    Results
    -------
    paraview
        Also write the surface with its residuals for ParaView (fit.vtp).
    """

    writes: ClassVar[str] = """
    Writes fit.json, fit.png, fit.svg, report.html and run.json into OUT, and profile.csv, profile.png, profile.svg with
    `profile`. Which faces count decides the radius: say it with `region`.
    """

    mesh: Path
    _: KW_ONLY
    shape: Literal["cylinder", "sphere", "plane"]
    unit: MeshUnit
    region: Expression | None = None
    axis: Expression | None = None
    hold_axis: bool = False
    centre: Annotated[Expression | None, Excludes("axis", "with `axis` names two places to count from", "give one")] = (
        None
    )
    sagittal: Expression | None = None
    other: Path | None = None
    unit_other: Annotated[MeshUnit | None, Requires("other", "give it too")] = None
    place: str | None = None
    place_other: Annotated[str | None, Requires("other", "give it too")] = None
    merge_tolerance: Annotated[Length | None, MERGED] = None
    points: Literal["vertices", "faces"] = "vertices"
    robust: bool = True
    split: str | None = None
    side: Annotated[Side | None, Requires("split")] = None
    medial: Annotated[
        Medial | None, Requires("split"), Excludes("side", "with `side` says twice what is medial", "give one")
    ] = None
    profile: AngleRange | None = None
    window: Annotated[Degrees | None, Profile, WINDOW] = None
    paraview: bool = False

    def refuse_impossible(self) -> None:
        """Places that nothing is counted from, a profile without an axis or an end."""
        self._refuse_places()
        if self.split is not None:
            medial_side(self.split, self.side, self.medial)
        needs_axis = self.profile is not None and self.shape != "cylinder" and self.axis is None
        refuse(
            (
                needs_axis,
                "`profile`",
                f"needs an axis, and a {self.shape} has none",
                "give `axis`, or fit a cylinder",
            ),
            (
                self.profile is not None and not _arrives(*self.profile),
                "`profile`",
                "never arrives",
                "give start, stop and step",
            ),
        )

    def _refuse_places(self) -> None:
        """What a region does not speak of is counted from nowhere."""
        used = self.names_in_region()
        about_axis = self.profile is not None or self.hold_axis or bool(used & {"radial", "outward", "flexion"})
        idle, remedy = "has no effect here: `region` does not speak of", "leave it out"
        refuse(
            (
                self.hold_axis and (self.shape != "cylinder" or self.axis is None),
                "`hold_axis`",
                "needs a cylinder and an `axis`",
                "give them, or leave it out",
            ),
            (self.axis is not None and not about_axis, "`axis`", f"{idle} radial, outward or flexion", remedy),
            (
                self.centre is not None and not used & {"radial", "outward"},
                "`centre`",
                f"{idle} radial or outward",
                remedy,
            ),
            (
                self.sagittal is not None and self.profile is None and "flexion" not in used,
                "`sagittal`",
                "has no effect here: there is no `profile` and `region` does not speak of flexion",
                remedy,
            ),
            (self.other is not None and "distance" not in used, "`other`", f"{idle} distance", remedy),
        )

    def names_in_region(self) -> set[str]:
        """Those of `NEEDS` that the region speaks of; a file of face numbers speaks of none."""
        from geocontact.analyses.frame.landmarks import region_kind  # numpy and friends: not for --help
        from geocontact.analyses.frame.quantities import named_file

        if self.region is None or region_kind(self.region)[0] or named_file(self.region) is not None:
            return set()
        return {name for name in NEEDS if name in self.region}


def _arrives(start: float, stop: float, step: float) -> bool:
    """Whether steps lead from start to stop."""
    return step != 0.0 and 0.0 <= (stop - start) / step <= 1e5
