"""Description of a gait study with a prosthetic foot: persons, and their stances on force plates.

    [persons.P1]
    mass = { value = 77.3, unit = "kg" }
    static = "P1/standing.trc"
    side = "right"
    sex = "male"
    residual = { value = 45, unit = "%" }
    functional = "P1/hip.trc"
    law = "P1/law.toml"

    [[trials]]
    name = "P1_medium_1"
    person = "P1"
    setting = "medium"
    markers = "P1_medium_1/walking.trc"
    plates = "P1_medium_1/plates.mot"
    plate = "own_force"
    other_plate = "other_force"
    calibrated = true
    law = "P1/law_medium.toml"
    ground = "plane:-0.05,1,0,0"

Files are looked for beside the description. `fulcrum = { value = 100, unit = "mm" }` stands in place of a `setting`.
`calibrated` marks a trial that its `law` was fitted to: that of the trial, such as one for each setting, else the
person's. `foot` and `socket` of a person describe others than
the study's. `ground` is a plane or stairs as in `prosthesis simulate`. What may
be left out: `side`, `sex`, `residual`, `functional`, `law`, `foot`, `socket`, `name`, `calibrated`, `ground`;
`age`, `height` and own values of `segments` are those of `described_person`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from geocontact.data.plausible import PERSON, Plausible
from geocontact.data.units import mm
from geocontact.io.document_errors import refusal
from geocontact.io.documents import Document, File, Listed, WithUnit, Word, doubled, read_document
from geocontact.io.recordings.described_person import DescribedPerson

FULCRUM = Plausible("the place of a fulcrum", mm, (1.0, 500.0))
LIMB = Plausible("the length of a residual limb", mm, (20.0, 500.0))
Side = Literal["right", "left"]


class GaitPerson(DescribedPerson):
    """A person with a prosthesis.

    Parameters
    ----------
    mass
        Body mass with the prosthesis.
    static
        Markers while standing.
    side
        Side of the prosthesis.
    sex
        Row of the segment table.
    age
        From 6 years on; below 18 masses are those of boys.
    height
        Body height, for lengths beside own values.
    segments
        Own values by segment.
    residual
        Share of the shank that is left.
    residual_length
        Length of the residual limb from the knee's centre, in place of a share.
    residual_markers
        Two markers of the standing trial at its ends, in place of a length.
    functional
        Markers of a trial in which the hip turns.
    law
        Force law of the foot.
    foot
        Description of the person's foot; the shipped one by default.
    socket
        Description of the person's socket; the study's numbers by default.
    """

    mass: Annotated[float, WithUnit(PERSON)]
    static: File
    side: Side = "right"
    residual: Annotated[float, WithUnit("-"), Field(gt=0.0, lt=1.0)] | None = None
    residual_length: Annotated[float, WithUnit(LIMB)] | None = None
    residual_markers: Word | None = None
    functional: File | None = None
    law: File | None = None
    foot: File | None = None
    socket: File | None = None


class GaitStance(Document):
    """One stance as it is described.

    Parameters
    ----------
    name
        Its own for each.
    person
        Name from `[persons.NAME]`.
    markers
        Recorded markers: .trc, .c3d or .csv.
    plates
        Force plates: .mot, .sto or .c3d.
    plate, other_plate
        Plates under the prosthetic foot and under the other one, by name or number.
    setting, fulcrum
        Setting of the foot, such as low, medium or high, or place of its fulcrum; one of both.
    calibrated
        Whether the law was fitted to it.
    law
        Force law in place of the person's.
    ground
        A plane or stairs as in `prosthesis simulate`; the floor y = 0 by default.
    """

    name: Word
    person: Word
    markers: File
    plates: File
    plate: Word
    other_plate: Word
    setting: Word | None = None
    fulcrum: Annotated[float, WithUnit(FULCRUM)] | None = None
    calibrated: bool = False
    law: File | None = None
    ground: Word | None = None

    @property
    def foot(self) -> str:
        """The setting's name, else the fulcrum in words."""
        return self.setting or f"{1e3 * (self.fulcrum or 0.0):g} mm"

    @model_validator(mode="after")
    def _require_foot(self) -> GaitStance:
        if (self.setting is None) == (self.fulcrum is None):
            raise refusal("needs a setting or a fulcrum", "write setting = low or medium or high")
        return self


class GaitStudy(Document):
    """Everything in the description.

    Parameters
    ----------
    persons
        Persons by name.
    trials
        All stances.
    """

    persons: dict[str, GaitPerson]
    trials: Annotated[tuple[GaitStance, ...], Listed("{person}_{number}", doubled)]

    @model_validator(mode="after")
    def _require_persons(self) -> GaitStudy:
        for k, each in enumerate(self.trials):
            if each.person not in self.persons:
                raise refusal(f"no [persons.{each.person}]", f"there are {', '.join(self.persons)}", at=("trials", k))
        return self


def read_gait_study(path: Path) -> GaitStudy:
    """The description; InputError for what is missing or cannot be."""
    return read_document(path, GaitStudy)
