"""Folders of recordings as the tools of the field leave them: which file plays which part.

Layouts, each seen in public repositories:

- OpenCap session (opencap-org/opencap-processing): OpenSimData/Model/*.osim, OpenSimData/Kinematics/TRIAL.mot,
  MarkerData/TRIAL.trc, sessionMetadata.yaml with mass_kg, height_m and openSimModel.
- AddBiomechanics subject (keenon/AddBiomechanics, stanfordnmbl/addbiomechanics-paper): Models/*.osim, IK/TRIAL_ik.mot,
  MarkerData/TRIAL.trc, ID/TRIAL_external_forces.xml, here or in results or osim_results; _subject.json beside them.
- Pose2Sim project (perfanalytics/pose2sim): Config.toml; in each trial's folder pose-3d/*.trc, raw, filtered and
  augmented, and kinematics/*.osim, *.mot.
- trials of a laboratory: .trc or .c3d files of standing and of moving side by side, perhaps a model, its motions and
  their loads, TRIAL_grf.xml (opensim-org/opensim-models); or a model and its motions alone.

Nothing is read here but names, and mass and height of the person.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations
from os import PathLike
from pathlib import Path
from typing import Any

from geocontact.data.errors import InputError
from geocontact.data.text import same_place
from geocontact.io.text.file_preflight import read_json, read_text_bytes
from geocontact.io.text.tables import listed
from geocontact.io.text.toml_text import toml_of

OPENCAP, ADDBIOMECHANICS, POSE2SIM, TRIALS = (
    "OpenCap session",
    "AddBiomechanics subject",
    "Pose2Sim project",
    "folder of trials",
)
METADATA, SUBJECT, CONFIG = "sessionMetadata.yaml", "_subject.json", "Config.toml"
STATIC = frozenset({"static", "stat", "cal", "calib", "calibration", "neutral", "tpose"})
"""Words in the name of a trial of standing still, where no other letters adjoin: walk_cal01, not calf or state."""
UPRIGHT = frozenset({"stand", "standing"})
MOVES = frozenset(("to", "up", "down", "from", "sit", "sitting", "sts", "chair", "rise", "raise", "get", "reach")) | {
    *("leg", "legs", "legged", "limb", "foot", "one", "single", "tandem"),
    *("squat", "jump", "hop", "walk", "walking", "turn", "step", "lunge"),
}
"""Words beside `stand` that make a movement of it, or standing on one leg."""
SCALED = ("match_markers_and_physics", "match_markers_but_ignore_physics", "final", "optimized_scale_and_markers")
"""Models that AddBiomechanics fits to the subject, the last step first."""
GENERIC = ("unscaled_generic", "unscaled_but_with_optimized_markers")
DEEPEST, MOST_FILES = 4, 20_000
LARGEST_TEXT = 1_000_000


@dataclass(frozen=True)
class FolderPerson:
    """Who was recorded: mass [kg] and height [m], None where the file does not say it."""

    file: Path
    mass: float | None
    height: float | None
    model: str = ""

    @property
    def words(self) -> str:
        """Both in one clause."""
        known = ((self.mass, "kg"), (self.height, "m"))
        return ", ".join(f"{value:g} {unit}" for value, unit in known if value is not None) or "no mass, no height"


@dataclass(frozen=True)
class FolderTrial:
    """Files of one trial.

    `model` is one of its own, `static` whether its name says that somebody stands, `rival` a second file of its
    markers, which leaves it open which is meant; `rival_motion` is TRIAL.mot beside TRIAL_ik.mot, a second motion where
    it holds no forces; `forces` are tables of ground reactions, which do not say on which bodies they act;
    `rival_loads` are all files of its loads where there are several, and `loads` is None then.
    """

    name: str
    markers: Path | None = None
    coordinates: Path | None = None
    loads: Path | None = None
    model: Path | None = None
    static: bool = False
    note: str = ""
    rival: Path | None = None
    forces: tuple[Path, ...] = ()
    rival_loads: tuple[Path, ...] = ()
    rival_motion: Path | None = None


@dataclass(frozen=True)
class ToolFolder:
    """What a folder holds.

    Parameters
    ----------
    kind
        Whose folder it is.
    root
        Where it is.
    trials
        By name, in the order of the alphabet.
    models
        Models of the person, the one to take first; several of one rank leave it open which is meant.
    generic
        Models that are not scaled to the person.
    person
        Mass and height, where a file says them.
    unused
        How many other files there are.
    unclaimed
        Tables and settings (.mot, .xml) beside the trials of a laboratory whose names belong to none of them.
    """

    kind: str
    root: Path
    trials: tuple[FolderTrial, ...]
    models: tuple[Path, ...] = ()
    generic: tuple[Path, ...] = ()
    person: FolderPerson | None = None
    unused: int = 0
    unclaimed: tuple[Path, ...] = ()


def read_tool_folder(path: str | PathLike[str]) -> ToolFolder:
    """What a folder holds; InputError in one line where it is none of the kinds above."""
    root = Path(path)
    for kind in (_opencap, _addbiomechanics, _pose2sim, _laboratory):
        found = kind(root)
        if found is not None:
            if twice := same_place(trial.name for trial in found.trials):
                what = f"two trials are called {twice}, in small and in capital letters"
                raise InputError(root, "", what, "rename one: their results would share a folder")
            return replace(found, unused=_count_of_others(found))
    if any(file.suffix.lower() == ".b3d" for file in _files(root)):
        raise InputError(root, "", "holds AddBiomechanics' .b3d only", B3D)
    inside = sorted({file.parent for file in _files(root) if file.suffix.lower() in (".trc", ".c3d")} - {root})
    names = tuple(f"{place.relative_to(root).as_posix()}/" for place in inside)
    perhaps = f": perhaps its folder {listed(names)}" if names else ""
    remedy = (
        "name one of OpenCap, AddBiomechanics or Pose2Sim, or one with .trc or .c3d, or with a model and its motions"
    )
    raise InputError(root, "", "is no folder of trials", f"{remedy}{perhaps}")


B3D = (
    "its only reader, nimblephysics, has had no release since December 2024 and has none for Python 3.13: download the "
    "subject's OpenSim results (.osim, .mot, .trc), and name that folder"
)


def _opencap(root: Path) -> ToolFolder | None:
    inside = root / "OpenSimData"
    if not inside.is_dir():
        return None
    person = _session(root / METADATA)
    models = _named(inside / "Model", ".osim")
    meant = [file for file in models if person and person.model and file.stem == f"{person.model}_scaled"]
    markers, motions = _by_stem(root / "MarkerData", ".trc"), _by_stem(inside / "Kinematics", ".mot")
    trials = [
        FolderTrial(name, markers.get(name), motions.get(name), static=_is_static(name))
        for name in sorted({*markers, *motions})
    ]
    return ToolFolder(OPENCAP, root, tuple(trials), tuple(meant or models), person=person)


def _addbiomechanics(root: Path) -> ToolFolder | None:
    places = (root, root / "results", root / "osim_results")
    place = next((p for p in places if (p / "Models").is_dir() and ((p / "IK").is_dir() or (p / "ID").is_dir())), None)
    if place is None:
        return None
    models = {file.stem: file for file in _named(place / "Models", ".osim")}
    fitted = [models[name] for name in SCALED if name in models][:1]
    generic = [models[name] for name in GENERIC if name in models]
    others = [file for name, file in models.items() if name not in (*SCALED, *GENERIC)]
    markers = _by_stem(place / "MarkerData", ".trc")
    motions = _by_stem(place / "IK", ".mot", "_ik")
    loads = _by_stem(place / "ID", ".xml", "_external_forces")
    trials = [
        FolderTrial(name, markers.get(name), motions.get(name), loads.get(name), static=_is_static(name))
        for name in sorted({*markers, *motions})
    ]
    about = next((p / SUBJECT for p in (place, *place.parents[:1]) if (p / SUBJECT).is_file()), None)
    person = None if about is None else _subject(about)
    return ToolFolder(ADDBIOMECHANICS, root, tuple(trials), tuple(fitted or others), tuple(generic), person)


def _pose2sim(root: Path) -> ToolFolder | None:
    if not (root / CONFIG).is_file():
        return None
    places = sorted({file.parent.parent for file in _files(root) if file.parent.name == "pose-3d"})
    config = toml_of(root / CONFIG, LARGEST_TEXT)
    augmented = bool(_table(config, "kinematics").get("use_augmentation", True))
    trials = [trial for place in places for trial in _of_project(place, augmented)]
    if not trials:
        return None
    names = [trial.name for trial in trials]
    if len(set(names)) < len(names):
        trials = [replace(t, name=f"{p.name}_{t.name}") for p in places for t in _of_project(p, augmented)]
    return ToolFolder(POSE2SIM, root, tuple(trials), person=_participant(root / CONFIG, config))


def _of_project(place: Path, augmented: bool) -> Iterator[FolderTrial]:
    """Trials of one folder of Pose2Sim, a name for each person in it."""
    variants: dict[str, list[Path]] = {}
    for file in _named(place / "pose-3d", ".trc"):
        variants.setdefault(_without_steps(file.stem), []).append(file)
    inside = next((place / name for name in ("kinematics", "opensim") if (place / name).is_dir()), place / "kinematics")
    for name, files in sorted(variants.items()):
        best = max(files, key=lambda file: (_rank(file.stem, augmented), file.name))
        motions, models = (
            [file for file in _named(inside, ending) if _without_steps(file.stem) == name]
            for ending in (".mot", ".osim")
        )
        own = [
            next((f for f in each if f.stem == best.stem), each[0] if len(each) == 1 else None)
            for each in (motions, models)
        ]
        note = f"the last step of {len(files)} files" if len(files) > 1 else ""
        yield FolderTrial(name, best, own[0], None, own[1], _is_static(name), note)


def _without_steps(stem: str) -> str:
    """Name of a trial without frames, filter and augmentation, in either order that Pose2Sim has had."""
    return re.sub(r"(_LSTM|_filt_[a-z]+|_\d+-\d+)+$", "", stem)


def _rank(stem: str, augmented: bool) -> int:
    """Steps that a file of markers has behind it; one that the project does not want comes last."""
    if "_LSTM" in stem:
        return 2 if augmented else -1
    return 1 if "_filt_" in stem else 0


def _laboratory(root: Path) -> ToolFolder | None:
    recorded, exported = _by_stem(root, ".c3d"), _by_stem(root, ".trc")
    markers, models = {**exported, **recorded}, tuple(_named(root, ".osim"))
    others = {f.stem: f for f in _named(root, ".mot") if _trial_of_loads(f) is None}
    computed = _by_stem(root, ".mot", "_ik")
    motions = {**others, **computed}
    names = markers or ({file.stem.removesuffix("_ik") for file in others.values()} if models else {})
    if not names:
        return None
    loads, forces = (_loads_by_trial(_named(root, ending), sorted(names)) for ending in (".xml", ".mot"))
    trials = [
        FolderTrial(
            name,
            markers.get(name),
            motions.get(name),
            loads[name][0] if len(loads[name]) == 1 else None,
            static=_is_static(name),
            rival=exported.get(name) if name in recorded else None,
            forces=forces[name],
            rival_loads=loads[name] if len(loads[name]) > 1 else (),
            rival_motion=others.get(name) if name in computed else None,
        )
        for name in sorted(names)
    ]
    used = set().union(*map(_files_of, trials))
    free = tuple(f for ending in (".xml", ".mot") for f in _named(root, ending) if f not in used)
    return ToolFolder(TRIALS, root, tuple(trials), models, unclaimed=free)


_LOADS = r"external_?loads|external_?forces|forces|grf"
"""OpenSim's external loads (.xml), or ground reactions alone (.mot): before or after the name of a trial, or alone."""


