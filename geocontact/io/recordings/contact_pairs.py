"""Description of bodies that move together and of the pairs of them that touch.

    unit = "mm"

    [[bodies]]
    name = "femur"
    mesh = "femoral_component.stl"
    motion = "femur.csv"

    [[bodies]]
    name = "insert"
    mesh = "tibial_insert.stl"

    [[bodies]]
    name = "patella"
    mesh = "patella.stl"
    motion = "patella.csv"

    [[pairs]]
    name = "medial"
    moving = "femur"
    fixed = "insert"
    region = "z < 0"

    [[pairs]]
    name = "patellofemoral"
    moving = "patella"
    fixed = "femur"

All motions are in one frame, such as the laboratory's; a body without one rests in it. Instead of files of poses:
`model` (.osim) and `coordinates` of it (.mot, .sto) for the whole description, and for each body the `segment` of the
model that it is fixed to; the frame is the model's ground then. Times are those of the first body of a pair that
moves. Bodies that come to rest on the layers of the pairs (`geocontact settle-pairs`):

    [[free]]
    body = "femur"
    axes = "insert"
    settles = ["ty", "rx"]
    fy = { value = -2000, unit = "N" }
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from geocontact.data.plausible import (
    ALONG_AXIS,
    FRAME_RATE,
    HELD_PLACE,
    HELD_TURN,
    LAYER,
    MERGED,
    PIECE,
    PLACE_ON_BODY,
    YOUNG,
)
from geocontact.io.document_errors import refusal
from geocontact.io.documents import (
    Document,
    File,
    FileName,
    Listed,
    Names,
    Rows,
    Some,
    Text,
    WithUnit,
    Word,
    doubled,
    read_document,
)

MeshUnit = Literal["m", "cm", "mm", "in"]
TOTAL = "total"
"""What columns of the sums over all pairs are called."""


class DescribedBody(Document):
    """A body.

    Parameters
    ----------
    name
        What pairs call it.
    mesh
        Its surface.
    unit
        Of its mesh.
    motion
        Its poses over time; at rest without.
    segment
        Instead of a motion: body of `model` it is on.
    place
        Place of the mesh in its body: file with a 4x4 matrix, or model.osim:body.
    closed
        Treat it as closed.
    """

    name: FileName
    mesh: File
    unit: MeshUnit | None = None
    motion: File | None = None
    segment: Word | None = None
    place: Text | None = None
    closed: bool = False

    @model_validator(mode="after")
    def _require_one_motion(self) -> DescribedBody:
        if self.motion is not None and self.segment is not None:
            raise refusal("has a motion and a segment of the model", "leave one of them out")
        return self


class DescribedLayer(Document):
    """An elastic layer on FIXED of a pair, into which MOVING, rigid, is pressed.

    Parameters
    ----------
    modulus
        Young's modulus.
    poisson
        Poisson's ratio.
    thickness
        Thickness; along rays by default.
    piece
        Longest edge of its pieces; 0.5 mm by default.
    foundation
        Its law.
    """

    modulus: Annotated[float, WithUnit(YOUNG)]
    poisson: Annotated[float, Field(gt=0.0, lt=0.5)]
    thickness: Annotated[float, WithUnit(LAYER)] | None = None
    piece: Annotated[float, WithUnit(PIECE)] | None = None
    foundation: Literal["linear", "logarithmic"] = "linear"


class DescribedPair(Document):
    """Two bodies whose contact is evaluated.

    Parameters
    ----------
    name
        That of its folder.
    moving
        Body that moves in the other one's frame.
    fixed
        Body in whose frame results are.
    region, region_moving
        Faces that count, as for `area`.
    layer
        Elastic layer on FIXED.
    """

    name: FileName
    moving: Word
    fixed: Word
    region: Text | None = None
    region_moving: Text | None = None
    layer: DescribedLayer | None = None

    @model_validator(mode="after")
    def _require_two(self) -> DescribedPair:
        if self.name == TOTAL:
            raise refusal(f"{TOTAL} is what the sums of all pairs are called", "give another name", at=("name",))
        if self.moving == self.fixed:
            raise refusal(f"{self.moving} is both moving and fixed", "name two bodies")
        return self


_SPRING, _TURNED = Annotated[float, WithUnit(HELD_PLACE)], Annotated[float, WithUnit(HELD_TURN)]
SPRINGS = {"tx": _SPRING, "ty": _SPRING, "tz": _SPRING, "rx": _TURNED, "ry": _TURNED, "rz": _TURNED}


class DescribedFree(Document):
    """A body that comes to rest on the layers, for `geocontact settle-pairs`.

    Parameters
    ----------
    body
        The body.
    axes
        Body along whose axes its coordinates and force are; the common frame by default.
    settles
        Which come to rest: displacements tx, ty, tz of its point, turns R = Ry(ry) Rx(rx) Rz(rz).
    fx, fy, fz
        Force; it keeps its direction.
    forces
        Forces over time in place of these: table with fx, fy, fz, or the same behind the body's name (femur_fy).
    px, py, pz
        Point of the body, in its frame, that the force acts at.
    springs
        Stiffness of coordinates, at rest where the motion is.
    """

    body: Word
    axes: Word | None = None
    settles: Names
    fx: Annotated[float, WithUnit(ALONG_AXIS)] = 0.0
    fy: Annotated[float, WithUnit(ALONG_AXIS)] = 0.0
    fz: Annotated[float, WithUnit(ALONG_AXIS)] = 0.0
    forces: File | None = None
    px: Annotated[float, WithUnit(PLACE_ON_BODY)] = 0.0
    py: Annotated[float, WithUnit(PLACE_ON_BODY)] = 0.0
    pz: Annotated[float, WithUnit(PLACE_ON_BODY)] = 0.0
    springs: Annotated[dict[str, float], Some(SPRINGS)] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _require_free(self) -> DescribedFree:
        odd = next((name for name in self.settles if name not in SPRINGS), None)
        if odd is not None or not self.settles:
            what = "is empty: nothing settles" if odd is None else f"{odd!r:.40} is no coordinate"
            raise refusal(what, f"there are {', '.join(SPRINGS)}", at=("settles",))
        for name in self.springs:
            if name not in self.settles:
                raise refusal("is held, and its spring has no effect", f"add {name} to settles", at=("springs", name))
        for axis in "xyz":
            if getattr(self, f"f{axis}") and f"t{axis}" not in self.settles:
                what, remedy = f"has no effect: t{axis} is held", f"add t{axis} to settles, or leave it out"
                raise refusal(what, remedy, at=(f"f{axis}",))
            if getattr(self, f"f{axis}") and self.forces is not None:
                raise refusal("stands beside forces over time", "keep one of them", at=(f"f{axis}",))
        return self


class PairsDescription(Document):
    """Everything in the description.

    Parameters
    ----------
    unit
        Unit of all meshes.
    bodies
        All bodies.
    pairs
        All pairs.
    model
        OpenSim model.
    coordinates
        Its coordinates over time.
    angles
        Unit where a file does not say it.
    order
        Order of intrinsic rotations.
    rate
        Frames per second of poses without times.
    free
        Bodies that come to rest.
    merge_tolerance
        As of `area`.
    """

    unit: Annotated[MeshUnit, Field(examples=['"mm"'])]
    bodies: Annotated[tuple[DescribedBody, ...], Listed("body{number}", doubled)]
    pairs: Annotated[tuple[DescribedPair, ...], Listed("{moving}_{fixed}", doubled)]
    model: File | None = None
    coordinates: File | None = None
    angles: Literal["deg", "rad"] | None = None
    order: Word | None = None
    rate: Annotated[float, WithUnit(FRAME_RATE)] | None = None
    free: Annotated[tuple[DescribedFree, ...], Rows] = ()
    merge_tolerance: Annotated[float, WithUnit(MERGED)] | None = None

    @model_validator(mode="after")
    def _require_bodies(self) -> PairsDescription:
        known = {body.name for body in self.bodies}
        for k, pair in enumerate(self.pairs):
            for role in ("moving", "fixed"):
                if getattr(pair, role) not in known:
                    what, remedy = f"no body is called {getattr(pair, role)}", f"there are {', '.join(sorted(known))}"
                    raise refusal(what, remedy, at=("pairs", k, role))
        if (self.model is None) != (self.coordinates is None):
            raise refusal("has a model or coordinates alone", "write both, or neither", at=("model",))
        for k, body in enumerate(self.bodies):
            if body.segment is not None and self.model is None:
                raise refusal("needs a model and its coordinates", "write them", at=("bodies", k, "segment"))
        if all(body.motion is None and body.segment is None for body in self.bodies):
            raise refusal("no body moves", "write a motion for one", at=("bodies",))
        self._require_free(known)
        return self

    def _require_free(self, known: set[str]) -> None:
        free = [one.body for one in self.free]
        for k, one in enumerate(self.free):
            for key, name in (("body", one.body), ("axes", one.axes)):
                if name is not None and name not in known:
                    what, remedy = f"no body is called {name}", f"there are {', '.join(sorted(known))}"
                    raise refusal(what, remedy, at=("free", k, key))
            if free.index(one.body) != k:
                raise refusal(f"{one.body} is free twice", "write one [[free]] for each body", at=("free", k, "body"))
            if one.axes in free:
                what = f"{one.axes} comes to rest itself: its axes are not known before"
                raise refusal(what, "name a body that is held, or leave axes out", at=("free", k, "axes"))

    def body(self, name: str) -> DescribedBody:
        """The body of this name."""
        return next(body for body in self.bodies if body.name == name)


def read_pairs(path: Path) -> PairsDescription:
    """The description; InputError for what is missing or cannot be."""
    return read_document(path, PairsDescription)
