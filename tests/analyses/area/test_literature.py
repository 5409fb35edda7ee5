"""Areas beside published ones: flexion from a sweep, a convention or a column, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError
from tests.analyses.area.calls import area, pressed
from tests.cli.calls import FEMUR, INSERT, gait, unpictured


def angles(folder: Path, name: str = "flexion", sign: float = 1.0) -> Path:
    """The knee at two flexions [deg], the femoral component 30 mm above the insert's origin."""
    file = folder / "angles.csv"
    rows = [f"{time},{sign * value},0,0,0,30.4,0" for time, value in ((0, 0.0), (1, 20.0))]
    head = f"time [s],{name} [deg],adduction [deg],rotation [deg],tx [mm],ty [mm],tz [mm]"
    file.write_text("\n".join([head, *rows]) + "\n")
    return file


def test_a_knee_convention_knows_its_flexion(tmp_path: Path) -> None:
    options = {"convention": "grood-suntay", "side": "right", "moving_body": "parent", "rule": "clip"}
    result = area(FEMUR, INSERT, angles(tmp_path), compare=Path("literature"), threshold=(1e-4, 1e-3, 4e-3), **options)
    table = result.table("literature").set_index("published")
    film = table.loc["film 1995, seven implants"]
    assert film["comparable"] == "no" and "presses nothing" in film["why"]
    flexion = result.bodies.flexions
    assert flexion is not None
    np.testing.assert_allclose(np.degrees(flexion[""]), [0.0, 20.0])
    natural = table.loc["Fukubayashi 1980, with menisci"]
    own = np.interp(1150e-6, result.area[0], result.thresholds)
    assert 0.3 * own < natural["threshold_least [mm]"] * 1e-3 < 3.0 * own, "from the first frame, at 0 degrees"
    assert result.accepted and result.table("literature")["doi"].str.startswith("10.").sum() > 5


def test_poses_need_the_name_of_a_column_for_their_flexion(tmp_path: Path) -> None:
    named = angles(tmp_path, "bend", -1.0)
    mapped = {"map": "rz=-bend,ty=ty", "rule": "clip", "compare": Path("literature")}
    result = area(FEMUR, INSERT, named, flexion="-bend", **mapped)
    assert result.bodies.flexions is not None
    np.testing.assert_allclose(np.degrees(result.bodies.flexions[""]), [0.0, 20.0])
    assert not area(FEMUR, INSERT, gait(tmp_path), rule="clip", compare=Path("literature")).bodies.flexions


def test_a_sweep_of_flexion_is_known_and_no_walk(tmp_path: Path) -> None:
    sweep = ("flexion", 0.0, 0.2, 0.2)
    result = area(FEMUR, INSERT, sweep=sweep, axis="0,30,0,0,0,1", place_moving=None, compare=Path("literature"))
    table = result.table("literature").set_index("published")
    assert table.loc["JW 2015, peak of five walks", "why"] == "it is the peak of a walk, this run sweeps an angle"
    with unpictured():
        out = result.write(tmp_path / "out")
    assert "read_in" in (out / "literature.csv").read_text()


def test_pressures_have_a_load(tmp_path: Path) -> None:
    layer = {"modulus": 463e6, "poisson": 0.46, "piece": 2e-3, "rule": "clip", "compare": Path("literature")}
    options = {"convention": "grood-suntay", "side": "right", "moving_body": "parent", **layer}
    result = pressed(FEMUR, INSERT, angles(tmp_path), **options)
    film = result.table("literature").set_index("published").loc["film 1995, seven implants"]
    assert film["comparable"] == "yes" or "that of this run" in film["why"]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"compare": Path("literature"), "tolerance": 0.1}, "areas of other implants accept or refuse nothing"),
        ({"compare": Path("measured.csv"), "flexion": "knee"}, "`flexion`: has no effect on your own table"),
        ({"flexion": "knee"}, "`flexion`: has no effect without `compare`"),
    ],
)
def test_options_without_effect_are_refused(tmp_path: Path, options: dict[str, object], words: str) -> None:
    with pytest.raises(InputError, match=words):
        area(FEMUR, INSERT, gait(tmp_path), **options)
