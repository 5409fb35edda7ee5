"""The one list of analyses: commands, names in Python, jobs of studies and of tests are made from it.

A new analysis is a folder with `options.py` and `result.py` and one line here; `python -m website.stubs` then writes
its name into the stubs that type checkers and editors read. Nothing heavy is imported before an analysis is asked for.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from importlib import import_module
from types import ModuleType
from typing import Any

from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.options import Options
from geocontact.data.errors import InputError

HOME = "geocontact.analyses"


@dataclass(frozen=True)
class Group:
    """A group of commands.

    Parameters
    ----------
    name
        As it is typed.
    room
        Package below `geocontact.analyses` whose names its analyses have in Python: `gc.ROOM.NAME`; without one they
        are `gc.NAME`.
    help
        What its commands are for.
    """

    name: str
    room: str
    help: str


@dataclass(frozen=True)
class Entry:
    """One analysis.

    Parameters
    ----------
    command
        As it is typed; "" for what Python alone has.
    folder
        Its package, below `geocontact.analyses` unless it begins with `geocontact`.
    options
        Class of its options, in the module `options` of the folder; its help says what the command writes.
    job
        Module of the folder, and name in it: "result:identify". The name is that in Python.
    also
        Former name of the command, which goes on to work.
    many
        The job that the command runs where the option `many` is given.
    exported
        Whether Python has it as `gc.NAME`.
    """

    command: str
    folder: str
    options: str
    job: str
    also: str = ""
    many: str = ""
    exported: bool = True

    @property
    def package(self) -> str:
        """The folder as a package."""
        return self.folder if self.folder.startswith("geocontact.") else f"{HOME}.{self.folder}"

    @property
    def module(self) -> str:
        """Where the job is made."""
        return f"{self.package}.{self.job.partition(':')[0]}"

    @property
    def name(self) -> str:
        """Name of the job in its module."""
        return self.job.partition(":")[2]

    @property
    def group(self) -> Group | None:
        """Group of its command, None where it stands by itself."""
        word, space, _ = self.command.partition(" ")
        return next(each for each in GROUPS if each.name == word) if space else None

    @property
    def room(self) -> str:
        """Package below `geocontact.analyses` that has its name in Python; "" where `geocontact` itself has it."""
        return self.group.room if self.group is not None else ""

    @property
    def of_trials(self) -> bool:
        """Whether it can be the analysis of a study: a study cannot."""
        return bool(self.command) and self.package.startswith(f"{HOME}.")

    def calls(self, words: Sequence[str]) -> bool:
        """Whether words that are typed call it, by its command or the former one."""
        *group, last = self.command.split() or [""]
        count = len(group) + 1
        return bool(last) and list(words[:count]) in ([*group, last], [*group, self.also])

    def load_options(self) -> type[Options]:
        """Class of its options, which is light."""
        found: type[Options] = getattr(import_module(f"{self.package}.options"), self.options)
        return found

    def load_job(self, many: bool = False) -> Job[Any, Any]:
        """The job, or that for many, with all that computes it."""
        module, _, name = (self.many if many else self.job).partition(":")
        found: Job[Any, Any] = getattr(import_module(f"{self.package}.{module}"), name)
        return found


GROUPS = (
    Group("elbow", "misalignment", "Constraint forces of an exoskeleton whose axis is not the joint's."),
    Group(
        "gap", "", "Where a model misses the measurement, which effect it lacks, and how far the gap shrinks with it."
    ),
    Group("knee", "knee", "Knee implant under load: where it comes to rest, pressures and forces of its sides."),
    Group(
        "prosthesis",
        "prosthesis",
        "Below-knee prosthesis with a variable-stiffness foot: scale, calibrate, simulate and choose one; its keel.",
    ),
    Group(
        "shoulder", "shoulder", "Shoulder exoskeleton driven by human motion: its arms, forces in its cuffs, support."
    ),
    Group(
        "sit-to-stand",
        "sit_to_stand",
        "Standing up from a chair: contacts calibrated, trials predicted, a device chosen.",
    ),
)

ENTRIES = (
    Entry("area", "area", "AreaOptions", "result:area"),
    Entry("", "area", "PressureOptions", "result:pressure"),
    Entry("pairs", "area.pairs", "PairsOptions", "result:area_pairs"),
    Entry("settle-pairs", "area.pairs", "SettlePairsOptions", "rest:settle_pairs"),
    Entry("cohort", "geocontact.study", "CohortOptions", "result:cohort"),
    Entry("cop", "cop", "CopOptions", "result:centre_of_pressure"),
    Entry("elbow simulate", "misalignment.simulate", "SimulateOptions", "result:simulate"),
    Entry("elbow fit", "misalignment.identify", "IdentifyOptions", "result:identify"),
    Entry("elbow compare", "misalignment.compare", "CompareOptions", "result:compare"),
    Entry("elbow design", "misalignment.design", "DesignOptions", "result:design"),
    Entry("elbow population", "misalignment.population", "PopulationOptions", "result:population"),
    Entry("fit", "shape", "ShapeOptions", "result:fit_shape"),
    Entry("gap diagnose", "gap.diagnose", "ManyOptions", "result:diagnose", many="many:diagnose_many"),
    Entry(
        "gap discriminability", "gap.discriminability", "DiscriminabilityOptions", "result:discriminability", "confuse"
    ),
    Entry("gap gather", "gap.gather", "GatherOptions", "result:gather"),
    Entry("gap init", "gap.init", "InitOptions", "result:init_gap_case"),
    Entry("gap inject", "gap.inject", "InjectOptions", "result:inject", "plant"),
    Entry("gap benchmark", "gap.benchmark", "BenchmarkOptions", "result:benchmark", exported=False),
    Entry("id", "motion.inverse_dynamics", "IdOptions", "result:inverse_dynamics"),
    Entry("ik", "motion.inverse_kinematics", "IkOptions", "result:inverse_kinematics"),
    Entry("joint", "motion.functional_joint", "JointOptions", "result:functional_joint"),
    Entry("knee settle", "knee.settle", "SettleOptions", "result:settle"),
    Entry("loadcells", "loadcells", "LoadcellOptions", "result:load_cells"),
    Entry("markers", "motion.virtual_markers", "MarkersOptions", "result:virtual_markers"),
    Entry("mat", "mat", "MatOptions", "result:mat"),
    Entry("modulus", "modulus", "ModulusOptions", "result:modulus"),
    Entry("prosthesis calibrate", "prosthesis.calibrate", "ProsthesisCalibrateOptions", "result:calibrate"),
    Entry("prosthesis compare", "prosthesis.compare", "ProsthesisCompareOptions", "result:compare"),
    Entry("prosthesis design", "prosthesis.design", "ProsthesisDesignOptions", "result:design"),
    Entry("prosthesis keel", "prosthesis.keel", "ProsthesisKeelOptions", "result:keel"),
    Entry("prosthesis scale", "prosthesis.scale", "ProsthesisScaleOptions", "result:scale"),
    Entry("prosthesis simulate", "prosthesis.simulate", "ProsthesisSimulateOptions", "result:simulate"),
    Entry("prosthesis walk", "prosthesis.walk", "ProsthesisWalkOptions", "result:walk"),
    Entry("scale", "motion.scale", "ScaleOptions", "result:scale"),
    Entry("shoulder simulate", "shoulder.simulate", "ShoulderSimulateOptions", "result:simulate"),
    Entry("shoulder compare", "shoulder.compare", "ShoulderCompareOptions", "result:compare"),
    Entry("shoulder study", "shoulder.study", "StudyOptions", "result:study"),
    Entry("shoulder optimise", "shoulder.optimise", "ShoulderOptimiseOptions", "result:optimise"),
    Entry("sit-to-stand calibrate", "sit_to_stand.calibrate", "StandingCalibrateOptions", "result:calibrate"),
    Entry("sit-to-stand predict", "sit_to_stand.predict", "StandingPredictOptions", "result:predict"),
    Entry("sit-to-stand design", "sit_to_stand.design", "StandingDesignOptions", "result:design"),
    Entry("sit-to-stand compare", "sit_to_stand.compare", "StandingCompareOptions", "result:compare"),
    Entry("sit-to-stand coordinates", "sit_to_stand.coordinates", "StandingCoordinatesOptions", "result:coordinates"),
    Entry("sit-to-stand movements", "sit_to_stand.movements", "StandingMovementsOptions", "result:movements"),
    Entry("sit-to-stand device", "sit_to_stand.device", "StandingDeviceOptions", "result:device"),
    Entry("thickness", "thickness", "ThicknessOptions", "result:thickness"),
)
"""In the order in which a group lists its commands."""


def names_of_room(room: str) -> list[str]:
    """What Python calls the analyses of a room, in order of the alphabet; "" for those of `geocontact` itself."""
    return sorted(each.name for each in ENTRIES if each.exported and each.room == room)


def entry_of(command: str) -> Entry:
    """The analysis of a command; KeyError where there is none of that name."""
    return {each.command: each for each in ENTRIES if each.command}[command]


def job_named(name: str) -> Job[Any, Any]:
    """The analysis of a study by the name of its command, an own one by where it is: "package.module:OBJECT".

    InputError where there is none of that name.
    """
    if ":" in name:
        return _own(name)
    names = sorted(each.command for each in ENTRIES if each.of_trials)
    if name not in names:
        near = get_close_matches(name, names, n=1)
        remedy = f"did you mean {near[0]!r}?" if near else f"there are {', '.join(names)}"
        raise InputError("", "", f"there is no analysis {name!r}", remedy)
    return entry_of(name).load_job()


def _own(name: str) -> Job[Any, Any]:
    """An analysis of somebody else's module, which is imported."""
    place, _, attribute = name.partition(":")
    try:
        found = getattr(import_module(place), attribute)
    except (ImportError, AttributeError, ValueError) as error:
        what = f"no analysis at {name!r} ({type(error).__name__}: {error})"
        raise InputError("", "", what, "put its folder into PYTHONPATH, on the workers too") from error
    if not isinstance(found, Job):
        raise InputError("", "", f"{name!r} is a {type(found).__name__}", "name a geocontact.analyses.frame.job.Job")
    return found


class Room(ModuleType):
    """Class of a package whose names in Python are its analyses, and not the sub-packages of the same names."""

    __all__: list[str]

    def __getattribute__(self, name: str) -> Any:
        known = super().__getattribute__
        if name in known("__dict__").get("__all__", ()):  # importing a sub-package sets an attribute of its name
            room = known("__name__").removeprefix(f"{HOME}.")
            return next(each for each in ENTRIES if (each.room, each.name) == (room, name)).load_job()
        return known(name)

    def __dir__(self) -> list[str]:
        return sorted({*(name for name in super().__dir__() if name.startswith("__")), *self.__all__})


def make_room(package: str) -> None:
    """Give a package, named by itself, the names of its analyses."""
    room = sys.modules[package]
    room.__dict__["__all__"] = names_of_room(package.removeprefix(f"{HOME}."))
    room.__class__ = Room
