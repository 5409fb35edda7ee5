"""Description of trials of standing up from a chair.

    [person]
    mass = { value = 70, unit = "kg" }
    height = { value = 1.75, unit = "m" }
    segments.shank = { length = { value = 42, unit = "cm" } }

    [noise]
    length = { value = 0.5, unit = "mm" }
    angle = { value = 0.3, unit = "deg" }
    rate = { value = 0.02, unit = "rad/s" }
    force = { value = 2, unit = "N" }
    centre = { value = 1, unit = "mm" }

    [[trials]]
    name = "T1"
    coordinates = "T1_coordinates.sto"
    rates = "T1_rates.sto"
    plates = "T1_plates.mot"
    feet = "feet"
    chair = "chair"

Files are looked for beside the description. With `sitting = true` a trial begins while the person still sits, and the
chair's force is a load on the model. With `exoskeleton = true` a trial also has `torques` and at least one of the
straps, whose force on the person is positive forwards: `time [s], normal [N]`, or the wrench.csv of a mat on a scan, x
forwards. A list of files, such as mats in front and behind, has the sum of their forces. `shear [N]` in the thigh's is
the measured force along it, which is compared with the predicted one.

The person is that of `described_person`; `mass` and `height` may stand outside of `[person]`. Tables such as
`[person.shank]`, whose centres count from the lower joint, are the former spelling.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from geocontact.data.plausible import N_M, PERSON, TALL, N, Plausible
from geocontact.data.text import same_place
from geocontact.data.units import Unit, deg, mm
from geocontact.io.document_errors import refusal
from geocontact.io.documents import Document, File, FileName, Files, Listed, Names, Some, WithUnit, Word, read_document
from geocontact.io.recordings.described_person import OVER_HIPS, OWN, DescribedPerson, Mass

TURNS = Unit("rad/s", "rad/s", 1.0)
NOISE = {
    "length": Plausible("the standard deviation of a place", mm, (1e-4, 1000.0), (0.01, 20.0)),
    "angle": Plausible("the standard deviation of an angle", deg, (1e-5, 180.0), (0.01, 10.0)),
    "rate": Plausible("the standard deviation of a rate", TURNS, (1e-7, 100.0), (1e-4, 1.0)),
    "force": Plausible("the standard deviation of a force", N, (1e-5, 1e4), (0.05, 50.0)),
    "centre": Plausible("the standard deviation of a centre of pressure", mm, (1e-4, 1000.0), (0.05, 50.0)),
    "torque": Plausible("the standard deviation of a torque", N_M, (1e-5, 1e4), (0.01, 50.0)),
    "strap": Plausible("the standard deviation of a strap's force", N, (1e-5, 1e4), (0.05, 50.0)),
    "shear": Plausible("the standard deviation of a strap's shear", N, (1e-5, 1e4), (0.05, 50.0)),
}
"""What the standard deviations of one sample can be: instruments have the lower ends, soft tissue the upper ones."""
Deviation = {name: Annotated[float, WithUnit(known)] for name, known in NOISE.items()}
Time = Annotated[float, WithUnit("s", bare=True)]
Weighed = {
    name: Annotated[float, WithUnit(unit, bare=True), Field(gt=0.0)]
    for name, unit in {
        "torques": "1/(N m)^2",
        "energy": "1/J^2",
        "foot_jerk": "m/s^3",
        "joint_jerk": "rad/s^3",
    }.items()
}
"""What weighs the cost besides the noise, by name."""
Masses = dict.fromkeys(("foot_plate", "shank", "thigh", "module"), Mass)
Damped = {
    name: Annotated[float, WithUnit(unit, bare=True), Field(ge=0.0)]
    for name, unit in {"damping": "N s/m", "turning_damping": "N m s/rad"}.items()
}
Task = Literal["standing up", "sitting down", "squat", "stance"]
Mode = Literal["active", "passive", "off"]


class StandingTrialFiles(Document):
    """A trial as it is described.

    Parameters
    ----------
    name
        Its own for each.
    coordinates, rates
        Joint angles and their rates: .sto or .mot.
    plates
        Force plates.
    torques
        Torques of all joints of both legs: .sto, [N m]; of the exoskeleton also by `motors` or `mode`.
    motors
        Torques of the exoskeleton's motors: .sto, [N m], whose friction `device` has.
    mode
        Active: it helps. Passive, its motors giving nothing, or off: its hinges have friction alone.
    task
        Sitting down ends at seat contact, a squat has no chair, a stance is that of one leg in walking.
    movement
        Which of the recording's movements of this task is used, from 1.
    strap
        Normal force on the thigh: .csv of the mat of one leg, `normal [N]`, or `wrench.csv` of a mat on a scan; with
        load cells or a two-axis mat also `shear [N]`, along the thigh, towards the hip, which is compared only.
    strap_shank, strap_pelvis
        The same of further straps; the pelvis has the force of the whole module.
    feet, chair
        Plates by name or number.
    sitting
        Whether the trial includes what is before seat-off or after seat contact, with the chair's force as a load.
    start, end
        Times between which the trial is used.
    """

    name: FileName
    coordinates: File
    rates: File | None = None
    plates: File | None = None
    torques: File | None = None
    motors: File | None = None
    mode: Mode | None = None
    task: Task = "standing up"
    movement: Annotated[int, Field(ge=1, le=1000)] | None = None
    strap: Files = ()
    strap_shank: Files = ()
    strap_pelvis: Files = ()
    feet: Word | None = None
    chair: Word | None = None
    sitting: bool = False
    start: Time | None = None
    end: Time | None = None

    @property
    def elsewhere(self) -> Mapping[str, tuple[Path, ...]]:
        """Files of the straps besides the thigh's, by site, of those that were recorded."""
        straps = {"shank": self.strap_shank, "pelvis": self.strap_pelvis}
        return {site: files for site, files in straps.items() if files}

    @model_validator(mode="after")
    def _require_chair(self) -> StandingTrialFiles:
        if self.sitting and (self.chair is None or self.plates is None):
            raise refusal("sitting needs the force of a chair", "name plates, with a chair among them")
        if self.task in ("squat", "stance") and self.chair is not None:
            raise refusal(f"a {self.task} has no chair", "leave chair out, or name another task")
        if self.task == "stance" and (self.plates is None or self.movement is not None or self.rates is not None):
            raise refusal("a stance needs plates, and neither movement nor rates", "name its plates, start and end")
        if self.mode == "off" and self.motors is not None:
            raise refusal("motors that are off give no torque", 'leave motors out, or write mode = "passive"')
        if self.movement is not None and (self.start is not None or self.end is not None):
            raise refusal("movement and start or end choose the time twice", "keep one of them")
        return self


