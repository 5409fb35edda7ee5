"""A trial in a laboratory's axes: its files of text turned, or as a .c3d with plates of type 2, composed by hand."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from geocontact.io.mocap.trc import read_trc, write_trc
from tests.trial_checks.damage import alike, columns_changed, swapped, text_changed, times

DEEP = 0.04
"""m, of the plate's origin below its surface."""
TO_PLATE = np.diag([1.0, -1.0, -1.0])
"""From laboratory (x along the hall, z up) to a plate whose z points down."""
LABORATORY = "x,z,-y"
"""`axes` that turn such a file into x, y up, z."""
TURN = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""From x, y up, z to the laboratory."""
PER_FRAME = 5
"""Samples of a plate in a frame of the markers."""
MARGIN = 0.15
"""m, of the plate beyond the centres of pressure."""


def write_c3d(
    file: Path,
    names: tuple[str, ...],
    places: np.ndarray,
    rate: float,
    plates: tuple[tuple[np.ndarray, np.ndarray, np.ndarray], ...] = (),
) -> Path:
    """Markers (t, m, 3) [m] and plates: force on the foot (s, 3) [N], where it acts (s, 3) [m], and torque there
    (s, 3) [N m], all in x, y up, z; a plate has a whole number of samples in a frame.
    """
    ezc3d = pytest.importorskip("ezc3d", reason="the extra `mocap` is not installed")
    content = ezc3d.c3d()
    point, analog = content["parameters"]["POINT"], content["parameters"]["ANALOG"]
    point["UNITS"]["value"], point["RATE"]["value"], point["LABELS"]["value"] = ["mm"], [rate], list(names)
    content["data"]["points"] = np.concatenate(
        [1e3 * np.moveaxis(places @ TURN.T, 2, 0).swapaxes(1, 2), np.ones((1, len(names), len(places)))]
    )
    if plates:
        _add_plates(content, analog, rate * len(plates[0][0]) / len(places), plates)
    content.write(str(file))
    return file


def _add_plates(content: Any, analog: Any, rate: float, plates: tuple[tuple[np.ndarray, ...], ...]) -> None:
    channels, corners = [], []
    for force, point, torque in plates:
        loaded = np.abs(force[:, 1]) > 5.0
        low, high = (point[loaded] @ TURN.T)[:, :2].min(axis=0) - MARGIN, (point[loaded] @ TURN.T)[:, :2].max(axis=0)
        high = high + MARGIN
        middle = np.array([*(0.5 * (low + high)), 0.0])
        r = (point @ TURN.T - middle) @ TO_PLATE.T - np.array([0.0, 0.0, DEEP])
        on_plate, twist = (-(each @ TURN.T) @ TO_PLATE.T for each in (force, torque))
        channels.append(np.column_stack([on_plate, 1e3 * (np.cross(r, on_plate) + twist)]))
        corners.append(1e3 * np.array([[high[0], low[1], 0.0], [*low, 0.0], [low[0], high[1], 0.0], [*high, 0.0]]).T)
    count = len(plates)
    analog["LABELS"]["value"] = [
        f"{kind}{k + 1}" for k in range(count) for kind in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
    ]
    analog["UNITS"]["value"] = (["N"] * 3 + ["Nmm"] * 3) * count
    analog["RATE"]["value"] = [rate]
    content["data"]["analogs"] = np.column_stack(channels).T[None]
    told = {
        "USED": [count],
        "TYPE": [2] * count,
        "ZERO": [0, 0],
        "CORNERS": np.stack(corners, axis=2),
        "ORIGIN": np.tile([[0.0], [0.0], [-1e3 * DEEP]], (1, count)),
        "CHANNEL": np.arange(1, 6 * count + 1).reshape(count, 6).T,
    }
    for name, value in told.items():
        group = content["parameters"]["FORCE_PLATFORM"]
        if name in group:
            group[name]["value"] = value
        else:
            content.add_parameter("FORCE_PLATFORM", name, value)


def laboratory(folder: Path, files: tuple[str, ...]) -> None:
    """Markers and plates as a laboratory has them whose z is up and whose walk goes along -x."""
    for name in files:
        if name.endswith(".trc"):
            seen = read_trc(folder / name)
            turned = seen.positions[..., [0, 2, 1]] * np.array([-1.0, 1.0, 1.0])
            write_trc(folder / name, replace(seen, positions=turned))
            continue
        for kind in ("_v", "_p", "torque_"):
            columns_changed(name, alike(swapped(f"{kind}y", f"{kind}z"), times(-1.0, f"{kind}x")))(folder)


def rate_of(time: np.ndarray) -> float:
    return (len(time) - 1) / float(time[-1] - time[0])


def columns_of(file: Path) -> dict[str, np.ndarray]:
    """Columns of a .mot by name."""
    held: dict[str, np.ndarray] = {}
    columns_changed(file.name, held.update)(file.parent)
    return held


def resampled(file: Path, first: float, time: np.ndarray) -> None:
    """A .mot at these times after its `first` [s]."""
    held = columns_of(file)
    changed = {name: np.interp(time, held["time"] - first, values) for name, values in held.items()} | {"time": time}
    columns_changed(file.name, lambda columns: columns.update(changed))(file.parent)
    text_changed(file.name, lambda text: re.sub(r"nRows=\d+", f"nRows={len(time)}", text))(file.parent)


def plates_of(file: Path, names: tuple[str, ...]) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], ...]:
    """Force, where it acts, and torque of plates of a .mot."""
    held = columns_of(file)
    heads = [(f"{name}_v", f"{name}_p", name.replace("force", "torque_")) for name in names]
    found = [[np.column_stack([held[head + axis] for axis in "xyz"]) for head in each] for each in heads]
    return tuple((force, point, torque) for force, point, torque in found)


def as_c3d(folder: Path, markers: str, plates: str = "", names: tuple[str, ...] = ()) -> None:
    """Markers from time 0 on, plates at a whole number of samples in a frame, and a .c3d file with both."""
    seen = read_trc(folder / markers)
    rate = round(rate_of(seen.time))
    write_trc(folder / markers, replace(seen, time=np.arange(len(seen)) / rate))
    if plates:
        samples = np.arange(PER_FRAME * len(seen)) / (PER_FRAME * rate)
        resampled(folder / plates, float(seen.time[0]), samples)
    wrenches = plates_of(folder / plates, names) if plates else ()
    write_c3d((folder / markers).with_suffix(".c3d"), seen.names, seen.positions, rate, wrenches)


def plates_as_c3d(folder: Path, file: str, names: tuple[str, ...]) -> None:
    """A .c3d file with the plates of a .mot, and a marker that lies still."""
    time = columns_of(folder / file)["time"]
    wrenches, rate = plates_of(folder / file, names), rate_of(time)
    write_c3d((folder / file).with_suffix(".c3d"), ("HEE",), np.ones((len(time), 1, 3)), rate, wrenches)
