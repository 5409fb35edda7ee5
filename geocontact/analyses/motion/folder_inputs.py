"""What a command takes from a folder as its tool left it: inputs and options of each trial, and what was recognised."""

from __future__ import annotations

import warnings as python_warnings
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import lru_cache
from pathlib import Path

import numpy as np

from geocontact.analyses.frame.words import counted
from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.c3d_plates import read_c3d_plates
from geocontact.io.mocap.markers import read_markers
from geocontact.io.mocap.segment_poses import holds_segments, read_c3d_poses
from geocontact.io.opensim.external_loads import may_hold_loads, read_external_loads
from geocontact.io.opensim.osim_xml import numbers_of, read_model
from geocontact.io.recordings.tool_folder import (
    ADDBIOMECHANICS,
    B3D,
    TRIALS,
    FolderTrial,
    ToolFolder,
    choices,
    read_tool_folder,
)
from geocontact.io.text.tables import listed

PLANAR = "sit-to-stand coordinates"
FIRST = {
    "ik": "markers",
    "scale": "markers",
    "id": "coordinates",
    "markers": "coordinates",
    PLANAR: "coordinates",
}
"""What each command that takes a folder begins with: files of which kind."""
STILL = 0.02
"""m that markers may move away from their mean while somebody stands still, as for `scale`."""
APART = 0.1
"""Share by which masses of the person and of the model differ from which a warning says so; invented. AddBiomechanics
changes masses by up to 8 %."""


@dataclass(frozen=True)
class FolderPart:
    """A file and the part that it plays; `trial` is empty where it is of all trials."""

    part: str
    file: str
    trial: str = ""
    note: str = ""


@dataclass(frozen=True)
class FolderInputs:
    """One trial of a folder.

    Parameters
    ----------
    kind, folder
        Whose folder it is, and where.
    trial
        Its name.
    recording
        File that the command begins with.
    options
        Others by their names, as they are typed.
    parts
        Every file that is used, below the folder.
    unused
        How many others there are.
    warnings
        Doubts about the folder, one line each.
    left_out
        Trials that are not used, though nobody named others, and why.
    """

    kind: str
    folder: Path
    trial: str
    recording: Path
    options: tuple[tuple[str, str], ...]
    parts: tuple[FolderPart, ...]
    unused: int
    warnings: tuple[str, ...]
    left_out: tuple[str, ...] = ()

    def recognised(self) -> dict[str, object]:
        """What `run.json` says of it."""
        said = {"kind": self.kind, "folder": self.folder.as_posix(), "trial": self.trial}
        parts, doubts = [asdict(p) for p in self.parts], {"warnings": [*self.warnings], "left_out": [*self.left_out]}
        return {**said, "parts": parts, "unused_files": self.unused, **doubts}

    def table(self) -> list[str]:
        """Lines that say which file plays which part."""
        wide, wider = (max(map(len, texts)) for texts in ([p.part for p in self.parts], [p.file for p in self.parts]))
        rows = [f"  {p.part.ljust(wide)}  {p.file.ljust(wider)}  {p.note}".rstrip() for p in self.parts]
        others = [f"  trial left out: {each}" for each in self.left_out]
        others.append(f"  {counted(self.unused, 'other file')} not used")
        return [f"{self.folder}: {self.kind}, trial {self.trial}", *rows, *others]


@dataclass(frozen=True)
class ChosenTrials:
    """Trials that are used, doubts about them, and those left out with the reason."""

    trials: list[FolderTrial]
    notes: list[str] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)


def folder_inputs(
    command: str,
    path: Path,
    wanted: Sequence[str] = (),
    typed: frozenset[str] = frozenset(),
    c3d_unit: str | None = None,
) -> list[FolderInputs]:
    """Inputs of the trials that are wanted, of all that a command can use by default; of `scale` one static trial.

    Parameters
    ----------
    wanted
        Names of trials.
    typed
        Options that the user gives, which nothing of the folder replaces.
    c3d_unit
        Unit of .c3d files whose own is empty.
    """
    if path.suffix.lower() == ".b3d":
        raise InputError(path, "", "is AddBiomechanics' own format", B3D)
    folder = read_tool_folder(path)
    choice = _chosen(command, folder, wanted, c3d_unit)
    _refuse_shared(folder, choice.trials, typed)
    found = []
    for trial in choice.trials:
        options, warnings = _options(command, folder, trial, typed)
        recording = _recording(command, folder, trial)
        parts = _parts(command, folder, trial, recording, options)
        said, given = (*choice.notes, *warnings), tuple(options.items())
        out = tuple(choice.left_out)
        found.append(FolderInputs(folder.kind, path, trial.name, recording, given, parts, folder.unused, said, out))
    return found


