"""E* from Python: synthetic areas and forces with a known modulus, sides, thresholds, lags, trials not used."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.modulus.goodness import radius_by_areas
from geocontact.analyses.modulus.identified import describe
from geocontact.analyses.modulus.result import ModulusResult, modulus
from geocontact.data.errors import InputError, InputWarning
from geocontact.elastic_modulus.area_force import ThresholdAreas
from tests.analyses.modulus.synthetic_step import LBF, SHARE, areas, forces, written
from tests.identify.synthetic_contact import DURATION, TRUE, synthetic_areas


def found(folder: Path, area: object = None, force: Path | None = None, **options: object) -> ModulusResult:
    """The identification of a synthetic step with R = 37 mm, without a bootstrap unless one is asked for."""
    given = {"radius": None if "profile" in options else 0.037, "bootstrap": 0, **options}
    return modulus(area or areas(folder), force or forces(folder, sides=False), **given)


def test_modulus_of_a_synthetic_step(tmp_path: Path) -> None:
    result = found(tmp_path, poisson=(0.25, 0.46), bootstrap=100)
    assert result.modulus == pytest.approx(TRUE, rel=1e-5)
    assert result.interval == pytest.approx((TRUE, TRUE), rel=1e-4)
    (row,) = result.table().to_dict("records")
    assert row["side"] == "total" and row["E_star [Pa]"] == result.modulus
    assert row["E at nu 0.25 [Pa]"] == pytest.approx(TRUE * (1 - 0.0625), rel=1e-5)
    assert row["E at nu 0.46 [Pa]"] == pytest.approx(TRUE * (1 - 0.2116), rel=1e-5)
    drawn = result.sides["total"].replicates
    assert drawn is not None and len(drawn.estimates) == 100
    curves = result.table("curves")
    np.testing.assert_allclose(curves["predicted [N]"], curves["measured [N]"], rtol=1e-4)
    assert list(result.tables()) == ["modulus", "curves", "sensitivity"]


def test_says_what_was_found_and_what_cannot_be(tmp_path: Path) -> None:
    result = found(tmp_path)
    first, second = str(result).splitlines()
    assert first.startswith("total: E* 6.8 MPa (95 % 6.8 … 6.8), RMSE 0 N, R² 1.00")
    assert second.startswith("E and ν are one number here")
    numbers = describe(result.found)
    assert numbers["side"] == "total" and numbers["threshold_mm"] == 4.0 and numbers["reading"] == "disc"
    assert numbers["identifiability"]["E, nu"]["verdict"] == "one number"
    assert numbers["identifiability"]["E, nu"]["condition"] is None
    assert any("E and nu are one number here" in line for line in numbers["not_identifiable"])
    assert result.record.results["modulus"] == numbers


@pytest.mark.slow
def test_compartments_have_moduli_of_their_own(tmp_path: Path) -> None:
    """Each side's law is exact; the total's is not, since sums of 1.5th powers are no such power of the sum."""
    result = found(tmp_path, force=forces(tmp_path))
    by_side = result.table().set_index("side")["E_star [Pa]"]
    assert list(by_side.index) == ["total", "medial", "lateral"]
    assert by_side["medial"] == pytest.approx(TRUE, rel=1e-5) and by_side["lateral"] == pytest.approx(TRUE, rel=1e-5)
    assert result.modulus == pytest.approx(TRUE * (SHARE**1.5 + (1 - SHARE) ** 1.5), rel=1e-5)
    assert set(describe(result.found)["compartments"]) == {"medial", "lateral"}


def test_pounds_other_names_and_signs(tmp_path: Path) -> None:
    file = forces(tmp_path, "pull.csv", -LBF, "time,Fz", sides=False)
    assert found(tmp_path, force=file, unit="lbf", map="total=-Fz").modulus == pytest.approx(TRUE, rel=1e-5)


def test_several_files_of_areas_are_one_table(tmp_path: Path) -> None:
    one, two = areas(tmp_path, "one.csv", levels=slice(0, 3)), areas(tmp_path, "two.csv", levels=slice(3, 5))
    result = found(tmp_path, area=(one, two))
    assert result.modulus == pytest.approx(TRUE, rel=1e-5)
    assert sorted(set(result.table("sensitivity")["threshold [mm]"])) == [1, 2, 3, 4, 5]


def test_sensitivity_to_threshold_and_reading(tmp_path: Path) -> None:
    table = found(tmp_path).table("sensitivity").set_index(["reading", "threshold [mm]"])
    disc = table.loc["disc"]
    assert disc.loc[4.0, "E_star [Pa]"] == pytest.approx(TRUE, rel=1e-5) and disc.loc[4.0, "r2 [-]"] > 0.999999
    assert disc["E_star [Pa]"].is_monotonic_decreasing, "a larger area needs a smaller modulus for the same force"
    discs = table.loc["discs"]
    np.testing.assert_allclose(discs["E_star [Pa]"], np.sqrt(2.0) * disc["E_star [Pa]"], rtol=1e-9)
    assert "strip" not in table.index, "its length was not given"


def test_threshold_is_in_metres(tmp_path: Path) -> None:
    result = found(tmp_path, threshold=0.003)
    assert result.sides["total"].model.threshold == pytest.approx(3e-3, rel=1e-12)
    row = result.table("sensitivity").query("reading == 'disc' and `threshold [mm]` == 3")
    assert result.modulus == pytest.approx(row["E_star [Pa]"].item(), rel=1e-9)
    assert result.modulus > 1.05 * TRUE, "a smaller area needs a larger modulus"


@pytest.mark.slow
def test_a_known_lag_and_an_unknown_one(tmp_path: Path) -> None:
    late = forces(tmp_path, "late.csv", sides=False, late=0.05)
    known = found(tmp_path, force=late, lag=0.05)
    assert known.modulus == pytest.approx(TRUE, rel=1e-5) and known.found.frames_once("total") == 56
    free = found(tmp_path, force=late, free={"lag": None})
    lag = free.sides["total"].profiles["lag"].best
    assert lag == pytest.approx(0.05, abs=2e-3) and free.modulus == pytest.approx(TRUE, rel=2e-3)


@pytest.mark.slow
def test_bounds_of_a_free_number_are_kept(tmp_path: Path) -> None:
    late = forces(tmp_path, "late.csv", sides=False, late=0.05)
    with pytest.warns(InputWarning) as said:
        free = found(tmp_path, force=late, free={"lag": (-0.02, 0.02)})
    assert free.sides["total"].profiles["lag"].best == pytest.approx(0.02, abs=1e-6)
    assert any("the data do not limit lag within its bounds" in str(each.message) for each in said)


def test_calibrated_threshold(tmp_path: Path) -> None:
    time = np.linspace(0.0, DURATION, 56)
    force = pd.read_csv(forces(tmp_path, sides=False))["total [N]"].to_numpy()
    area = synthetic_areas(time)[:, 2] * 1e6
    k = np.argsort(force)[[0, 20, 55]]
    rows = "\n".join(f"{force[i]:.9g},{area[i]:.9g}" for i in k)
    file = written(tmp_path / "cadaver.csv", f"force [N],area [mm^2]\n{rows}\n")
    result = found(tmp_path, calibrate=file)
    calibration = result.found.calibration
    assert calibration is not None and calibration.threshold == pytest.approx(3e-3, abs=0.15e-3)
    assert result.sides["total"].model.threshold == calibration.threshold


@pytest.mark.slow
def test_a_trial_that_was_not_used(tmp_path: Path) -> None:
    other, measured = areas(tmp_path, "other.csv", scale=1.3), forces(tmp_path, "other_f.csv", sides=False, scale=1.3)
    result = found(tmp_path, predict_area=other, predict_force=measured)
    (told,) = result.found.predictions
    assert told.r2 == pytest.approx(1.0, abs=1e-6)
    table = result.table("prediction")
    np.testing.assert_allclose(table["predicted [N]"], table["measured [N]"], rtol=1e-4)
    assert result.sentences[-1].startswith("total, trial not used: RMSE 0 N")
    blind = found(tmp_path, predict_area=other)
    assert blind.table("prediction")["measured [N]"].isna().all()


def test_radius_over_flexion(tmp_path: Path) -> None:
    profile = written(
        tmp_path / "profile.csv", "side,flexion [deg],radius [mm]\nwhole,-10,74\nwhole,0,74\nwhole,40,74\n"
    )
    motion = written(tmp_path / "knee.csv", "time [s],knee [deg]\n0,0\n1.2,-30\n")
    with pytest.warns(InputWarning, match=r"on a radius of 43.* R is 74 mm: is one of them a diameter"):
        result = found(tmp_path, profile=profile, flexion=motion, map="flexion=-knee")
    assert result.modulus == pytest.approx(2.0 * TRUE, rel=1e-5), "twice the radius takes twice the modulus"
    with pytest.raises(InputError, match=r"flexion from -27\.5 to 0\.0; extend `profile`"):
        found(tmp_path, profile=profile, flexion=motion, map="flexion=knee")


def test_an_area_that_ends_at_an_edge_shows_no_radius() -> None:
    """A paraboloid's area grows alike with every threshold; medially in trial og1 by ever less; two show nothing."""
    thresholds = np.array([1.0, 2.0, 3.0, 4.0, 5.0])

    def shown(grown: list[float]) -> float:
        area = 1e-6 * 2.0 * np.pi * np.cumsum([[20.0, *grown]] * 3, axis=1)
        count = len(grown) + 1
        return radius_by_areas(ThresholdAreas(np.arange(3.0), 1e-3 * thresholds[:count], area, np.full(3, 0.037), 0.06))

    assert shown([37.0, 35.0, 39.0, 37.0]) == pytest.approx(0.037, rel=0.03)
    assert np.isnan(shown([52.0, 15.4, 4.0, 1.9])) and np.isnan(shown([37.0]))


