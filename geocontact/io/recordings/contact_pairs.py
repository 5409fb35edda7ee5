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
moves.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from geocontact.data.plausible import FRAME_RATE, LAYER, PIECE, YOUNG
from geocontact.io.documents import (
    Document,
    File,
    FileName,
    Listed,
    Text,
    WithUnit,
    Word,
    doubled,
    read_document,
    refusal,
)

TOTAL = "total"
"""What columns of the sums over all pairs are called."""


class DescribedBody(Document):
    """A body.

    Parameters
    ----------
    name
        What pairs call it.
    mesh
        Its surface: .stl, .ply, .obj or .vtp.
    motion
        Its poses over time (.csv, or rows of numbers); at rest without.
    segment
        In place of a motion: the body of `model` it is fixed to.
    place
        Place of the mesh in its body: file with a 4x4 matrix, or model.osim:body.
    closed
        Treat it as closed.
    """

    name: FileName
    mesh: File
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
    """

    modulus: Annotated[float, WithUnit(YOUNG)]
    poisson: Annotated[float, Field(gt=0.0, lt=0.5)]
    thickness: Annotated[float, WithUnit(LAYER)] | None = None
    piece: Annotated[float, WithUnit(PIECE)] | None = None


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
        Unit of angles where a file does not say it.
    order
        Order of intrinsic rotations of Euler angles.
    rate
        Frames per second of poses without times.
    """

    unit: Annotated[Literal["m", "cm", "mm", "in"], Field(examples=['"mm"'])]
    bodies: Annotated[tuple[DescribedBody, ...], Listed("body{number}", doubled)]
    pairs: Annotated[tuple[DescribedPair, ...], Listed("{moving}_{fixed}", doubled)]
    model: File | None = None
    coordinates: File | None = None
    angles: Literal["deg", "rad"] | None = None
    order: Word | None = None
    rate: Annotated[float, WithUnit(FRAME_RATE)] | None = None

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
        return self

    def body(self, name: str) -> DescribedBody:
        """The body of this name."""
        return next(body for body in self.bodies if body.name == name)


def read_pairs(path: Path) -> PairsDescription:
    """The description; InputError for what is missing or cannot be."""
    return read_document(path, PairsDescription)