def _refuse_shared(folder: ToolFolder, trials: Sequence[FolderTrial], typed: frozenset[str]) -> None:
    """InputError where loads that are typed, which were recorded once, or the name of a recording are for several."""
    once = sorted({"loads", "plates", "bids"} & typed)
    if once and len(trials) > 1:
        names = listed(tuple(t.name for t in trials))
        raise InputError(folder.root, f"`{once[0]}`", f"is of one trial, and there are {names}", "choose with `trial`")


def _recording(command: str, folder: ToolFolder, trial: FolderTrial) -> Path:
    """The file of a trial that the command begins with; InputError where there is none."""
    file = trial.markers if FIRST[command] == "markers" else trial.coordinates
    if file is None:
        raise InputError(folder.root, "", f"trial '{trial.name}' has no {FIRST[command]}", REMEDIES[FIRST[command]])
    rival = trial.rival if FIRST[command] == "markers" else trial.rival_motion
    if rival is not None and (FIRST[command] == "markers" or not may_hold_loads(rival)):
        remedy = "name the file that is meant, or leave one of them there"
        raise InputError(folder.root, "", f"{file.name} and {rival.name} are of one trial", remedy)
    return file


REMEDIES = {"coordinates": "compute them first: geocontact ik", "markers": "is the folder complete?"}


def _chosen(command: str, folder: ToolFolder, wanted: Sequence[str], c3d_unit: str | None) -> ChosenTrials:
    """Trials with the file that the command begins with; the static ones for `scale` only, unless they are named."""
    first = FIRST[command]
    strange = [name for name in wanted if name not in [t.name for t in folder.trials]]
    if strange:
        raise InputError(folder.root, "`trial`", f"no trial '{strange[0]}'", f"there are {choices(folder)}")
    if wanted:
        chosen = [t for t in folder.trials if t.name in wanted]
        for trial in chosen:
            _recording(command, folder, trial)
        return ChosenTrials(chosen)
    there = [t for t in folder.trials if (t.markers if first == "markers" else t.coordinates) is not None]
    if not there:
        raise InputError(folder.root, "", f"no trial has {first}", REMEDIES[first])
    found = ChosenTrials(there, left_out=[f"{t.name} (no {first})" for t in folder.trials if t not in there])
    usable, still = _readable(command, folder, found, c3d_unit)
    standing = [t for t in usable if t.static]
    if folder.kind == TRIALS and first == "markers":
        standing = _standing(usable, still, found.notes)
    if command == "scale":
        if len(standing) != 1:
            names = f": {listed(tuple(t.name for t in standing))}" if standing else ""
            what = "; ".join([f"{len(standing)} trials are static{names}", *found.notes])
            raise InputError(folder.root, "", what, f"say which one with `trial`: {choices(folder)}")
        moving = [f"{t.name} (not static)" for t in usable if t not in standing]
        return ChosenTrials(standing, found.notes, found.left_out + moving)
    rest = [t for t in usable if t not in standing]
    stood = [f"{t.name} (static{' by its name' if t.static else ''})" for t in standing] if rest else []
    return ChosenTrials(rest or usable, found.notes, found.left_out + stood)


def _readable(
    command: str, folder: ToolFolder, found: ChosenTrials, c3d_unit: str | None
) -> tuple[list[FolderTrial], list[FolderTrial]]:
    """Trials of one file that the command begins with, where markers can be read, and a laboratory's that stand still.

    Others are left out with a note; InputError where none can be read.
    """
    refusals: dict[str, InputError] = {}
    still = []
    for trial in found.trials:
        try:
            file = _recording(command, folder, trial)
            if folder.kind == TRIALS and FIRST[command] == "markers":
                now = file.stat()
                still += [trial] if _stood(command, file, c3d_unit, now.st_mtime_ns, now.st_size) else []
        except InputError as error:
            refusals[trial.name] = error
    if len(refusals) == len(found.trials):
        raise next(iter(refusals.values()))
    found.notes.extend(f"trial {name} is left out: {error}" for name, error in refusals.items())
    return [t for t in found.trials if t.name not in refusals], still