class StandingPerson(DescribedPerson):
    """The person.

    Parameters
    ----------
    mass, height
        Of the body, unless they stand outside of this table.
    sex
        Row of de Leva's table.
    age
        From 6 years on; below 18 masses are those of boys.
    segments
        Own values by segment: thigh, shank, foot, and head_arms_trunk.
    foot, shank, thigh, trunk
        Former spelling, from the lower joint.
    """

    mass: Annotated[float, WithUnit(PERSON)] | None = None
    foot: Annotated[Mapping[str, float], Some(OWN)] = {}
    shank: Annotated[Mapping[str, float], Some(OWN)] = {}
    thigh: Annotated[Mapping[str, float], Some(OWN)] = {}
    trunk: Annotated[Mapping[str, float], Some(OWN)] = {}

    @property
    def former(self) -> dict[str, Mapping[str, float]]:
        """Own values in the former spelling, by segment, from the lower joint."""
        given = {"foot": self.foot, "shank": self.shank, "thigh": self.thigh, "trunk": self.trunk}
        return {name: values for name, values in given.items() if values}

    @model_validator(mode="after")
    def _require_one_spelling(self) -> StandingPerson:
        for name in self.former:
            other = OVER_HIPS if name == "trunk" else name
            if self.segments.get(other) is not None:
                what = f"its values stand in segments.{other} as well"
                raise refusal(what, f"keep segments.{other}, which counts from the proximal end", at=(name,))
        return self


class StandingStudy(Document):
    """Everything in the description.

    Parameters
    ----------
    person
        Sex and own values of segments; the men's table by default.
    mass, height
        Of the body; here or in `[person]`.
    exoskeleton
        Whether it was worn.
    device
        Description of the exoskeleton (.toml), such as device.toml of `sit-to-stand device`, or its numbers.csv; the
        shipped exoskeleton by default.
    masses
        Masses of the exoskeleton's bodies, both sides.
    straps
        Dashpots of one strap; the study's 10 N s/m and 0.1 N m s/rad by default.
    weights
        Squared torques in phase A (1e-6 by default), squared energy of the straps in B and C (1e-3), sizes of the jerk
        of foot (20) and joints (60): ours, the study prints none.
    noise
        Standard deviation of one sample; `rate` is that of turns and, in m/s, of the foot's place.
    free
        Names of parameters that are fitted; the usual ones by default.
    tracks
        Names of what the motion follows, `coordinates` among them; all that was recorded by default.
    trials
        All trials.
    """

    person: StandingPerson = StandingPerson()
    mass: Annotated[float, WithUnit(PERSON)]
    height: Annotated[float, WithUnit(TALL)]
    exoskeleton: bool = False
    device: File | None = None
    masses: Annotated[Mapping[str, float], Some(Masses)] = {}
    straps: Annotated[Mapping[str, float], Some(Damped)] = {}
    weights: Annotated[Mapping[str, float], Some(Weighed)] = {}
    noise: Annotated[Mapping[str, float], Some(Deviation)] = {}
    free: Names | None = None
    tracks: Names | None = None
    trials: Annotated[tuple[StandingTrialFiles, ...], Listed("T{number}", same_place)]

    @property
    def one_leg(self) -> bool:
        """Whether its trials are stances of walking."""
        return self.trials[0].task == "stance"

    @model_validator(mode="before")
    @classmethod
    def _take_size(cls, content: object) -> object:
        """Mass and height of `[person]` in the place where the study has them."""
        if not isinstance(content, dict) or "person" not in content:
            return content
        person = content["person"]
        if not isinstance(person, dict):
            raise refusal("is not a table", f"write {', '.join(StandingPerson.by_key())}", at=("person",))
        for key in ("mass", "height"):
            if key in person and key in content:
                raise refusal("stands outside of [person] as well", "keep one of them", at=("person", key))
        return content | {key: person[key] for key in ("mass", "height") if key in person}

    @model_validator(mode="after")
    def _require_worn(self) -> StandingStudy:
        worn = {"device": self.device, "[masses]": self.masses, "[straps]": self.straps}
        worn |= {f"{key} of {each.name}": getattr(each, key) for each in self.trials for key in ("mode", "motors")}
        odd = next((name for name, value in worn.items() if value), None)
        walked = [each.task == "stance" for each in self.trials]
        if any(walked) and (self.exoskeleton or not all(walked)):
            raise refusal(
                "a stance is of one leg, the other trials of both", "calibrate stances in a study of their own"
            )
        if odd is not None and not self.exoskeleton:
            raise refusal(f"{odd} has no effect without an exoskeleton", "write exoskeleton = true, or leave it out")
        return self


def read_standing_study(path: Path) -> StandingStudy:
    """The description; InputError for what is missing or cannot be."""
    return read_document(path, StandingStudy)
