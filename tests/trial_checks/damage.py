"""How files of a trial are damaged, and what an analysis says of them: helpers of the battery over all commands."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.analyses.frame.collector import collecting
from geocontact.analyses.frame.record import Record
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.trc import read_trc, write_trc

Damage = Callable[[Path], dict[str, Any]]


class Said(set[str]):
    """Lines, and what was read; None where it was refused."""

    made: object = None


def said(read: Callable[[Any], object], options: Callable[..., Any], *first: Path, **given: Any) -> Said:
    """Warnings of reading with these options, or the refusal; without folders and numbers, so that two runs compare.

    A warning that a trial has as it is and that only changes a number is no word of what is wrong.
    """
    with collecting(Record("test", {})) as record:
        try:
            made = read(options(*first, **given))
        except InputError as error:
            return Said({f"refused: {error}"})
    lines = Said(re.sub(r"[-−]?\d[\d.e+]*", "#", re.sub(r"\S*/", "", line)) for line in record.warnings)
    lines.made = made
    return lines


def numbers(made: object) -> list[float]:
    """Every number in something that was read, in its order; of objects those of their fields."""
    if isinstance(made, (bool, str, bytes, Path)) or made is None or callable(made):
        return []
    if isinstance(made, (int, float, np.number)):
        return [float(made)]
    if isinstance(made, np.ndarray):
        return [float(x) for x in made.ravel()] if made.dtype.kind in "fi" else []
    if isinstance(made, (Rotation, RigidTransform)):
        return numbers(made.as_matrix())
    if isinstance(made, Mapping):
        return [x for each in made.values() for x in numbers(each)]
    if isinstance(made, Iterable):
        return [x for each in made for x in numbers(each)]
    return [x for name in getattr(made, "__dataclass_fields__", ()) for x in numbers(getattr(made, name))]


def markers_changed(file: str, change: Callable[[MarkerTrajectories, np.ndarray], np.ndarray]) -> Damage:
    """A file of markers with other places."""

    def damage(folder: Path) -> dict[str, Any]:
        seen = read_trc(folder / file)
        places = change(seen, seen.positions.copy())
        write_trc(folder / file, MarkerTrajectories(seen.time, places, seen.names))
        return {}

    return damage


def jumping(name: str) -> Callable[[MarkerTrajectories, np.ndarray], np.ndarray]:
    """Three frames of a marker 150 mm aside."""

    def change(seen: MarkerTrajectories, places: np.ndarray) -> np.ndarray:
        k = seen.names.index(name)
        middle = len(places) // 2
        places[middle : middle + 3, k, 2] += 0.15
        return places

    return change


def exchanged(one: str, other: str) -> Callable[[MarkerTrajectories, np.ndarray], np.ndarray]:
    """Two labels exchanged from the middle on."""

    def change(seen: MarkerTrajectories, places: np.ndarray) -> np.ndarray:
        k = [seen.names.index(one), seen.names.index(other)]
        places[len(places) // 2 :, k] = places[len(places) // 2 :, k[::-1]]
        return places

    return change


def raised(by: float) -> Callable[[MarkerTrajectories, np.ndarray], np.ndarray]:
    return lambda _, places: places + np.array([0.0, by, 0.0])


def larger(by: float) -> Callable[[MarkerTrajectories, np.ndarray], np.ndarray]:
    return lambda _, places: by * places


def z_up(_: MarkerTrajectories, places: np.ndarray) -> np.ndarray:
    return places[..., [0, 2, 1]] * np.array([1.0, -1.0, 1.0])


def mirrored(_: MarkerTrajectories, places: np.ndarray) -> np.ndarray:
    return places * np.array([1.0, 1.0, -1.0])


def columns_changed(name: str, change: Callable[[dict[str, np.ndarray]], None]) -> Damage:
    """Columns of a .mot or .sto file, changed in place; `time` is one of them."""

    def damage(folder: Path) -> dict[str, Any]:
        file = folder / name
        head, body = re.split(r"endheader[^\n]*\n", file.read_text())
        names, *rows = body.splitlines()
        values = np.array([[float(cell) for cell in row.split()] for row in rows])
        columns = {each: values[:, k] for k, each in enumerate(names.split("\t"))}
        change(columns)
        lines = ["\t".join(f"{value:.9f}" for value in row) for row in np.column_stack(list(columns.values()))]
        file.write_text(f"{head}endheader\n" + "\n".join([names, *lines]) + "\n")
        return {}

    return damage


def plates_changed(change: Callable[[dict[str, np.ndarray]], None]) -> Damage:
    """Columns of plates.mot."""
    return columns_changed("plates.mot", change)


def text_changed(name: str, change: Callable[[str], str]) -> Damage:
    """A file of text."""

    def damage(folder: Path) -> dict[str, Any]:
        (folder / name).write_text(change((folder / name).read_text()))
        return {}

    return damage


def decimal_comma(name: str) -> Damage:
    """Every decimal point of a table a comma."""
    return text_changed(name, lambda text: re.sub(r"(\d)\.(\d)", r"\1,\2", text))


def swapped(one: str, other: str) -> Callable[[dict[str, np.ndarray]], None]:
    """Two components exchanged in the whole table, as `_vx` and `_vy`."""

    def change(columns: dict[str, np.ndarray]) -> None:
        for name in [each for each in columns if each.endswith(one)]:
            twin = name.removesuffix(one) + other
            columns[name], columns[twin] = columns[twin].copy(), columns[name].copy()

    return change


def alike(*changes: Callable[[dict[str, np.ndarray]], None]) -> Callable[[dict[str, np.ndarray]], None]:
    """Several changes after each other."""

    def change(columns: dict[str, np.ndarray]) -> None:
        for each in changes:
            each(columns)

    return change


def times(factor: float, ends: str) -> Callable[[dict[str, np.ndarray]], None]:
    """Columns whose names end so, times a factor."""

    def change(columns: dict[str, np.ndarray]) -> None:
        hit = [name for name in columns if name.endswith(ends)]
        assert hit
        for name in hit:
            columns[name] = factor * columns[name]

    return change


def late(by: float) -> Callable[[dict[str, np.ndarray]], None]:
    def change(columns: dict[str, np.ndarray]) -> None:
        columns["time"] = columns["time"] + by

    return change


def option(**changed: Any) -> Damage:
    return lambda _: changed


def all_of(*damages: Damage) -> Damage:
    def damage(folder: Path) -> dict[str, Any]:
        return {name: value for each in damages for name, value in each(folder).items()}

    return damage


def files_of(source: Path, folder: Path) -> Path:
    there = folder / source.name
    shutil.copytree(source, there)
    return there
