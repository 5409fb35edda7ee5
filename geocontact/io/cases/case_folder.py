"""The folder of a gap case: which files are there, and that none leads out of it."""

from __future__ import annotations

import warnings
from os import PathLike, fspath
from pathlib import Path

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.cases.case_settings import CaseSettings
from geocontact.io.text.tables import listed

SETTINGS = "case.toml"
TRIALS = "trials"

MOST_BYTES = 512_000_000
"""Of all trials of a case together."""


def case_folder(folder: str | PathLike[str]) -> Path:
    """The folder as a path, refused when it is none."""
    home = Path(folder)
    try:
        exists, is_folder = home.exists(), home.is_dir()
    except (OSError, ValueError) as error:  # a path that is too long, locked, or holds a NUL
        raise InputError(folder, "", f"cannot be opened: {error}", "check the path") from error
    if not is_folder:
        what = "is not a folder" if exists else "there is no such folder"
        raise InputError(folder, "", what, f"name the folder that holds {SETTINGS}")
    return home


def inside(home: Path, name: str, key: str, endings: tuple[str, ...] = (".csv",)) -> Path:
    """The file that case.toml names, inside the case's folder."""
    parts = Path(name).parts
    usable = name.isprintable() and not any(sign in name for sign in '\\:*?"<>|')
    if not usable or Path(name).is_absolute() or ".." in parts or not name.lower().endswith(endings):
        example = 'spheres = "spheres.csv"' if ".csv" in endings else 'file = "insert.stl"'
        remedy = f"name a {' '.join(endings)} file inside the folder of the case, as in {example}"
        raise InputError(home / SETTINGS, key, f"{name[:80]!r} cannot be used", remedy)
    path = home / name
    try:
        contained = path.resolve().is_relative_to(home.resolve())
    except (OSError, RuntimeError):  # links that lead in a circle
        contained = False
    if not contained:
        what = f"{name[:80]!r} leads out of the folder of the case"
        raise InputError(home / SETTINGS, key, what, "copy the file there")
    return path


def trial_file(home: Path, name: str) -> Path:
    """Where the trial of that id is."""
    return home / TRIALS / f"{name}.csv"


def check_trial_files(home: Path, settings: CaseSettings) -> None:
    """Every listed trial has a file, together of a size that can be read; others are warned of."""
    folder = home / TRIALS
    if not folder.is_dir():
        raise InputError(home, "", f"no folder '{TRIALS}' in it", f"put the trials there, as {TRIALS}/<id>.csv")
    try:
        present = {entry.stem: entry for entry in sorted(folder.iterdir()) if entry.suffix == ".csv"}
        size = sum(present[name].stat().st_size for name in settings.trials if name in present)
    except OSError as error:
        raise InputError(folder, "", f"cannot be read: {error.strerror or error}", "check its permissions") from error
    for place, ids in (("calibration", settings.calibration), ("evaluation", settings.evaluation)):
        for name in ids:
            if name not in present:
                remedy = f"strike it or add the file; there are {listed(tuple(present))}"
                raise InputError(home / SETTINGS, place, f"no file {TRIALS}/{name}.csv", remedy)
    if size > MOST_BYTES:
        what = f"the trials have {size / 1e6:.0f} MB, more than the {MOST_BYTES / 1e6:.0f} MB that are read"
        raise InputError(folder, "", what, "resample them or list fewer")
    _warn_of_idle(folder, tuple(present), settings)


def _warn_of_idle(folder: Path, present: tuple[str, ...], settings: CaseSettings) -> None:
    cells = {f"{name}_{site}_cells" for name in settings.trials for site in settings.layout}
    idle = tuple(f"{name}.csv" for name in present if name not in settings.trials and name not in cells)
    if idle:
        message = f"{fspath(folder)}: not listed in {SETTINGS} and not used: {listed(idle)}"
        warnings.warn(InputWarning(message), stacklevel=4)