def test_forces_that_a_constant_would_meet_better_are_said(tmp_path: Path) -> None:
    time = np.linspace(0.0, DURATION, 56)
    area = synthetic_areas(time)[:, 3]
    rows = "\n".join(f"{t!r},{v!r}" for t, v in zip(time.tolist(), (3000.0 - 1.2e6 * area).tolist(), strict=True))
    with pytest.warns(InputWarning) as said:
        result = found(tmp_path, force=written(tmp_path / "against.csv", f"time [s],total [N]\n{rows}\n"))
    # the doubt has become a contradiction: such an E* has no interval, and the command ends with 1
    assert "R² is -0.97, a constant would describe it better" in str(said[0].message)
    assert result.table()["r2 [-]"].item() < 0.0 and result.fit_outcome == "contradicts"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"radius": None}, "`radius`: or `profile`: exactly one"),
        (
            {"radius": 37.0},
            "`radius`: 37000 mm cannot be the radius of a contact: that is 0.1 to 10000 mm; is 37 mm meant?",
        ),
        ({"poisson": 0.6}, "`poisson`: 0.6 cannot be Poisson's ratio: that is -0.9999 to 0.5"),
        ({"free": {"nu": None}}, "`free`: 'nu' is none of threshold, lag, adduction, slope"),
        ({"free": {"lag": (0.1, -0.1)}}, "`free`: lag: 0.1 to -0.1 has no room"),
        ({"free": {"threshold": None}, "calibrate": "x.csv"}, "`free`: threshold with `calibrate` says it twice"),
        ({"calibrate": "x.csv", "threshold": 0.004}, "`calibrate`: finds what `threshold` gives"),
        ({"profile": "x.csv", "radius": None}, "`flexion`: is missing with `profile`"),
        ({"bootstrap": 20}, "`bootstrap`: 20 is not 100 to 100000"),
        ({"reading": "circle"}, "`reading`: 'circle' is not a choice; one of disc, discs, strip, cap, threshold"),
    ],
)
def test_refused_before_a_file_is_read(options: dict[str, object], words: str) -> None:
    with pytest.raises(InputError) as refused:
        modulus("none.csv", "none.csv", **{"radius": 0.037, **options})
    assert words in str(refused.value)
