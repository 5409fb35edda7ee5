"""What a file holds, found by the reader that exists for it: size, columns, markers, plates, units that would fit."""

from __future__ import annotations

import os
import tomllib
import warnings
from collections.abc import Callable, Iterable, Sized
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError

MOST_NAMES = 24
"""Names of columns or markers that are listed."""
CASE, LARGEST_CASE = "case.toml", 1_000_000
SURFACE, MODEL = "surface of triangles", "model of OpenSim"


@dataclass
class Content:
    """What a file holds.

    Parameters
    ----------
    kind
        What it is, in words; "" where no reader here knows it.
    facts
        Lines on its content.
    warnings
        Reservations of its reader.
    wrong
        Why its reader refuses it.
    units
        Unit of length that a surface states; else those that would make its size usual, the commonest first.
    markers
        Names of its markers: of a recording or of a model.
    """

    kind: str = ""
    facts: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    wrong: str = ""
    units: list[str] = field(default_factory=list)
    markers: list[str] = field(default_factory=list)


def state_of_folder(folder: Path) -> tuple[int, int]:
    """A mark of names, times of change and sizes of all that a folder's reader may look at, and how many these are.

    The time of a folder alone says what is new or gone in it, and nothing of what is deeper or written again.
    """
    from geocontact.io.recordings.tool_folder import DEEPEST, MOST_FILES

    mark, count = sha256(), 0
    places = [(os.fspath(folder), 0)]
    while places:
        place, deep = places.pop()
        try:
            with os.scandir(place) as entries:
                found = sorted((each for each in entries if not each.name.startswith(".")), key=lambda each: each.name)
        except OSError:  # it is gone, or closed
            found = []
        for entry in found[: MOST_FILES + 1 - count]:
            try:
                seen, inside = entry.stat(), entry.is_dir(follow_symlinks=False)
            except OSError:  # it is gone, or a link that leads nowhere
                continue
            count += 1
            mark.update(os.fsencode(f"{entry.path}\0{seen.st_mtime_ns}\0{seen.st_size}\0"))
            if inside and deep < DEEPEST:
                places.append((entry.path, deep + 1))
        if count > MOST_FILES:
            break
    return int.from_bytes(mark.digest()[:8], "big"), count


def content_of(path: Path) -> Content:
    """Content of one file or folder, read in this process."""
    found = Content()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            _reader(path)(path, found)
        except InputError as error:
            found.wrong = str(error)
        except OSError as error:
            found.wrong = f"{path.name}: {error.strerror}"
    found.warnings = list(dict.fromkeys(str(each.message) for each in caught))
    for lines in (found.facts, found.warnings):
        lines[:] = [line.replace(str(path), path.name) for line in lines]
    found.wrong = found.wrong.replace(str(path), path.name)
    return found


def holds(path: Path, content: bytes) -> bool:
    """Whether a regular file is there and holds these bytes."""
    from geocontact.io.text.file_preflight import read_bytes

    return path.is_file() and path.stat().st_size == len(content) and (not content or read_bytes(path) == content)


def markers_in_common(recorded: Iterable[str], model: Iterable[str]) -> str:
    """How many of a model's markers a recording has, and which it has not."""
    has, wanted = set(recorded), list(model)
    lacking = [name for name in wanted if name not in has]
    said = f"{len(wanted) - len(lacking)} of the model's {_counted(wanted, 'marker')} are in the recording"
    return said + (f"; it lacks {_listed(lacking)}" if lacking else "")


def _reader(path: Path) -> Callable[[Path, Content], None]:
    """The function that looks into files with this ending."""
    from geocontact.io.mesh.meshes import READERS

    if path.is_dir():
        return _case if (path / CASE).is_file() else _folder
    suffix = path.suffix.lower()
    if suffix in READERS:
        return _surface
    return READERS_BY_ENDING.get(suffix, _text)


