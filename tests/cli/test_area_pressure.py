"""`geocontact area --pressure`: what it writes and what it refuses; numbers are tested in tests/analyses/area."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from meshes.simple_shapes import block, sphere
from meshes.stl import stl_bytes
from tests.cli.calls import Call, area, done, inventory, poses, written
from tests.cli.spoilt import Given, refuse
from tests.contract import FILES

MATERIAL = ("--pressure", "--modulus", "500MPa", "--poisson", "0.46")
PRESSURE = {"pressure.csv", "pressure.png", "pressure.svg"}
DEPTHS = (0.3, 0.1, -0.5)
"""mm; the last frame is in the air."""


def bodies(folder: Path, n: int = 30) -> dict[str, Path]:
    """Ball of 20 mm and floor 12 mm thick with its top at y = 0."""
    return {
        "moving": written(folder / "ball.stl", stl_bytes(*sphere(20.0, n), "ball")),
        "fixed": written(folder / "floor.stl", stl_bytes(*block(80.0, 80.0, 12.0, 8), "floor")),
    }


def pressed(
    folder: Path, *options: object, at: tuple[float, float] = (0.0, 0.0), n: int = 30, picture: bool = False
) -> Call:
    motion = poses(folder, *((at[0], 20.0 - depth, at[1]) for depth in DEPTHS))
    arguments = (folder / "out", *MATERIAL, *options)
    return area(*arguments, motion=motion, picture=picture, **bodies(folder, n))


def test_files_page_and_maps(tmp_path: Path) -> None:
    result = done(pressed(tmp_path, "--save-map", "--parquet", "--split", "z", "--side", "right", picture=True))
    more = {"area.parquet", "distances.npz", "pressure.parquet", "pressure.npz"}
    assert set(inventory(result.folder)) == FILES | PRESSURE | more
    page = result.bytes("report.html").decode()
    assert "Contact force, elastic foundation" in page and "Largest contact pressure" in page
    with np.load(result.folder / "pressure.npz", allow_pickle=False) as maps:
        corners = maps["vertices"][maps["faces"]]
        each = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        np.testing.assert_allclose(maps["pressure"] @ each, result.table("pressure.csv")["force [N]"], rtol=1e-9)
        assert maps["frames"].tolist() == [0, 1, 2]
    again = done(area(result.folder, motion=poses(tmp_path, (0, 20, 0)), picture=True, **bodies(tmp_path)))
    assert set(inventory(again.folder)) == FILES


SECOND = "--modulus-moving"
LAYER: Given = {"--pressure": "true", "--modulus": "500MPa", "--poisson": "0.46"}
OPEN = stl_bytes(sphere(20.0, 4)[0], sphere(20.0, 4)[1][1:], "ball")
LID = stl_bytes(block(80.0, 80.0, 12.0, 8)[0], block(80.0, 80.0, 12.0, 8)[1][4:], "floor")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"--modulus": "500MPa"}, ("--modulus", "has no effect without --pressure")),
        ({"--facets": "flat"}, ("--facets", "has no effect without --pressure")),
        ({SECOND: "500MPa"}, (SECOND, "has no effect without --pressure")),
        ({**LAYER, "--thickness-moving": "3mm"}, ("--thickness-moving", f"has no effect without {SECOND}")),
        ({**LAYER, SECOND: "500MPa"}, ("--poisson-moving", f"is missing with {SECOND}")),
        (
            {**LAYER, SECOND: "500MPa", "--poisson-moving": "0.5"},
            ("--poisson-moving", "0.5 cannot be", "below 0.5"),
        ),
        ({"--piece": "1mm"}, ("--piece", "has no effect without --pressure")),
        ({**LAYER, "--modulus": None}, ("--modulus", "is missing with --pressure")),
        ({**LAYER, "--poisson": None}, ("--poisson", "is missing with --pressure")),
        ({**LAYER, "--poisson": "0.5"}, ("--poisson", "0.5 cannot be", "below 0.5")),
        ({**LAYER, "--poisson": "nan"}, ("--poisson", "nan is not a finite number")),
        ({**LAYER, "--modulus": "500"}, ("--modulus", "'500' is not a pressure", "500MPa")),
        ({**LAYER, "--modulus": "500N"}, ("--modulus", "'500N' is not a pressure")),
        ({**LAYER, "--modulus": "-5MPa"}, ("--modulus", "is not positive")),
        ({**LAYER, "--thickness": "0mm"}, ("--thickness", "0 mm cannot be the thickness")),
        ({**LAYER, "--thickness": "thick"}, ("--thickness", "'thick'")),
        ({**LAYER, "--piece": "0"}, ("--piece", "0 mm cannot be the edge")),
        ({**LAYER, "--piece": "1um"}, ("--piece", "pieces, more than", "give a longer edge")),
        ({**LAYER, "--foundation": "stiff"}, ("--foundation", "stiff")),
        ({**LAYER, "MOVING": lambda f: written(f / "ball.stl", OPEN)}, ("ball", "is open", "no depth")),
        ({**LAYER, "FIXED": lambda f: written(f / "floor.stl", LID)}, ("floor", "is open", "give a length")),
    ],
)
def test_refused(tmp_path: Path, changes: Given, said: tuple[str, ...]) -> None:
    refuse(tmp_path, changes, *said)