@lru_cache(maxsize=1000)
def _stood(command: str, file: Path, c3d_unit: str | None, _changed: int, _size: int) -> bool:
    """Whether markers of a file stand still; read once, since a form asks after each key."""
    return _stands_still(_read(command, file, c3d_unit))


def _read(command: str, file: Path, c3d_unit: str | None) -> MarkerTrajectories:
    """Markers, or for `ik` origins of segments, without the warnings that the command itself gives."""
    with python_warnings.catch_warnings():
        python_warnings.simplefilter("ignore", InputWarning)
        if command == "ik" and holds_segments(file):
            seen = read_c3d_poses(file, c3d_unit)
            if seen.origins is not None:
                places = np.where(seen.there[..., None], seen.origins, np.nan)
                return MarkerTrajectories(seen.time, places, seen.names, seen.source)
        return read_markers(file, c3d_unit)


def _standing(usable: list[FolderTrial], still: list[FolderTrial], notes: list[str]) -> list[FolderTrial]:
    """Static trials of a laboratory by name, else by standing still; where both differ a note says so."""
    named = [t for t in usable if t.static]
    moved = f"its name says static, and its markers move by more than {1e3 * STILL:.0f} mm"
    notes += [f"{t.name}: {moved}" for t in named if t not in still]
    unnamed = [t for t in still if t not in named]
    if named:
        notes += [f"{t.name}: its markers stand still, and its name does not say static" for t in unnamed]
        return named
    if unnamed:
        notes.append(f"{unnamed[0].name} is taken as the static trial: its markers stand still, no name says static")
    return unnamed


def _stands_still(seen: MarkerTrajectories) -> bool:
    """Whether 95 % of all places are within `STILL` of the mean of their marker."""
    there = np.isfinite(seen.positions).all(axis=2).any(axis=0)
    places = seen.positions[:, there]
    off = np.linalg.norm(places - np.nanmean(places, axis=0), axis=2)
    return bool(np.nanquantile(off, 0.95) <= STILL)


def _options(
    command: str, folder: ToolFolder, trial: FolderTrial, typed: frozenset[str]
) -> tuple[dict[str, str], list[str]]:
    """Options of one trial that are not typed, and warnings."""
    found: dict[str, str] = {}
    warnings: list[str] = []
    if "model" not in typed:
        model = _generic(folder) if command == "scale" else _model(folder, trial)
        found["model"] = str(model)
        if command != "scale":
            warnings += _of_mass(folder, model)
    if command == "scale" and "mass" not in typed and folder.person is not None and folder.person.mass is not None:
        found["mass"] = repr(folder.person.mass)
    if command == "ik" and "calibration" not in typed:
        warnings += _of_the_calibration(folder, trial, found)
    if command in ("id", PLANAR) and trial.rival_loads and not {"loads", "plates"} & typed:
        names = " and ".join(file.name for file in trial.rival_loads)
        raise InputError(folder.root, "", f"{names} are loads of one trial", "leave one there, or name it with `loads`")
    if command == PLANAR:
        warnings += _of_the_plane(folder, trial, typed, found)
    if command == "id" and not {"loads", "plates"} & typed:
        _refuse_unused_plates(trial)
        if trial.loads is not None:
            found["loads"] = str(trial.loads)
        else:
            what = f"no ground reaction belongs to {trial.name}: nothing but gravity acts{_perhaps(folder)}"
            warnings.append(f"{folder.kind}: {what}")
    return found, warnings


def _of_the_calibration(folder: ToolFolder, trial: FolderTrial, found: dict[str, str]) -> list[str]:
    """Puts the static trial, by its name, into `found` where a trial holds segments; a warning where there are more."""
    if trial.markers is None or not holds_segments(trial.markers):
        return []
    static = [t for t in folder.trials if t.static and t != trial and t.markers and holds_segments(t.markers)]
    if len(static) > 1:
        return [f"{listed(tuple(t.name for t in static))} are static: say with `calibration` where the person stands"]
    if static:
        found["calibration"] = str(static[0].markers)
    return []