def _surface(path: Path, found: Content) -> None:
    from geocontact.io.mesh.mesh_checks import fitting_units, require_finite
    from geocontact.io.mesh.meshes import READERS
    from geocontact.io.mesh.step import read_step, unit_of_step
    from geocontact.io.text.file_preflight import read_bytes
    from geocontact.io.text.units import LENGTH

    found.kind = SURFACE
    data, reader = read_bytes(path), READERS[path.suffix.lower()]
    vertices, faces = reader(data, path.name)
    require_finite(vertices, faces, path.name)
    low, high = vertices.min(axis=0).astype(float), vertices.max(axis=0).astype(float)
    sides = " × ".join(f"{side:.4g}" for side in high - low)
    found.facts = [_counted(faces, "triangle")]
    if reader is read_step:
        found.units = [unit_of_step(data, path.name)]
        found.facts.append(f"{sides} {found.units[0]}, the unit that the file states")
        return
    found.facts.append(f"{sides} in the file's own unit, which it does not state")
    diagonal = float(np.linalg.norm(high - low))
    found.units = fitting_units(diagonal)
    if found.units:
        across = (f"{unit}, then it is {1e3 * diagonal * LENGTH[unit]:.4g} mm across" for unit in found.units)
        found.facts.append(f"the unit may be {'; or '.join(across)}")


def _markers(path: Path, found: Content) -> None:
    from geocontact.io.mocap.markers import read_markers

    found.kind = "recording of markers"
    markers = read_markers(path)
    found.markers = list(markers.names)
    found.facts = [_over_time(markers.time), f"{_counted(markers.names, 'marker')}: {_listed(markers.names)}"]
    unseen = np.isnan(markers.positions).any(axis=2).mean(axis=0)
    gaps = [f"{name} {share:.1%}" for name, share in zip(markers.names, unseen, strict=True) if share > 0.0]
    found.facts.append(f"frames in which a marker was not seen: {_listed(gaps)}" if gaps else "no marker has a gap")


def _c3d(path: Path, found: Content) -> None:
    from geocontact.io.mocap.c3d_events import read_c3d_strikes

    _markers(path, found)
    found.kind = "recording of markers and force plates (C3D)"
    _plates(path, found)
    strikes = [f"{_counted(times, 'heel strike')} {side}" for side, times in read_c3d_strikes(path).items()]
    found.facts += [", ".join(strikes)] if strikes else []


def _plates(path: Path, found: Content) -> None:
    """Plates with the largest force along their normal, where there are some."""
    from geocontact.io.mocap.force_plates import read_force_plates

    try:
        plates = read_force_plates(path)
    except InputError as error:
        if path.suffix.lower() == ".c3d":
            found.facts.append(f"no force plate that can be used: {error}")
        return
    peaks = [f"{each.name} up to {np.nanmax(each.wrench.force @ each.normal, initial=0.0):.0f} N" for each in plates]
    if peaks:
        found.facts.append(f"{_counted(plates, 'force plate')}: {_listed(peaks)}")


def _storage(path: Path, found: Content) -> None:
    from geocontact.io.text.tables import read_table

    found.kind = "table of OpenSim"
    table = read_table(path)
    found.facts = [
        _over_time(table.time, table.time_unit),
        f"{_counted(table.channels, 'column')} beside time: {_listed(table.channels)}",
    ]
    if any(name.endswith("_vx") for name in table.channels):
        _plates(path, found)


def _table(path: Path, found: Content) -> None:
    from geocontact.io.text.tables import read_table

    if path.suffix.lower() == ".csv" and _mat(path, found):
        return
    found.kind = "table"
    try:
        table = read_table(path, leave_words=True)
    except InputError as error:
        found.facts = [f"no table over time: {error}"]  # which a table of landmarks or of events need not be
        return
    names = [f"{name} [{unit}]" if unit else name for name, unit in zip(table.channels, table.units, strict=True)]
    found.facts = [
        _over_time(table.time, table.time_unit),
        f"{_counted(names, 'column')} beside time: {_listed(names)}",
    ]
    if {name[-2:] for name in table.channels} >= {"_x", "_y", "_z"}:
        _markers(path, found)
    if any(name.endswith("_vx") for name in table.channels):
        _plates(path, found)


def _mat(path: Path, found: Content) -> bool:
    """Whether it is the recording of a pressure mat; what its reader needs of a layout is said as a fact."""
    from geocontact.io.mats.catalogue import READERS, read_mat
    from geocontact.io.mats.text import read_mat_text

    text = read_mat_text(path)
    kind = next((key for key, reader in READERS.items() if reader.suits(text)), None)
    if kind is None:
        return False
    found.kind = f"recording of a pressure mat ({kind})"
    try:
        for mat in read_mat(path):
            size = f"{int(mat.valid.sum())} of {mat.rows} × {mat.columns} cells"
            found.facts.append(
                f"{mat.name}: {_over_time(mat.time)}, {size}, up to {1e-3 * np.nanmax(mat.pressure):.3g} kPa"
            )
    except InputError as error:
        found.facts.append(f"what the file does not say stands in another field: {error}")
    return True