def _trial_of_loads(file: Path) -> str | None:
    """Trial whose loads a file's name says it holds, in lower case; empty where it names none, None for other files.

    >>> [_trial_of_loads(Path(name)) for name in ("walk_Grf.xml", "grf_walk.mot", "External_Loads.xml", "walk.mot")]
    ['walk', 'walk', '', None]
    """
    pattern = rf"(?:{_LOADS})(?:_(?:{_LOADS}))?|(.+)_(?:{_LOADS})|(?:{_LOADS})_(.+)"
    found = re.fullmatch(pattern, file.stem.lower())
    return None if found is None else found[1] or found[2] or ""


def _loads_by_trial(files: list[Path], names: list[str]) -> dict[str, tuple[Path, ...]]:
    """Loads of each trial by their names; those that name none belong to the only trial that is not static."""
    moving = [name for name in names if not _is_static(name)]
    of = {file: _trial_of_loads(file) for file in files}
    found = {name: tuple(f for f in files if of[f] == name.lower()) for name in names}
    if len(moving) == 1 and not found[moving[0]]:
        found[moving[0]] = tuple(f for f in files if of[f] == "")
    return found


def _is_static(name: str) -> bool:
    """Whether a name says so.

    >>> [_is_static(name) for name in ("P1_cal01", "staticTrial", "T-pose", "stand2", "sit_to_stand1", "oneLegStand")]
    [True, True, True, True, False, False]
    """
    posed = re.sub(r"(?<![a-z])t[-_ ]?pose(?![a-z])", "tpose", name, flags=re.IGNORECASE)
    apart = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", posed)
    words = set(re.findall("[a-z]+", apart.lower()))
    return bool(words & STATIC or (words & UPRIGHT and not words & MOVES))


