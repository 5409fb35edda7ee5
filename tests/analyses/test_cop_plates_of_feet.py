"""Force plates beside several feet of a model: found by place, and their differences by hand.

Forces and centres of the feet are those of `test_cop_feet.feet_by_hand`, which knows nothing of the package.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.force_plate import sum_of
from geocontact.data.wrench import Wrench
from geocontact.io.opensim.storage_writer import write_storage
from tests.analyses.test_cop_feet import FEET, TIME, coordinates, feet_by_hand, model

MORE, OFF = np.array([3.0, -5.0, 2.0]), np.array([2e-3, 0.0, -1e-3])
"""What a plate has more than its foot [N], and how far its centre of pressure is off [m]."""
pytestmark = pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")


def loads() -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Force and centre of what lies under each foot."""
    hand = feet_by_hand("hunt")
    return {side: (own["force"] + MORE, own["cop"] * [1.0, 0.0, 1.0] + OFF) for side, own in hand.items()}


def plates(folder: Path, under: dict[str, tuple[np.ndarray, np.ndarray]]) -> Path:
    """A file of plates by name in the order given, without free moment."""
    names, values = [], []
    for name, (force, centre) in under.items():
        names += [f"{name}_{kind}{axis}" for kind in "vp" for axis in "xyz"]
        names += [f"{name.replace('force', 'torque')}_{axis}" for axis in "xyz"]
        values += [force, centre, np.zeros_like(force)]
    write_storage(folder / "grf.mot", TIME, names, np.hstack(values), title="Plates, synthetic", degrees=False)
    return folder / "grf.mot"


def asked(folder: Path, under: dict[str, tuple[np.ndarray, np.ndarray]], **more: object) -> dict[str, object]:
    given = {"motion": coordinates(folder), "body": FEET, "gate": 1.0, "compare": plates(folder, under)}
    return given | more


@pytest.mark.parametrize("order", ["rl", "lr"])
def test_each_foot_is_beside_the_plate_under_it(tmp_path: Path, order: str) -> None:
    """The order of the plates has no effect; names do not say a side."""
    under = {f"n{k}_force": loads()[side] for k, side in enumerate(order)}
    result = gc.centre_of_pressure(model(tmp_path, "hunt"), **asked(tmp_path, under))
    table = result.tables()["comparison"]
    assert list(dict.fromkeys(table["foot"])) == ["foot_r", "foot_l"]
    hand = feet_by_hand("hunt")
    for side, rows in table.groupby("foot"):
        own = hand[str(side)[-1]]
        found = rows[[f"plate_force_{axis} [N]" for axis in "xyz"]].to_numpy()
        np.testing.assert_allclose(found, own["force"] + MORE, rtol=1e-8)
        for k, axis in enumerate("xyz"):
            np.testing.assert_allclose(rows[f"difference_force_{axis} [N]"], -MORE[k], atol=1e-5)
        for k, axis in ((0, "x"), (2, "z")):
            np.testing.assert_allclose(rows[f"difference_cop_{axis} [m]"], -OFF[k], atol=1e-8)
    out = Path(result.write(tmp_path / "out"))
    noted = json.loads((out / "run.json").read_text())["results"]
    assert noted["comparison foot_l"]["rms_force_y [N]"] == pytest.approx(5.0, abs=1e-5)
    assert "foot_r: difference to the force plate" in (out / "report.html").read_text()
    assert len(pd.read_csv(out / "comparison.csv", comment="#")) == 2 * len(TIME)


def test_plates_in_a_row_under_one_foot_are_added_up(tmp_path: Path) -> None:
    """A third of the load on one plate, the rest on the next, both at the same place: the whole load."""
    force, centre = loads()["r"]
    under = {"n0_force": (force / 3.0, centre), "n1_force": loads()["l"], "n2_force": (force / 1.5, centre)}
    result = gc.centre_of_pressure(model(tmp_path, "hunt"), **asked(tmp_path, under))
    rows = result.tables()["comparison"].query("foot == 'foot_r'")
    np.testing.assert_allclose(rows["plate_force_y [N]"], force[:, 1], rtol=1e-8)
    np.testing.assert_allclose(rows["plate_cop_x [m]"], centre[:, 0], atol=1e-8)


