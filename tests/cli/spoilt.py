"""A call of `geocontact area` that works, spoilt in one place at a time."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from meshes.simple_shapes import block, sphere
from meshes.stl import stl_bytes
from tests.cli.calls import KNEE, call, inventory, poses, shifted, storage, written

BALL = stl_bytes(*sphere(20.0, 4), "ball")
FLOOR = stl_bytes(*block(80.0, 80.0, 12.0, 8), "floor")

Given = dict[str, object]
"""Options that differ from the call that works; None leaves one out, a function makes a file in the folder it gets."""

Cases = dict[str, tuple[Given, tuple[str, ...]]]
"""What is spoilt, and what the one line must then say."""

JOINT: Given = {"--osim": str(KNEE), "--joint": "knee_r", "--motion": lambda folder: storage(folder)}


def file(name: str, content: str | bytes) -> Callable[[Path], Path]:
    """A file of that name."""
    return lambda folder: written(folder / name, content)


def made(name: str) -> Callable[[Path], Path]:
    """A folder of that name."""

    def make(parent: Path) -> Path:
        (parent / name).mkdir()
        return parent / name

    return make


def placed(rows: str) -> Given:
    """The moving body is placed by these rows."""
    return {"--place-moving": file("place.txt", rows)}


def lifted() -> Given:
    """The ball is placed on the floor."""
    return {"--place-moving": lambda folder: shifted(folder, (0, 20, 0))}


def sweep(text: str, axis: str = "0,0,0,0,0,1") -> Given:
    """A sweep in place of the motion."""
    return {"--motion": None, "--sweep": text, "--axis": axis, **lifted()}


def sound(folder: Path) -> Given:
    """A ball that rests on a floor; results go two folders deep."""
    return {
        "MOVING": file("ball.stl", BALL),
        "FIXED": file("floor.stl", FLOOR),
        "--motion": lambda inputs: poses(inputs, (0, 20, 0)),
        "--unit": "mm",
        "--out": folder / "place/deep/out",
    }


def tokens(inputs: Path, given: Given) -> list[object]:
    """The command line, its files written into `inputs`."""
    values = {key: value(inputs) if callable(value) else value for key, value in given.items() if value is not None}
    bodies = [values.pop(name) for name in ("MOVING", "FIXED") if name in values]
    options = [f"{key}={v}" for key, value in values.items() for v in (value if isinstance(value, list) else [value])]
    return ["area", *bodies, *options]


def refuse(folder: Path, changes: Given, *said: str) -> None:
    """The call with `changes` ends with 2 and one line that holds what must be `said`; nothing is left behind."""
    inputs = folder / "inputs"
    inputs.mkdir()
    (folder / "place").mkdir()
    arguments = tokens(inputs, sound(folder) | changes)
    before = inventory(folder)
    result = call(*arguments)
    assert result.code == 2, result.err
    (line,) = result.complaints
    assert "Traceback" not in line
    assert not [part for part in said if part not in line], line
    assert inventory(folder) == before, "something was left behind"


def each(cases: Cases) -> pytest.MarkDecorator:
    """Runs a test once for each case."""
    return pytest.mark.parametrize(("changes", "said"), cases.values(), ids=cases.keys())