def _files(root: Path) -> Iterator[Path]:
    """Files below a folder in the order of names, neither hidden ones nor those too deep; InputError for too many."""
    count = 0
    for place, folders, names in os.walk(root):
        deep = len(Path(place).relative_to(root).parts)
        folders[:] = sorted(name for name in folders if not name.startswith(".")) if deep < DEEPEST else []
        for name in sorted(names):
            if not name.startswith("."):
                count += 1
                if count > MOST_FILES:
                    raise InputError(root, "", f"holds more than {MOST_FILES} files", "name the folder of one person")
                yield Path(place) / name


def _named(folder: Path, ending: str) -> list[Path]:
    """Files of a folder with an ending, in the order of names; nothing where there is no such folder."""
    if not folder.is_dir():
        return []
    files = (file for file in folder.iterdir() if file.suffix.lower() == ending and file.is_file())
    found = sorted(file for file in files if not file.name.startswith("."))
    if same_place(file.name for file in found):
        one, other = next(pair for pair in combinations([f.name for f in found], 2) if same_place(pair))
        what = f"{one} and {other} differ in capital letters only"
        raise InputError(folder, "", what, "rename one: both would be one trial")
    return found


def _by_stem(folder: Path, ending: str, tail: str = "") -> dict[str, Path]:
    """By name of the trial, which the file's name has before `tail`."""
    return {f.stem.removesuffix(tail): f for f in _named(folder, ending) if f.stem.endswith(tail)}


