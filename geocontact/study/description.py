"""The description of a study: an analysis, its options, and what the trials differ in.

    analysis = "area"
    files = "data/{subject}/{condition}_{trial}.csv"
    table = "subjects.csv"

    [options]
    moving = "data/{subject}/femur.stl"
    fixed = "data/{subject}/tibia.stl"
    unit = "mm"
    side = "{side}"
    motion = "{file}"

    [vary]
    condition = ["slow", "fast"]

    [sweep]
    threshold = [1, 4]

    [[leave_out]]
    subject = "P3"
    condition = "fast"

Options have the names that they have in run.json or in Python, and values as on the command line. Paths are from
the folder of the description. `{name}` stands for what a trial has under that name: from `files` (one trial for each
file that fits the pattern, `{file}` is its path), from the columns of `table`, from `[vary]` (all combinations).
`[sweep]` names options and gives their values, all combinations. What several of them name must agree. Trials that need
options of their own are listed one by one:

    [[trials]]
    subject = "P1"
    options = { motion = "P1.sto", map = "rz=knee_flexion,ty=knee_ty", angles = "rad" }

Steps before the analysis are analyses too, for each trial, each value of a name (`per = ["subject"]`) or once (`per =
[]`). `{STEP:FILE}` is a file among the results of a step: of the same trial, the same subject, or all of them.

    [steps.scale]
    analysis = "scale"
    per = ["subject"]
    where = { condition = ["static"] }
    options = { model = "generic.osim", markers = "{file}" }

    [steps.ik]
    analysis = "ik"
    options = { model = "{scale:model.osim}", markers = "{file}" }
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, ConfigDict, Field, PlainValidator, PrivateAttr, model_validator

from geocontact.data.errors import InputError
from geocontact.io.document_errors import refusal
from geocontact.io.documents import AnyValue, Document, FileName, Holds, Names, Rows, Text, Value, Values, checked
from geocontact.io.text.toml_text import numbers_in, toml_of
from geocontact.io.text.units import LENGTH
from geocontact.study.cluster import ClusterSettings
from geocontact.study.limits import LimitSettings

LARGEST = 4_000_000
"""Bytes of a description."""
RESERVED = ("name", "file", "state", "folder", "words", "fit", "warnings")
"""Names of columns that every study has, and of what a pattern of files gives."""


def _length_unit(unit: str) -> str:
    if unit not in LENGTH:
        raise refusal(f"{unit!r:.60} is none of length", f"write one of {', '.join(LENGTH)}")
    return unit


def _places(given: object) -> tuple[float, ...]:
    numbers = isinstance(given, list) and all(isinstance(x, int | float) and not isinstance(x, bool) for x in given)
    if not isinstance(given, list) or not numbers or not given or not all(0.0 <= x <= 100.0 for x in given):
        raise refusal(f"{given!r:.60} are not places from 0 to 100 %", example="[0, 50, 100]")
    if len(set(given)) < len(given):
        raise refusal(f"{given!r:.60} has a place twice", example="[0, 50, 100]")
    return tuple(float(x) for x in given)


Places = Annotated[tuple[float, ...], PlainValidator(_places), Holds("list of numbers, 0 to 100")]
"""Places on a curve [%]."""


class SummarySettings(Document):
    """Which curves are compared, and between whom.

    Parameters
    ----------
    table
        Name of the table; the first one over time by default.
    columns
        Columns of numbers with their units; the first few by default.
    over
        Column that a curve is over; its span is 0 to 100 % of the curve.
    where
        Values of columns whose rows make a curve; the first by default.
    subject
        Name of a trial's subject: its trials are averaged first.
    condition
        Name of what is compared.
    """

    table: str = ""
    columns: Names = ()
    over: str = "time [s]"
    where: Mapping[str, AnyValue] = {}
    subject: str = "subject"
    condition: str = "condition"


class SurfaceSettings(Document):
    """Points that correspond from subject to subject.

    Parameters
    ----------
    particles
        Path of a trial's .particles, from the study's folder; may hold `{name}`.
    unit
        Unit of length of these files.
    body
        The body on which they lie.
    at
        Places on the curve [%]; distances are interpolated linearly between frames.
    """

    particles: Annotated[Text, Field(examples=['"{subject}/talus.particles"'])]
    unit: Annotated[str, AfterValidator(_length_unit), Holds("unit of length"), Field(examples=['"mm"'])]
    body: Literal["fixed", "moving"] = "fixed"
    at: Places = (0.0, 25.0, 50.0, 75.0, 100.0)


class ListedTrial(Document):
    """A trial that is listed.

    Parameters
    ----------
    options
        Options of its own, before those of `[options]`.
    NAME
        What the trial has under that name; the same names in every trial.
    """

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, AnyValue]
    options: Mapping[str, Any] = {}

    @property
    def values(self) -> dict[str, Value]:
        """What it has under its names."""
        return self.__pydantic_extra__


class StepSettings(Document):
    """A step before the analysis.

    Parameters
    ----------
    analysis
        As its command is typed.
    options
        By name; texts may hold `{name}`, and `{STEP:FILE}` of an earlier step.
    per
        Names: one evaluation for each combination of their values, `[]` for one over all; by default for each trial.
    where
        Values that its trials have; all trials by default.
    needs
        Files, which may hold `{name}`; without one of them it is left out.
    limits
        What each evaluation may take, where that differs from the study's.
    """

    analysis: Annotated[Text, Field(examples=['"ik"'])]
    options: Mapping[str, Any] = {}
    per: Names | None = None
    where: Mapping[str, Values] = {}
    needs: Names = ()
    limits: LimitSettings = LimitSettings()


class StudyFile(Document):
    """Everything in the description.

    Parameters
    ----------
    analysis
        A command as typed; of several steps the last.
    title
        Heading of the page; the file's name by default.
    options
        Options by name; texts may hold `{name}`.
    files
        Pattern of paths with `{name}`: a trial for each file that fits.
    table
        File with a row for each trial or subject.
    trials
        Trials that are listed one by one.
    vary
        What trials differ in, all combinations.
    sweep
        Options with the values that they take in turn, all combinations.
    leave_out
        Trials that are not evaluated: those that have all of these values.
    steps
        Analyses before it, by name.
    per, where, needs
        As of a step.
    pages, figures
        Whether each trial has them.
    summary
        What the page and the statistics are about.
    surface
        Needs `analysis = "area"` and `save_map = true` in `[options]`.
    limits
        What each trial may take.
    cluster
        Jobs of a queueing system.
    """

    analysis: Annotated[Text, Field(examples=['"area"'])]
    title: str = ""
    files: str = ""
    table: str = ""
    trials: Annotated[tuple[ListedTrial, ...], Rows] = ()
    options: Mapping[str, Any] = {}
    vary: Mapping[str, Values] = {}
    sweep: Mapping[str, Values] = {}
    leave_out: Annotated[tuple[dict[str, AnyValue], ...], Rows] = ()
    steps: dict[FileName, StepSettings] = Field(default_factory=dict)
    per: Names | None = None
    where: Mapping[str, Values] = {}
    needs: Names = ()
    pages: bool = True
    figures: bool = True
    summary: SummarySettings = SummarySettings()
    surface: SurfaceSettings | None = None
    limits: LimitSettings = LimitSettings()
    cluster: ClusterSettings | None = None
    _path: Path = PrivateAttr()
    _folder: Path | None = PrivateAttr(None)

    def model_post_init(self, context: Any) -> None:
        """Take the path of the file."""
        self._path = context

    @property
    def path(self) -> Path:
        """The file."""
        return self._path

    @property
    def home(self) -> Path:
        """Folder that paths in it start from."""
        return self.path.resolve().parent if self._folder is None else self._folder.resolve()

    def within(self, folder: Path | None) -> StudyFile:
        """The same with paths from another folder, where one is named."""
        self._folder = folder
        return self

    @property
    def own(self) -> StepSettings:
        """The analysis as the last step."""
        return StepSettings.model_construct(
            analysis=self.analysis, options=self.options, per=self.per, where=self.where, needs=self.needs
        )

    @property
    def own_name(self) -> str:
        """Name of the analysis as a step: its command with _ for what no name has."""
        return re.sub(r"[^A-Za-z0-9_-]+", "_", self.analysis)

    @property
    def all_steps(self) -> dict[str, StepSettings]:
        """Steps by name, the analysis last."""
        return {**self.steps, self.own_name: self.own}

    def limits_of(self, step: str) -> LimitSettings:
        """What each evaluation of a step may take: what the step states, else what the study does."""
        own = self.all_steps[step].limits
        return self.limits.model_copy(update={name: getattr(own, name) for name in own.model_fields_set})

    @property
    def heading(self) -> str:
        """The title, else the file's name."""
        return self.title or self.path.stem.replace("_", " ")

    @model_validator(mode="after")
    def _require_same_names(self) -> StudyFile:
        for k, trial in enumerate(self.trials):
            differing = {*trial.values} ^ {*self.trials[0].values}
            if differing:
                what = f"{min(differing)!r:.60} is not in all of them"
                raise refusal(what, "give every trial the same names", at=("trials", k))
        return self

    @model_validator(mode="after")
    def _require_a_name(self) -> StudyFile:
        if self.own_name in self.steps:
            what = "has the name of the study's own analysis"
            raise refusal(what, "choose another name", at=("steps", self.own_name, ""))
        return self

    @model_validator(mode="after")
    def _require_distances(self) -> StudyFile:
        if self.surface is not None and not (self.analysis == "area" and self.options.get("save_map")):
            remedy = 'write analysis = "area", and save_map = true in [options]'
            raise refusal("needs the distances of every vertex", remedy, at=("surface", ""))
        return self


def read_study_file(path: Path, folder: Path | None = None) -> StudyFile:
    """The description, with paths from its own folder or from another; InputError for what is missing or cannot be."""
    content: Mapping[str, Any] = toml_of(path, LARGEST)
    for place, value in numbers_in(content):
        if not math.isfinite(value):
            raise InputError(path, place, f"is {value}", "write a number")
    study: StudyFile = checked(path, StudyFile, content)
    return study.within(folder)
