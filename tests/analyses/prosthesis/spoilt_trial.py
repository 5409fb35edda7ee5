"""The shipped trial with one thing wrong."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from geocontact.below_knee_prosthesis.from_markers import FOOT
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.trc import read_trc, trc_text
from tests.cli.calls import MESHES

TRIAL = MESHES / "gait_P1_medium_1"


def spoilt_plates(folder: Path, column: str, change: Callable[[float], float]) -> Path:
    """`plates.mot` with the columns whose names hold these letters changed."""
    head, body = (TRIAL / "plates.mot").read_text().split("endheader\n")
    names, *rows = body.splitlines()
    at = [k for k, name in enumerate(names.split("\t")) if column in name]
    assert at
    changed = [row.split("\t") for row in rows]
    for row in changed:
        for k in at:
            row[k] = f"{change(float(row[k])):.5f}"
    file = folder / "plates.mot"
    file.write_text(f"{head}endheader\n" + "\n".join([names, *("\t".join(row) for row in changed)]) + "\n")
    return file


def delayed_plates(folder: Path, samples: int) -> Path:
    """`plates.mot` whose forces come so many samples of 2 ms later, the last ones first."""
    head, body = (TRIAL / "plates.mot").read_text().split("endheader\n")
    names, *rows = body.splitlines()
    cells = [row.split("\t") for row in rows]
    later = cells[-samples:] + cells[:-samples]
    moved = ["\t".join([now[0], *then[1:]]) for now, then in zip(cells, later, strict=True)]
    file = folder / "plates.mot"
    file.write_text(f"{head}endheader\n" + "\n".join([names, *moved]) + "\n")
    return file


def renamed_markers(folder: Path, name: str, names: dict[str, str]) -> Path:
    """A `.trc` of the trial whose markers are called otherwise."""
    lines = (TRIAL / name).read_text().split("\n")
    cells = [names.get(cell, cell) for cell in lines[3].split("\t")]
    lines[3] = "\t".join(cells)
    file = folder / name
    file.write_text("\n".join(lines))
    return file


def in_metres(folder: Path, name: str) -> Path:
    """A `.trc` of the trial whose head says m where millimetres stand."""
    file = folder / name
    file.write_text((TRIAL / name).read_text().replace("\tmm\t", "\tm\t", 1))
    return file


def out_of_flat(folder: Path, angle: float) -> Path:
    """The standing trial with the whole person, markers and all, turned about the floor below the foot's middle [rad].

    Counterclockwise seen from the right: the foot's toes are up by that, and the trial takes it for flat.
    """
    stood = read_trc(TRIAL / "standing.trc")
    heel, toe = (np.nanmedian(stood.of((name,)), axis=0)[0] for name in FOOT)
    middle = np.array([0.5 * (heel[0] + toe[0]), 0.0, 0.0])
    turn = Rotation.from_euler("z", angle).as_matrix()
    places = (stood.positions - middle) @ turn.T + middle
    file = folder / "standing.trc"
    file.write_text(trc_text("out of flat", MarkerTrajectories(stood.time, places, stood.names, ""), 3))
    return file
