"""`geocontact modulus`: synthetic areas and forces with a known E*, what it writes, and what it refuses."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from unittest import mock

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.stale_results import NAMES
from geocontact.elastic_modulus.area_force import MODULUS
from tests.cli.calls import Call, call, done, inventory, written
from tests.identify.synthetic_contact import DURATION, THRESHOLDS, TRUE, synthetic_areas, synthetic_model

FILES = {"modulus.json", "curves.csv", "sensitivity.csv", "modulus.png", "modulus.svg", "report.html", "run.json"}
SHARE = 0.55  # of the area that is medial
LBF = 4.4482216152605


def areas(folder: Path, name: str = "area.csv", scale: float = 1.0, levels: slice = slice(None)) -> Path:
    """Synthetic areas of a step as `geocontact area` writes them, empty cells included."""
    time = np.linspace(0.0, DURATION, 56)
    rows = [
        {"time [s]": t, "threshold [mm]": T * 1e3, "area_fixed [mm^2]": a * 1e6, "centroid_x [mm]": np.nan,
         "signed": "none", "area_fixed_medial [mm^2]": SHARE * a * 1e6,
         "area_fixed_lateral [mm^2]": (1 - SHARE) * a * 1e6}
        for t, row in zip(time, synthetic_areas(time, scale), strict=True)
        for T, a in list(zip(THRESHOLDS, row, strict=True))[levels]
    ]  # fmt: skip
    pd.DataFrame(rows).to_csv(folder / name, index=False, float_format="%.12g")
    return folder / name


def forces(
    folder: Path,
    name: str = "forces.csv",
    unit: float = 1.0,
    head: str = "",
    sides: bool = True,
    late: float = 0.0,
    scale: float = 1.0,
) -> Path:
    """The law's own forces of those areas, at the area's times."""
    model = synthetic_model(frames=56)
    area = synthetic_areas(model.frames, scale)[:, 3]
    force = 4.0 / 3.0 * TRUE * (area / np.pi) ** 1.5 / 0.037
    if scale == 1.0:
        np.testing.assert_allclose(force, model.force({MODULUS: TRUE}), rtol=1e-12)
    columns = [force * SHARE**1.5, force * (1 - SHARE) ** 1.5] if sides else [force]
    head = head or ("time [s],medial [N],lateral [N]" if sides else "time [s],total [N]")
    rows = np.column_stack([model.frames + late, *(c / unit for c in columns)])
    return written(folder / name, "\n".join([head, *(",".join(map(repr, row)) for row in rows.tolist())]) + "\n")


def modulus(
    folder: Path,
    *options: object,
    area: Path | None = None,
    force: Path | None = None,
    radius: bool = True,
    picture: bool = False,
    bootstrap: int = 100,
) -> Call:
    """The command; most of its time are figure and page, which only some tests look at."""
    given = ["--area", area or areas(folder), "--force", force or forces(folder, sides=False)]
    more = ["--radius-mm", 37] if radius else []
    with ExitStack() as stack:
        if not picture:
            stack.enter_context(unpictured())
        arguments = ["modulus", *given, *more, "--out", folder / "out", "--bootstrap", bootstrap, *options]
        return call(*arguments, folder=folder / "out")


@contextmanager
def unpictured() -> Iterator[None]:
    """Neither figure nor page are made."""
    with ExitStack() as stack:
        for name in ("modulus_figure", "save_both", "write_modulus_report"):
            stack.enter_context(mock.patch(f"geocontact.analyses.modulus.write.{name}", return_value=b""))
        yield


def told(result: Call) -> dict:
    return json.loads((result.folder / "modulus.json").read_text(encoding="utf-8"))


def test_modulus_of_a_synthetic_step(tmp_path: Path) -> None:
    result = done(modulus(tmp_path, "--poisson", "0.25,0.46", picture=True))
    assert set(inventory(result.folder)) == FILES <= NAMES
    m = told(result)
    assert m["side"] == "total" and m["threshold_mm"] == 4.0 and m["reading"] == "disc"
    assert m["E_star_Pa"] == pytest.approx(TRUE, rel=1e-5)
    assert m["E_Pa"]["0.25"] == pytest.approx(TRUE * (1 - 0.0625), rel=1e-5)
    assert m["E_Pa"]["0.46"] == pytest.approx(TRUE * (1 - 0.2116), rel=1e-5)
    assert m["E_star_ci95_Pa"] == pytest.approx([TRUE, TRUE], rel=1e-4)
    assert m["identifiability"]["E, nu"]["verdict"] == "one number"
    assert m["identifiability"]["E, nu"]["condition"] is None
    assert any("E and nu are one number here" in line for line in m["not_identifiable"])
    curves = result.table("curves.csv")
    np.testing.assert_allclose(curves["predicted [N]"], curves["measured [N]"], rtol=1e-4)
    page = (result.folder / "report.html").read_text(encoding="utf-8")
    assert "E and nu are one number here" in page and "What was identified" in page
    assert "6.8 MPa" in result.out.replace("6.800", "6.8")


def test_compartments_have_moduli_of_their_own(tmp_path: Path) -> None:
    """Each side's law is exact; the total's is not, since sums of 1.5th powers are no such power of the sum."""
    m = told(done(modulus(tmp_path, force=forces(tmp_path))))
    assert set(m["compartments"]) == {"medial", "lateral"}
    for side in m["compartments"].values():
        assert side["E_star_Pa"] == pytest.approx(TRUE, rel=1e-5)
    assert m["E_star_Pa"] == pytest.approx(TRUE * (SHARE**1.5 + (1 - SHARE) ** 1.5), rel=1e-5)


def test_pounds_other_names_and_signs(tmp_path: Path) -> None:
    file = forces(tmp_path, "pull.csv", -LBF, "time,Fz", sides=False)
    m = told(done(modulus(tmp_path, "--unit", "lbf", "--map", "total=-Fz", force=file)))
    assert m["E_star_Pa"] == pytest.approx(TRUE, rel=1e-5)


def test_several_files_of_areas_are_one_table(tmp_path: Path) -> None:
    one, two = areas(tmp_path, "one.csv", levels=slice(0, 3)), areas(tmp_path, "two.csv", levels=slice(3, 5))
    result = done(modulus(tmp_path, "--area", two, area=one))
    assert told(result)["E_star_Pa"] == pytest.approx(TRUE, rel=1e-5)
    assert sorted(set(result.table("sensitivity.csv")["threshold [mm]"])) == [1, 2, 3, 4, 5]


def test_sensitivity_to_threshold_and_reading(tmp_path: Path) -> None:
    table = done(modulus(tmp_path)).table("sensitivity.csv").set_index(["reading", "threshold [mm]"])
    disc = table.loc["disc"]
    assert disc.loc[4.0, "E_star [Pa]"] == pytest.approx(TRUE, rel=1e-5) and disc.loc[4.0, "r2 [-]"] > 0.999999
    assert disc["E_star [Pa]"].is_monotonic_decreasing, "a larger area needs a smaller modulus for the same force"
    discs = table.loc["discs"]
    np.testing.assert_allclose(discs["E_star [Pa]"], np.sqrt(2.0) * disc["E_star [Pa]"], rtol=1e-9)
    assert "strip" not in table.index, "its length was not given"


def test_a_known_lag_and_an_unknown_one(tmp_path: Path) -> None:
    late = forces(tmp_path, "late.csv", sides=False, late=0.05)
    m = told(done(modulus(tmp_path, "--lag", 0.05, force=late)))
    assert m["E_star_Pa"] == pytest.approx(TRUE, rel=1e-5) and m["frames"] == 56
    m = told(done(modulus(tmp_path, "--free", "lag", force=late)))
    assert m["lag_s"] == pytest.approx(0.05, abs=2e-3) and m["E_star_Pa"] == pytest.approx(TRUE, rel=2e-3)
    assert m["intervals"]["lag"]["unit"] == "s"


def test_calibrated_threshold(tmp_path: Path) -> None:
    time = np.linspace(0.0, DURATION, 56)
    force = pd.read_csv(forces(tmp_path, sides=False))["total [N]"].to_numpy()
    area = synthetic_areas(time)[:, 2] * 1e6
    k = np.argsort(force)[[0, 20, 55]]
    rows = "\n".join(f"{force[i]:.9g},{area[i]:.9g}" for i in k)
    file = written(tmp_path / "cadaver.csv", f"force [N],area [mm^2]\n{rows}\n")
    m = told(done(modulus(tmp_path, "--calibrate", file)))
    assert m["calibration"]["threshold_mm"] == pytest.approx(3.0, abs=0.15)
    assert m["threshold_mm"] == m["calibration"]["threshold_mm"]


def test_a_trial_that_was_not_used(tmp_path: Path) -> None:
    other, measured = areas(tmp_path, "other.csv", scale=1.3), forces(tmp_path, "other_f.csv", sides=False, scale=1.3)
    result = done(modulus(tmp_path, "--predict-area", other, "--predict-force", measured))
    assert told(result)["prediction"]["total"]["r2"] == pytest.approx(1.0, abs=1e-6)
    table = result.table("prediction.csv")
    np.testing.assert_allclose(table["predicted [N]"], table["measured [N]"], rtol=1e-4)
    blind = done(modulus(tmp_path, "--predict-area", other))
    assert blind.table("prediction.csv")["measured [N]"].isna().all()


def test_radius_over_flexion(tmp_path: Path) -> None:
    profile = written(
        tmp_path / "profile.csv", "side,flexion [deg],radius [mm]\nwhole,-10,74\nwhole,0,74\nwhole,40,74\n"
    )
    motion = written(tmp_path / "knee.csv", "time [s],knee [deg]\n0,0\n1.2,-30\n")
    m = told(done(modulus(tmp_path, "--profile", profile, "--flexion", motion, "--map", "flexion=-knee", radius=False)))
    assert m["E_star_Pa"] == pytest.approx(2.0 * TRUE, rel=1e-5), "twice the radius takes twice the modulus"
    refused = modulus(tmp_path, "--profile", profile, "--flexion", motion, "--map", "flexion=knee", radius=False)
    assert refused.code == 2 and "flexion from -27.5 to 0.0" in refused.err


def test_forces_that_a_constant_would_meet_better_are_said(tmp_path: Path) -> None:
    time = np.linspace(0.0, DURATION, 56)
    area = synthetic_areas(time)[:, 3]
    rows = "\n".join(f"{t!r},{v!r}" for t, v in zip(time.tolist(), (3000.0 - 1.2e6 * area).tolist(), strict=True))
    result = done(modulus(tmp_path, force=written(tmp_path / "against.csv", f"time [s],total [N]\n{rows}\n")))
    assert any("a constant force would do better" in line for line in result.warnings)
    assert told(result)["r2"] < 0.0


REFUSED = {
    "no radius": (("--poisson", "0.3"), "or --profile: exactly one", False),
    "threshold not there": (("--threshold", "2.5"), "2.5 mm was not evaluated", True),
    "unknown beyond the areas": (("--free", "threshold=1:9"), "reaches beyond the areas", True),
    "no such unknown": (("--free", "nu"), "is none of threshold, lag, adduction, slope", True),
    "impossible ratio": (("--poisson", "0.6"), "is not above -1 and at most 0.5", True),
    "strip without length": (("--reading", "strip"), "--length-mm: is missing", True),
    "clocks apart": (("--lag", "50"), "0 frames of the area", True),
    "idle prediction": (("--predict-force", "x.csv"), "does nothing without --predict-area", True),
    "idle angles": (("--angles", "deg"), "does nothing without --flexion", True),
    "negative strip": (("--length-mm", "-5"), "is no length in mm", True),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused_in_one_line_with_nothing_left_behind(tmp_path: Path, name: str) -> None:
    options, words, radius = REFUSED[name]
    result = modulus(tmp_path, *options, radius=radius)
    assert (result.code, result.out) == (2, "") and words in result.err
    assert len(result.complaints) == 1 and not result.folder.exists()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("time [s],F1\n0,1\n1,2\n", "no column medial, lateral or total"),
        ("time [s],total\n0,1\n1,2\n", "--unit: is missing"),
        ("time [s],total [kN]\n0,100\n1,200\n", "forces reach 200000 N"),
        ("time [%],total [N]\n0,1\n100,2\n", "per cent of a cycle"),
    ],
)
def test_forces_that_cannot_be_used(tmp_path: Path, text: str, words: str) -> None:
    result = modulus(tmp_path, force=written(tmp_path / "bad.csv", text))
    assert result.code == 2 and words in result.err and not result.folder.exists()


def test_areas_that_cannot_be_used(tmp_path: Path) -> None:
    head = "time [s],threshold [mm],area_fixed [mm^2]"
    for text, words in (
        ("time [s],area\n0,1\n", "no column threshold [mm]"),
        (f"{head}\n0,4,1\n1,4,2\n", "2 frames are too few"),
        (f"{head}\n" + "".join(f"{k},4,{-k}\n" for k in range(9)), "not a number of 0 or more"),
        (f"{head}\n" + "".join(f"{k},{4 + k % 2},7\n" for k in range(9)), "each once"),
    ):
        result = modulus(tmp_path, area=written(tmp_path / "bad.csv", text))
        assert result.code == 2 and words in result.err
