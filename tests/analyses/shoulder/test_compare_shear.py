"""Measured shear beside the simulated one: errors that were put in, friction limit, signs and axes; by hand."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from tests.shoulder_exoskeleton.arms import FITTING, lifted, raised

TIME = np.arange(601) * 0.01
NORMAL = 10.0 + 8.0 * raised(TIME)
ALONG = 4.0 * np.sin(1.3 * TIME) + 0.1 * NORMAL
AROUND = 2.0 * np.cos(2.9 * TIME)


def simulated(folder: Path, friction: float | None = 1.0) -> Path:
    """right.csv with the columns that the comparison reads, and numbers.csv beside it."""
    columns = {
        "time [s]": TIME,
        "phase": np.where((TIME > 1.0) & (TIME < 5.0), "lift", "rest"),
        "elevation [deg]": np.degrees(raised(TIME)),
        "supporting [N]": NORMAL,
        "normal [N]": NORMAL,
        "distal [N]": ALONG,
        "shear around [N]": AROUND,
        "shear [N]": np.hypot(ALONG, AROUND),
    }
    pd.DataFrame(columns).to_csv(folder / "right.csv", index=False)
    if friction is not None:
        (folder / "numbers.csv").write_text(f"number,value,unit\nmu_k,0.1,-\nmu_s,{friction},-\n", encoding="utf-8")
    return folder / "right.csv"


def recorded(folder: Path, **columns: np.ndarray) -> Path:
    pd.DataFrame({"time [s]": TIME, **columns}).to_csv(folder / "cell.csv", index=False)
    return folder / "cell.csv"


def test_errors_of_the_shear_are_those_by_hand(tmp_path: Path) -> None:
    """R², RMSD and bias of both parts and of their size, in numpy."""
    along, around = 0.8 * ALONG + 0.3, AROUND - 0.2 * np.sin(TIME)
    file = recorded(tmp_path, **{"normal [N]": NORMAL, "shear_along [N]": along, "shear_around [N]": around})
    found = gc.shoulder.compare(simulated(tmp_path), file)
    table = found.table().set_index(["channel", "phase"])
    for name, model, measured in (
        ("shear_along", ALONG, along),
        ("shear_around", AROUND, around),
        ("shear", np.hypot(ALONG, AROUND), np.hypot(along, around)),
    ):
        off = model - measured
        r2 = 1.0 - np.sum(off**2) / np.sum((measured - measured.mean()) ** 2)
        expected = [np.sqrt(np.mean(off**2)), np.mean(off), r2]
        assert table.loc[(name, "all"), ["rmsd", "bias", "r2 [-]"]].tolist() == pytest.approx(expected, abs=1e-9)
        assert table.loc[(name, "all"), "unit"] == "N"
    assert not found.warnings
    own = found.tables()["friction"].iloc[0]
    assert own["normal force"] == "recorded"
    ratio = np.hypot(along, around) / NORMAL
    assert own[["median ratio [-]", "largest ratio [-]"]].tolist() == pytest.approx([np.median(ratio), ratio.max()])
    assert "Shear beside the friction limit" in str(found.pages({})["report.html"])


def test_noise_of_a_slow_recording_is_no_shear_beyond_friction(tmp_path: Path) -> None:
    """A mat at 20 Hz beside 100 Hz, sliding at the limit: noise is that of the samples, not of lines between them."""
    slow = TIME[::5]
    rng = np.random.default_rng(4)
    shear = 0.5 * NORMAL[::5] + rng.normal(0.0, 0.3, len(slow))
    file = tmp_path / "cell.csv"
    pd.DataFrame({"time [s]": slow, "normal [N]": NORMAL[::5], "shear [N]": shear}).to_csv(file, index=False)
    with pytest.warns(gc.InputWarning, match="R² is") as seen:
        own = gc.shoulder.compare(simulated(tmp_path, 0.5), file).tables()["friction"].iloc[0]
    assert not [each for each in seen if "exceeds friction" in str(each.message)]
    assert own["noise [N]"] == pytest.approx(0.3, rel=0.2)
    assert own["beyond [-]"] < 0.01


@pytest.mark.parametrize(("factor", "words"), [(3.0, "doubtful: the measured shear exceeds"), (8.0, "contradicts")])
def test_shear_beyond_the_friction_limit_is_named(tmp_path: Path, factor: float, words: str) -> None:
    """Friction is that of the simulation, 0.2; share of the time and first moment by hand; a smooth course."""
    size = np.hypot(ALONG, AROUND)
    shear = factor * size / 3.0 * np.clip(TIME, 0.0, 1.0)
    file = recorded(tmp_path, **{"normal [N]": NORMAL, "shear [N]": shear})
    with pytest.warns(gc.InputWarning, match=words):
        found = gc.shoulder.compare(simulated(tmp_path, 0.2), file)
    over = shear > 0.2 * NORMAL
    own = found.tables()["friction"].iloc[0]
    assert own["friction [-]"] == 0.2
    assert own["beyond [-]"] == pytest.approx(over.mean(), abs=0.01)
    said = re.search(r"first at (\d\.\d\d) s", str(found))
    assert said is not None
    assert float(said[1]) == pytest.approx(TIME[np.argmax(over)], abs=0.02)


def test_friction_is_stated_or_that_of_the_simulation(tmp_path: Path) -> None:
    file = recorded(tmp_path, **{"shear [N]": np.hypot(ALONG, AROUND)})
    plain = simulated(tmp_path, None)
    with pytest.warns(gc.InputWarning) as seen:
        assert gc.shoulder.compare(plain, file).tables()["friction"]["friction [-]"][0] == 1.0
    said = " ".join(str(each.message) for each in seen)
    assert "no numbers.csv beside it" in said
    assert "no `normal` is recorded" in said
    with pytest.warns(gc.InputWarning, match="no `normal` is recorded"):
        assert gc.shoulder.compare(plain, file, friction=0.7).tables()["friction"]["friction [-]"][0] == 0.7
    other = recorded(tmp_path, **{"force [N]": NORMAL})
    with pytest.raises(gc.InputError, match="`friction`: has no effect without measured shear"):
        gc.shoulder.compare(plain, other, friction=0.7)
    (tmp_path / "numbers.csv").write_text("number,value\nmu_s,wood\n", encoding="utf-8")
    with pytest.raises(gc.InputError, match=r"numbers\.csv mu_s: 'wood' is not a number"):
        gc.shoulder.compare(plain, recorded(tmp_path, **{"shear [N]": np.hypot(ALONG, AROUND)}))


def test_signs_and_axes_are_checked(tmp_path: Path) -> None:
    plain = simulated(tmp_path)
    with pytest.raises(gc.InputError, match="a size is never below 0; name a part with a sign: `map` shear_along=NAME"):
        gc.shoulder.compare(plain, recorded(tmp_path, **{"shear [N]": ALONG}))
    with pytest.raises(gc.InputError, match="shear_along is larger than the shear that it is a part of"):
        gc.shoulder.compare(plain, recorded(tmp_path, **{"shear [N]": 0.5 * abs(ALONG), "shear_along [N]": ALONG}))
    turned = recorded(tmp_path, **{"normal [N]": NORMAL, "x [N]": -ALONG, "y [N]": AROUND})
    with pytest.warns(gc.InputWarning, match=r"shear_along: R² is .*: is a sign turned"):
        gc.shoulder.compare(plain, turned, map="shear_along=x,shear_around=y")
    assert not gc.shoulder.compare(plain, turned, map="shear_along=-x,shear_around=y").warnings
    with pytest.warns(gc.InputWarning, match="are the axes exchanged"):
        gc.shoulder.compare(plain, turned, map="shear_along=y,shear_around=-x")


@pytest.mark.parametrize("side", ["right", "left"])
def test_shear_around_is_the_friction_against_the_turn_of_the_place(side: str) -> None:
    """Both parts make the size, and what is around is the cross product of place and friction in the cuff's axes."""
    from geocontact.shoulder_exoskeleton.device import lucy
    from geocontact.shoulder_exoskeleton.simulate import simulate_arm

    arm = simulate_arm(lifted(side="right" if side == "right" else "left"), lucy(), FITTING, 1.0)
    place, friction = arm.outputs["place"], arm.outputs["friction"]
    outwards = place * [0.0, 1.0, 1.0]
    turned = np.cross(outwards, friction)[:, 0] / np.linalg.norm(outwards, axis=1)
    np.testing.assert_allclose(arm.shear_around, turned, atol=1e-12)
    assert np.abs(arm.shear_around).max() > 0.5
    whole = np.hypot(friction[:, 0], arm.shear_around)
    np.testing.assert_allclose(whole, arm.shear, atol=1e-3)  # radial friction is that of the rounded kink