def test_lost_samples_of_one_plate_are_no_load(tmp_path: Path) -> None:
    """Two plates of a foot, of one of which a fifth of the samples are missing: there is no difference there."""
    force, centre = loads()["r"]
    part = force / 3.0
    gone = slice(len(TIME) // 4, len(TIME) // 4 + len(TIME) // 5)
    part[gone] = np.nan
    under = {"n0_force": (part, centre), "n1_force": loads()["l"], "n2_force": (force / 1.5, centre)}
    result = gc.centre_of_pressure(model(tmp_path, "hunt"), **asked(tmp_path, under))
    rows = result.tables()["comparison"].query("foot == 'foot_r'")
    assert rows["plate_force_y [N]"].isna().to_numpy()[gone].all()
    known = rows["plate_force_y [N]"].notna().to_numpy()
    assert known.sum() == len(TIME) - len(TIME) // 5
    np.testing.assert_allclose(rows["plate_force_y [N]"][known], force[known, 1], rtol=1e-8)


def test_the_sum_of_plates_is_unknown_where_one_is() -> None:
    """A moment that is not a number counts as none where nobody stands on the plate."""
    force = np.array([[0.0, 700.0, 0.0], [0.0, 0.0, 0.0], [np.nan, 1.0, 1.0], [0.0, 700.0, 0.0]])
    moment = np.array([[1.0, 2.0, 3.0], [np.nan, np.nan, np.nan], [1.0, 1.0, 1.0], [np.nan, 0.0, 0.0]])
    lost = Wrench(force, moment, np.zeros_like(force), "ground")
    whole = Wrench(np.ones_like(force), np.ones_like(force), np.zeros_like(force), "ground")
    total, about = sum_of([lost, whole])
    np.testing.assert_array_equal(total, force + 1.0)
    np.testing.assert_array_equal(about, [[2.0, 3.0, 4.0], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0], [np.nan, 1.0, 1.0]])


def test_plates_of_turned_sign_say_so(tmp_path: Path) -> None:
    """As with one foot; where the other foot has its plate, in a warning."""
    (right, at), (left, beside) = loads().values()
    turned = {"n0_force": (-right, at), "n1_force": (-left, beside)}
    with pytest.raises(InputError, match=r"n0_force: its force along y.*that is the force on the plate.*turn the sign"):
        gc.centre_of_pressure(model(tmp_path, "hunt"), **asked(tmp_path, turned))
    with pytest.warns(InputWarning, match=r"n1_force: its force along y.*that is the force on the plate"):
        gc.centre_of_pressure(model(tmp_path, "hunt"), **asked(tmp_path, turned | {"n0_force": (right, at)}))


def test_plates_may_be_named_in_the_order_of_the_feet(tmp_path: Path) -> None:
    under = {"n0_force": loads()["l"], "n1_force": loads()["r"]}
    result = gc.centre_of_pressure(model(tmp_path, "hunt"), **asked(tmp_path, under, plate="n1_force,n0_force"))
    np.testing.assert_allclose(result.tables()["comparison"]["difference_force_y [N]"], 5.0, atol=1e-5)
    spaced = gc.centre_of_pressure(model(tmp_path, "hunt"), **asked(tmp_path, under, plate="n1_force, n0_force"))
    assert spaced.tables()["comparison"].equals(result.tables()["comparison"])
    for twice in ("n0_force,n0_force", "n0_force,1"):
        with pytest.raises(InputError, match=f"`plate`: {twice} names a plate twice; name each plate once"):
            gc.centre_of_pressure(model(tmp_path, "hunt"), **asked(tmp_path, under, plate=twice))
    with pytest.raises(InputError, match="names 1 plate for 2 feet; name one for each foot"):
        gc.centre_of_pressure(model(tmp_path, "hunt"), **asked(tmp_path, under, plate="n1_force"))


def test_a_foot_without_a_plate_is_named(tmp_path: Path) -> None:
    with pytest.warns(InputWarning, match="no plate is under foot_l alone: not compared"):
        result = gc.centre_of_pressure(model(tmp_path, "hunt"), **asked(tmp_path, {"n0_force": loads()["r"]}))
    assert set(result.tables()["comparison"]["foot"]) == {"foot_r"}


def test_one_plate_of_both_feet_and_plates_elsewhere_are_refused(tmp_path: Path) -> None:
    """Half-way the centre is 0.1 m from either foot; where one foot bears more, the question is asked."""
    (right, at), (left, beside) = loads().values()
    both = {"n0_force": (right + left, 0.5 * (at + beside))}
    share = (right[:, 1] / (right + left)[:, 1])[:, None]
    uneven = {"n0_force": (right + left, share * at + (1.0 - share) * beside)}
    with pytest.warns(InputWarning, match="does n0_force carry both feet"):
        gc.centre_of_pressure(model(tmp_path, "hunt"), **asked(tmp_path, uneven))
    aside = np.array([0.0, 0.0, 2.0])
    away = {f"n{k}_force": (force, centre + aside) for k, (force, centre) in enumerate(loads().values())}
    for under in (both, away):
        with pytest.raises(InputError, match=r"no plate is under one foot alone; the nearest is .* m from one"):
            gc.centre_of_pressure(model(tmp_path, "hunt"), **asked(tmp_path, under))


@pytest.mark.parametrize("one", [{"toe": "x"}, {"stances": True}])
def test_what_is_of_one_foot_says_what_to_do(tmp_path: Path, one: dict[str, object]) -> None:
    given = asked(tmp_path, {"n0_force": loads()["r"]}, **one)
    remedy = r"`body` names 2; give `body` foot_r\+toes_r, then run it again with foot_l\+toes_l"
    with pytest.raises(InputError, match=remedy):
        gc.centre_of_pressure(model(tmp_path, "hunt"), **given)