def _count_of_others(found: ToolFolder) -> int:
    used = {*found.models[:1], *found.generic[:1]} | ({found.person.file} if found.person else set())
    used = used.union(*map(_files_of, found.trials))
    return sum(file not in used for file in _files(found.root))


def _files_of(trial: FolderTrial) -> set[Path]:
    own = (trial.markers, trial.rival, trial.coordinates, trial.loads, trial.model)
    return {each for each in (*own, *trial.forces, *trial.rival_loads) if each is not None}


SESSION = ("mass_kg", "height_m", "openSimModel")
"""Keys of a session of OpenCap that are read."""


def _session(file: Path) -> FolderPerson | None:
    """Keys of the first level of OpenCap's YAML, each a line `mass_kg: 83.0`."""
    if not file.is_file():
        return None
    lines = read_text_bytes(file, LARGEST_TEXT).decode("utf-8-sig", errors="replace").splitlines()
    pairs = [line.split(":", 1) for line in lines if re.match(r"\w+:", line)]
    given = dict(pairs)
    if twice := next((key for key in SESSION if [each for each, _ in pairs].count(key) > 1), ""):
        raise InputError(file, twice, "is there twice", "keep one of them")
    mass, height = (_size(file, key, given.get(key, "").strip()) for key in ("mass_kg", "height_m"))
    return FolderPerson(file, mass, height, given.get("openSimModel", "").strip().strip("'\""))


def _subject(file: Path) -> FolderPerson:
    try:
        given = read_json(file)
    except InputError:
        raise
    except (ValueError, RecursionError) as error:
        raise InputError(file, "", "is not JSON", "download the subject again") from error
    given = given if isinstance(given, dict) else {}
    return FolderPerson(file, _size(file, "massKg", given.get("massKg")), _size(file, "heightM", given.get("heightM")))


def _participant(file: Path, config: dict[str, Any]) -> FolderPerson | None:
    """Mass and height of a project of one person; of several persons nobody knows whose trial is whose."""
    project = _table(config, "project")
    sizes = [project.get(key, "") for key in ("participant_mass", "participant_height")]
    sizes = [each[0] if isinstance(each, list) and len(each) == 1 else each for each in sizes]
    if any(isinstance(each, list) for each in sizes):
        return None
    mass, height = sizes
    return FolderPerson(file, _size(file, "participant_mass", mass), _size(file, "participant_height", height))


def _table(config: dict[str, Any], name: str) -> dict[str, Any]:
    found = config.get(name, {})
    return found if isinstance(found, dict) else {}


def _size(file: Path, key: str, said: object) -> float | None:
    """A mass or height above 0; None where nothing is said, or `auto`."""
    if said in ("", "auto", None):
        return None
    try:
        value = float(said) if isinstance(said, (str, int, float)) else 0.0
    except ValueError:
        value = 0.0
    if not 0.0 < value < 1000.0:
        raise InputError(
            file, key, f"'{json.dumps(said)[:40]}' is no size of a person", "correct it, or delete the line"
        )
    return value


def choices(folder: ToolFolder) -> str:
    """Names of its trials, for a message."""
    return listed(tuple(trial.name for trial in folder.trials))
