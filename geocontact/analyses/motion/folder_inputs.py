"""What a command takes from a folder as its tool left it: inputs and options of each trial, and what was recognised."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from geocontact.analyses.frame.words import counted
from geocontact.data.errors import InputError
from geocontact.io.mocap.markers import read_markers
from geocontact.io.opensim.external_loads import read_external_loads
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
    """

    kind: str
    folder: Path
    trial: str
    recording: Path
    options: tuple[tuple[str, str], ...]
    parts: tuple[FolderPart, ...]
    unused: int
    warnings: tuple[str, ...]

    def recognised(self) -> dict[str, object]:
        """What `run.json` says of it."""
        said = {"kind": self.kind, "folder": self.folder.as_posix(), "trial": self.trial}
        parts = [asdict(part) for part in self.parts]
        return {**said, "parts": parts, "unused_files": self.unused, "warnings": list(self.warnings)}

    def table(self) -> list[str]:
        """Lines that say which file plays which part."""
        wide, wider = (max(map(len, texts)) for texts in ([p.part for p in self.parts], [p.file for p in self.parts]))
        rows = [f"  {p.part.ljust(wide)}  {p.file.ljust(wider)}  {p.note}".rstrip() for p in self.parts]
        others = counted(self.unused, "other file")
        return [f"{self.folder}: {self.kind}, trial {self.trial}", *rows, f"  {others} not used"]


def folder_inputs(
    command: str, path: Path, wanted: Sequence[str] = (), typed: frozenset[str] = frozenset()
) -> list[FolderInputs]:
    """Inputs of the trials that are wanted, of all that a command can use by default; of `scale` one static trial.

    Parameters
    ----------
    wanted
        Names of trials.
    typed
        Options that the user gives, which nothing of the folder replaces.
    """
    if path.suffix.lower() == ".b3d":
        raise InputError(path, "", "is AddBiomechanics' own format", B3D)
    folder = read_tool_folder(path)
    notes: list[str] = []
    found = []
    for trial in _chosen(command, folder, wanted, notes):
        options, warnings = _options(command, folder, trial, typed)
        recording = _recording(command, folder, trial)
        parts = _parts(command, folder, trial, recording, options)
        said = (*notes, *warnings)
        given = tuple(options.items())
        found.append(FolderInputs(folder.kind, path, trial.name, recording, given, parts, folder.unused, said))
    return found


def _recording(command: str, folder: ToolFolder, trial: FolderTrial) -> Path:
    """The file of a trial that the command begins with; InputError where there is none."""
    file = trial.markers if FIRST[command] == "markers" else trial.coordinates
    if file is None:
        raise InputError(folder.root, "", f"trial '{trial.name}' has no {FIRST[command]}", REMEDIES[FIRST[command]])
    return file


REMEDIES = {"coordinates": "compute them first: geocontact ik", "markers": "is the folder complete?"}


def _chosen(command: str, folder: ToolFolder, wanted: Sequence[str], notes: list[str]) -> list[FolderTrial]:
    """Trials with the file that the command begins with; the static ones for `scale` only, unless they are named."""
    first = FIRST[command]
    usable = [t for t in folder.trials if (t.markers if first == "markers" else t.coordinates) is not None]
    strange = [name for name in wanted if name not in [t.name for t in folder.trials]]
    if strange:
        raise InputError(folder.root, "`trial`", f"no trial '{strange[0]}'", f"there are {choices(folder)}")
    if wanted:
        chosen = [t for t in folder.trials if t.name in wanted]
        for trial in chosen:
            _recording(command, folder, trial)
        return chosen
    if not usable:
        raise InputError(folder.root, "", f"no trial has {first}", REMEDIES[first])
    standing = _standing(folder, usable, notes) if first == "markers" else [t for t in usable if t.static]
    if command == "scale":
        if len(standing) != 1:
            what = f"{len(standing)} trials are static" + (
                f": {listed(tuple(t.name for t in standing))}" if standing else ""
            )
            raise InputError(folder.root, "", what, f"say which one with `trial`: {choices(folder)}")
        return standing
    return [t for t in usable if t not in standing] or usable


def _standing(folder: ToolFolder, usable: list[FolderTrial], notes: list[str]) -> list[FolderTrial]:
    """Static trials by name and, in a laboratory's folder, by standing still; where both differ a note says so."""
    named = [t for t in usable if t.static]
    if folder.kind != TRIALS:
        return named
    still = [t for t in usable if _stands_still(t.markers)]
    moved = f"its name says static, and its markers move by more than {1e3 * STILL:.0f} mm"
    notes += [f"{t.name}: {moved}" for t in named if t not in still]
    unnamed = [t for t in still if t not in named]
    if named:
        notes += [f"{t.name}: its markers stand still, and its name does not say static" for t in unnamed]
        return named
    if unnamed:
        notes.append(f"{unnamed[0].name} is taken as the static trial: its markers stand still, no name says static")
    return unnamed


def _stands_still(file: Path | None) -> bool:
    """Whether 95 % of all places are within `STILL` of the mean of their marker."""
    if file is None:
        return False
    seen = read_markers(file)
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
    if command == PLANAR:
        warnings += _of_the_plane(folder, trial, typed, found)
    if command == "id" and not {"loads", "plates"} & typed:
        if trial.loads is not None:
            found["loads"] = str(trial.loads)
        else:
            warnings.append(f"{folder.kind}: no ground reaction belongs to {trial.name}: nothing but gravity acts")
    return found, warnings


def _of_the_plane(folder: ToolFolder, trial: FolderTrial, typed: frozenset[str], found: dict[str, str]) -> list[str]:
    """Puts the person's height and the trial's plates into `found`, where they are not typed; warnings."""
    if "height" not in typed and folder.person is not None and folder.person.height is not None:
        found["height"] = repr(folder.person.height)
    if "plates" in typed:
        return []
    if trial.loads is None:
        return [f"{folder.kind}: no plates belong to {trial.name}: its study follows coordinates alone; else `plates`"]
    found["plates"] = str(read_external_loads(trial.loads)[0])
    return []


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
    """Every file that is used and its part."""

    def part(name: str, file: str | Path, of: str = "", note: str = "") -> FolderPart:
        return FolderPart(name, Path(file).relative_to(folder.root).as_posix(), of, note)

    rows = [part("static trial" if command == "scale" else FIRST[command], recording, trial.name, trial.note)]
    if "model" in options:
        fitted = folder.kind == ADDBIOMECHANICS and command != "scale"
        rows.append(part("model", options["model"], note="of the last step of the fit" if fitted else ""))
    if "plates" in options and Path(options["plates"]).is_relative_to(folder.root):
        rows.append(part("plates", options["plates"], trial.name))
    if "loads" in options:
        rows.append(part("loads", options["loads"], trial.name))
    if folder.person is not None:
        rows.append(part("person", folder.person.file, note=folder.person.words))
    return tuple(rows)