def _model(path: Path, found: Content) -> None:
    from geocontact.io.opensim.osim_multibody import read_multibody

    found.kind = MODEL
    model = read_multibody(path)
    found.markers = [each.name for each in model.markers]
    coordinates = [each.name for joint in model.joints for each in joint.coordinates]
    found.facts = [
        f"{_counted(model.bodies, 'body', 'bodies')}: {_listed(each.name for each in model.bodies)}",
        f"{_counted(coordinates, 'coordinate')}: {_listed(coordinates)}",
        f"{_counted(found.markers, 'marker')}: {_listed(found.markers)}",
    ]


def _description(path: Path, found: Content) -> None:
    from geocontact.io.text.file_preflight import read_bytes

    found.kind = "description (TOML)"
    try:
        keys = tomllib.loads(read_bytes(path).decode("utf-8"))
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError(path.name, "", f"is not TOML: {error}", "correct the line") from error
    found.facts = [f"keys: {_listed(keys)}"]


def _folder(path: Path, found: Content) -> None:
    """Kind and trials of a folder of recordings, as the commands that take one find them."""
    from geocontact.io.recordings.tool_folder import read_tool_folder

    folder = read_tool_folder(path)
    found.kind = folder.kind
    named = [f"{each.name} (static by its name)" if each.static else each.name for each in folder.trials]
    parts = {
        "markers": sum(each.markers is not None for each in folder.trials),
        "coordinates": sum(each.coordinates is not None for each in folder.trials),
        "loads": sum(each.loads is not None for each in folder.trials),
    }
    models = [each.name for each in (*folder.models, *folder.generic)]
    models += [each.model.name for each in folder.trials if each.model is not None]
    found.facts = [
        f"{_counted(named, 'trial')}: {_listed(named)}",
        ", ".join(f"{count} with {part}" for part, count in parts.items() if count),
        f"{_counted(models, 'model')}: {_listed(models)}" if models else "no model",
        *([f"person: {folder.person.words} ({folder.person.file.name})"] if folder.person is not None else []),
        f"{folder.unused} other file{'' if folder.unused == 1 else 's'}",
    ]


def _case(path: Path, found: Content) -> None:
    """Trials of a gap case, as its description names them."""
    from geocontact.io.text.toml_text import toml_of

    found.kind = "gap case"
    said = toml_of(path / CASE, LARGEST_CASE)
    sides = {side: said[side] for side in ("calibration", "evaluation") if isinstance(said.get(side), list)}
    found.facts = [f"{_counted(names, 'trial')} of {side}: {_listed(map(str, names))}" for side, names in sides.items()]


def _text(path: Path, found: Content) -> None:
    """A recording of a mat has any ending; of all else only the size is said."""
    try:
        if path.is_file() and _mat(path, found):
            return
    except InputError:
        pass  # no text: nothing that is known here
    found.facts = [f"{path.stat().st_size / 1e3:.3g} kB; its content is read when the analysis runs"]


def _over_time(time: Float[np.ndarray, " t"], unit: str = "s") -> str:
    """ "101 frames, 0 to 1 s, 100 Hz"."""
    said = _counted(time, "frame")
    if not len(time):
        return said
    said += f", {time[0]:g} to {time[-1]:g} {unit}"
    if len(time) > 1 and unit == "s":
        said += f", {1.0 / float(np.median(np.diff(time))):.4g} Hz"
    return said


def _counted(things: Sized, one: str, many: str = "") -> str:
    return f"{len(things)} {one if len(things) == 1 else many or one + 's'}"


def _listed(names: Iterable[str]) -> str:
    from geocontact.io.text.tables import listed

    return listed(tuple(names), MOST_NAMES)


READERS_BY_ENDING: dict[str, Callable[[Path, Content], None]] = {
    ".trc": _markers,
    ".c3d": _c3d,
    ".mot": _storage,
    ".sto": _storage,
    ".csv": _table,
    ".xlsx": _table,
    ".osim": _model,
    ".toml": _description,
}
"""What looks into a file of each ending; surfaces have those of `io`."""