def _of_the_plane(folder: ToolFolder, trial: FolderTrial, typed: frozenset[str], found: dict[str, str]) -> list[str]:
    """Puts the person's height and the trial's plates into `found`, where they are not typed; warnings."""
    if "height" not in typed and folder.person is not None and folder.person.height is not None:
        found["height"] = repr(folder.person.height)
    if "plates" in typed:
        return []
    if trial.loads is None:
        alone = f"no plates belong to {trial.name}: its study follows coordinates alone; else `plates`"
        return [f"{folder.kind}: {alone}{_perhaps(folder, trial.forces)}"]
    found["plates"] = str(read_external_loads(trial.loads)[0])
    return []


def _perhaps(folder: ToolFolder, forces: tuple[Path, ...] = ()) -> str:
    """Files that may hold what acts on a trial, by what they hold, for the end of a warning."""
    names = tuple(f.name for f in (*forces, *filter(may_hold_loads, folder.unclaimed)))
    return f"; perhaps in {listed(names)} (`loads` for .xml, `plates` for .mot)" if names else ""


def _refuse_unused_plates(trial: FolderTrial) -> None:
    """InputError where the trial has forces of the ground, of which the folder does not say what stands there."""
    if trial.loads is not None:
        return
    if trial.forces:
        what = "holds forces of the ground, and the folder does not say on which bodies they act"
        remedy = (
            f"give `loads` (OpenSim's .xml), or `plates` {' or '.join(map(str, trial.forces))} `plate` NAME=calcn_r"
        )
        raise InputError(trial.forces[0], "", what, remedy)
    if trial.markers is None or trial.markers.suffix.lower() != ".c3d":
        return
    count = sum(name.startswith("force_") for name in read_c3d_plates(trial.markers))
    if count:
        what = f"holds {counted(count, 'force plate')}, and the folder does not say which body stands on them"
        remedy = f"give `plates` {trial.markers} `plate` 1=calcn_r, or name the .mot file in place of the folder"
        raise InputError(trial.markers, "", what, remedy)


def _model(folder: ToolFolder, trial: FolderTrial) -> Path:
    """The person's model; InputError where there is none, or more than one."""
    known = (trial.model,) if trial.model is not None else folder.models
    if len(known) != 1:
        what = "holds no model of the person" if not known else f"holds {len(known)} models"
        names = "" if not known else f": {listed(tuple(f.name for f in known))}"
        raise InputError(folder.root, "", f"{what}{names}", "name it with `model`")
    return known[0]


def _generic(folder: ToolFolder) -> Path:
    if folder.generic:
        return folder.generic[0]
    if folder.kind == TRIALS and len(folder.models) == 1:
        return folder.models[0]
    what = "holds no generic model to scale" if folder.kind != TRIALS else f"holds {len(folder.models)} models"
    raise InputError(folder.root, "", what, "name a generic model with `model`")


def _of_mass(folder: ToolFolder, model: Path) -> list[str]:
    """A warning where the model weighs something else than the person."""
    person = folder.person
    if person is None or person.mass is None:
        return []
    bodies = read_model(model).findall("BodySet/objects/Body")
    mass = sum(float(numbers_of(str(model), body, "mass", 1, (0.0,))[0]) for body in bodies)
    if abs(mass - person.mass) <= APART * person.mass:
        return []
    return [f"{model.name} weighs {mass:.4g} kg, the person {person.mass:.4g} kg ({person.file.name}): is it scaled?"]


def _parts(
    command: str, folder: ToolFolder, trial: FolderTrial, recording: Path, options: Mapping[str, str]
) -> tuple[FolderPart, ...]:
    """Every file that is used and its part; one outside of the folder by its own path."""

    def part(name: str, file: str | Path, of: str = "", note: str = "") -> FolderPart:
        path = Path(file)
        below = path.relative_to(folder.root) if path.is_relative_to(folder.root) else path
        return FolderPart(name, below.as_posix(), of, note)

    rows = [part("static trial" if command == "scale" else FIRST[command], recording, trial.name, trial.note)]
    if "model" in options:
        fitted = folder.kind == ADDBIOMECHANICS and command != "scale"
        rows.append(part("model", options["model"], note="of the last step of the fit" if fitted else ""))
    if "calibration" in options:
        rows.append(part("calibration", options["calibration"]))
    if "plates" in options and Path(options["plates"]).is_relative_to(folder.root):
        rows.append(part("plates", options["plates"], trial.name))
    if "loads" in options:
        rows.append(part("loads", options["loads"], trial.name))
    if folder.person is not None:
        rows.append(part("person", folder.person.file, note=folder.person.words))
    return tuple(rows)
