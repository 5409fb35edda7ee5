"""Description of a study of overhead work: tasks, persons, and which trial is whose.

    [tasks.T1]
    tool = { value = 1.3, unit = "kg" }
    push = { value = 35, unit = "N" }
    dominant_share = 1.0

    [persons.P1]
    mass = { value = 82, unit = "kg" }
    sex = "male"
    dominant = "right"
    upper_arm = { value = 296, unit = "mm" }

    [[trials]]
    name = "P1T1S0"
    person = "P1"
    task = "T1"
    markers = "P1T1S0/markers.trc"
    tool = "P1T1S0/tool.csv"
    upright = [0.0, 0.5]

    [[trials]]
    name = "P1T1S100"
    person = "P1"
    task = "T1"
    markers = "P1T1S100/markers.trc"
    tool = "P1T1S100/tool.csv"
    level = "100%"
    recorded = "P1T1S100/recorded.csv"
    recorded_other = "P1T1S100/recorded_other.csv"
    without = "P1T1S0"

Files are looked for beside the description. A trial with a `level` was recorded in the device: logger and mat of the
dominant arm are in `recorded`, those of the other arm in `recorded_other`, and `without` names the same work without
the device. What tells no more than these may be left out: `dominant_share`, lengths of the person, `name`, `upright`,
`level`, `recorded`, `recorded_other`, `without`. A person may have `age`, `height` and own values of `segments`
(`described_person`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, PlainValidator, model_validator

from geocontact.data.body_segments import Sex
from geocontact.data.plausible import KG, PERSON, N, Plausible
from geocontact.io.document_errors import refusal
from geocontact.io.documents import Document, File, Holds, Listed, WithUnit, Word, doubled, read_document
from geocontact.io.recordings.described_person import DescribedPerson
from geocontact.io.recordings.shoulder_device import OF_PERSON

TOOL = Plausible("the mass of a tool in the hands of a person", KG, (0.0, 100.0), (0.05, 10.0), or_zero=True)
PUSH = Plausible("the force of a person on the work", N, (0.0, 2000.0), (5.0, 400.0), or_zero=True)
LENGTHS = ("upper_arm", "shoulder_width", "torso")
"""Lengths of a person, to which a device is adjusted."""
SAME_ARM = 0.1
"""Share by which two lengths of one upper arm may differ."""
Length = Annotated[float, WithUnit(OF_PERSON)]


def _span(value: Any) -> tuple[float, float]:
    numbers = isinstance(value, list) and all(type(each) in (int, float) and math.isfinite(each) for each in value)
    if not numbers or len(value) != 2:
        raise refusal(f"{value!r:.60} is not a span", "write [first, last] in s")
    return float(value[0]), float(value[1])


UPWARDS = 0.0, 1.0, 0.0
"""Direction of a push that nothing is said of."""


def _direction(value: Any) -> tuple[float, float, float]:
    numbers = isinstance(value, list) and all(type(each) in (int, float) and math.isfinite(each) for each in value)
    if not numbers or len(value) != 3 or not any(value):
        raise refusal(f"{value!r:.60} is not a direction", "write [x, y, z], for example [0, 1, 0] for upwards")
    x, y, z = map(float, value)
    return x, y, z


class StudyTask(Document):
    """Work with a tool.

    Parameters
    ----------
    tool
        Mass of the tool.
    push
        Force on the work while the tool runs.
    push_direction
        Its direction in the markers' axes; upwards by default.
    dominant_share
        Part of it that the dominant hand exerts; `optimise` only, which has an option for it.
    """

    tool: Annotated[float, WithUnit(TOOL)]
    push: Annotated[float, WithUnit(PUSH)]
    push_direction: Annotated[tuple[float, float, float], PlainValidator(_direction), Holds("[x, y, z]")] = UPWARDS
    dominant_share: Annotated[float, Field(ge=0.0, le=1.0)] | None = None


class StudyPerson(DescribedPerson):
    """A person.

    Parameters
    ----------
    mass
        Body mass.
    sex
        Which segments of de Leva.
    age
        From 6 years on; below 18 masses are those of boys.
    height
        Body height, for lengths beside own values.
    segments
        Own values by segment; `optimise` only, as `age`: the arm's are used.
    dominant
        Side of the dominant hand.
    upper_arm
        Shoulder to elbow.
    shoulder_width
        Between both acromia.
    torso
        Shoulder bar above the hips.
    """

    mass: Annotated[float, WithUnit(PERSON)]
    sex: Sex
    dominant: Literal["right", "left"]
    upper_arm: Length | None = None
    shoulder_width: Length | None = None
    torso: Length | None = None

    @property
    def lengths(self) -> Mapping[str, float]:
        """Those of `LENGTHS` that are known [m]."""
        return {name: value for name in LENGTHS if (value := getattr(self, name)) is not None}

    @model_validator(mode="after")
    def _require_one_arm(self) -> StudyPerson:
        own = self.segments.get("upper_arm")
        length = None if own is None else own.length
        if self.upper_arm is not None and length is not None and abs(length / self.upper_arm - 1.0) > SAME_ARM:
            what = f"upper_arm is {self.upper_arm:.3g} m, the length of segments.upper_arm {length:.3g} m"
            raise refusal(what, "both are from shoulder to elbow: keep one")
        return self


class StudyTrial(Document):
    """A trial as it is described.

    Parameters
    ----------
    name
        Its own for each.
    person, task
        Names from the tables above.
    markers
        Recorded markers: .trc, .c3d or .csv.
    tool
        Table with `event [-]`, 0 or 1, or `current [A]`.
    push
        Measured force on the work, in place of the task's: table with `fx [N], fy [N], fz [N]` in the markers' axes;
        `optimise` only.
    upright
        A span of upright stance.
    level
        Support level as it is written, "100%" or 0.5; without it the device was not worn.
    recorded, recorded_other
        Logger and mat, on the dominant side and on the other: tables with `elevation [deg]`, `force [N]` or both.
    without
        Name of the trial of the same work without the device.
    """

    name: Word
    person: Word
    task: Word
    markers: File
    tool: File
    push: File | None = None
    upright: Annotated[tuple[float, float], PlainValidator(_span), Holds("[first, last] in s")] | None = None
    level: Word | None = None
    recorded: File | None = None
    recorded_other: File | None = None
    without: Word | None = None


class OverheadStudy(Document):
    """Everything in the description.

    Parameters
    ----------
    tasks, persons
        Tasks and persons by name.
    trials
        All trials.
    """

    tasks: dict[str, StudyTask]
    persons: dict[str, StudyPerson]
    trials: Annotated[tuple[StudyTrial, ...], Listed("{person}{task}", doubled)]

    @model_validator(mode="after")
    def _require_named(self) -> OverheadStudy:
        names = [each.name for each in self.trials]
        for k, each in enumerate(self.trials):
            if each.person not in self.persons:
                raise refusal(f"no [persons.{each.person}]", f"there are {', '.join(self.persons)}", at=("trials", k))
            if each.task not in self.tasks:
                raise refusal(f"no [tasks.{each.task}]", f"there are {', '.join(self.tasks)}", at=("trials", k))
            if each.without is not None and each.without not in names:
                what = f"no trial {each.without!r}"
                raise refusal(what, f"there are {', '.join(names)}", at=("trials", k, "without"))
        return self


def read_overhead_study(path: Path) -> OverheadStudy:
    """The description; InputError for what is missing or cannot be."""
    return read_document(path, OverheadStudy)
