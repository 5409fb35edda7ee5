"""`geocontact modulus --free adduction` and `slope`: from tables of areas, from meshes, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.io.recordings.area_table import OFFSET
from tests.cli.calls import FEMUR, INSERT, agree, area, done, gait, poses, written
from tests.cli.test_modulus import areas, forces, modulus, told
from tests.elsewhere import Elsewhere
from tests.identify.synthetic_contact import DURATION, TRUE

MEDIAL, LATERAL, WHOLE = (f"area_fixed{side} [mm^2]" for side in ("_medial", "_lateral", ""))
PER_DEGREE = 0.1  # share of a side's area that a degree takes or gives at the start; half at the end
SOME = range(0, 96, 10)


def tilted(folder: Path, *degrees: float) -> list[Path]:
    """A table for each offset."""
    base = pd.read_csv(areas(folder))
    files = []
    for each in degrees:
        grown = PER_DEGREE * (1.0 - 0.5 * base["time [s]"] / DURATION) * each
        table = base.assign(**{MEDIAL: base[MEDIAL] * (1 - grown), LATERAL: base[LATERAL] * (1 + grown)})
        table[OFFSET] = each
        table[WHOLE] = table[MEDIAL] + table[LATERAL]
        files.append(folder / f"areas_{each:g}.csv")
        table.to_csv(files[-1], index=False, float_format="%.12g")
    return files


def pressed(folder: Path, table: pd.DataFrame) -> Path:
    """Forces by the law of both sides' areas at 4 mm."""
    rows = table[table["threshold [mm]"] == 4.0]
    columns = {"time [s]": rows["time [s]"]}
    for side, name in (("medial", MEDIAL), ("lateral", LATERAL)):
        columns[f"{side} [N]"] = 4.0 / 3.0 * TRUE * (rows[name] * 1e-6 / np.pi) ** 1.5 / 0.037
    pd.DataFrame(columns).to_csv(folder / "pressed.csv", index=False, float_format="%.12g")
    return folder / "pressed.csv"


def test_adduction_from_tables_at_several_offsets(tmp_path: Path, elsewhere: Elsewhere) -> None:
    files = tilted(tmp_path, -2.0, 0.0, 2.0, 0.8)
    force = pressed(tmp_path, pd.read_csv(files.pop()))
    others = [word for file in files[1:] for word in ("--area", file)]
    trial = [word for file in files for word in ("--predict-area", file)]
    given = (*others, "--free", "adduction", *trial, "--predict-force", force)
    result = done(elsewhere(modulus, tmp_path, *given, area=files[0], force=force, picture=True, bootstrap=0))
    m = told(result)
    assert m["side"] == "both" and m["compartments"] == {} and m["frames"] == 56
    assert m["adduction_deg"] == pytest.approx(0.8, abs=1e-3) and m["E_star_Pa"] == pytest.approx(TRUE, rel=1e-4)
    assert m["intervals"]["adduction"]["unit"] == "deg" and m["identifiable"] == ["E*", "adduction"]
    curves = result.table("curves.csv")
    assert list(curves["side"].unique()) == ["medial", "lateral"] and m["window_s"] == [0.0, DURATION]
    np.testing.assert_allclose(curves["predicted [N]"], curves["measured [N]"], rtol=1e-3)
    page = (result.folder / "report.html").read_text(encoding="utf-8")
    assert "adduction" in page and "Contact force, lateral" in page
    assert {side: p["r2"] for side, p in m["prediction"].items()} == pytest.approx(
        {"medial": 1.0, "lateral": 1.0}, abs=1e-6
    )


def test_tables_at_offsets_without_a_free_one_are_those_at_none(tmp_path: Path, elsewhere: Elsewhere) -> None:
    files = tilted(tmp_path, 2.0, 0.0)
    m = told(done(elsewhere(modulus, tmp_path, "--area", files[1], area=files[0], bootstrap=0,
                             force=pressed(tmp_path, pd.read_csv(files[1])))))  # fmt: skip
    assert m["compartments"]["medial"]["E_star_Pa"] == pytest.approx(TRUE, rel=1e-5)


def test_offset_of_a_motion_is_that_of_its_poses(tmp_path: Path) -> None:
    """--adduction x=1.5 is the same as poses that were turned by hand."""
    rows = [(1.0, 30.2, -0.5)]
    half = np.radians(0.75)
    turned = [(*row, np.cos(half), np.sin(half), 0.0, 0.0) for row in rows]
    how = ("--split", "z", "--rule", "clip")
    ours = done(area(tmp_path / "a", "--adduction", "x=1.5", *how, motion=poses(tmp_path, *rows))).table()
    assert (ours.pop(OFFSET) == 1.5).all()
    byhand = poses(tmp_path, *turned, name="turned.csv")
    agree(ours, done(area(tmp_path / "b", *how, motion=byhand)).table(), areas=1e-5)


def test_adduction_from_meshes(tmp_path: Path, elsewhere: Elsewhere) -> None:
    """Areas of the sample knee at three offsets; forces by the law of areas at an offset between them."""
    motion, found = gait(tmp_path, SOME), {}
    for degrees in (-1.5, 0.0, 1.5, 0.6):
        turn = ("--adduction", f"x={degrees}") if degrees else ()
        out = tmp_path / f"at {degrees}"
        found[degrees] = done(elsewhere(area, out, "--split", "z", "--rule", "clip", *turn, moving=FEMUR, fixed=INSERT,
                                   motion=motion)).folder / "area.csv"  # fmt: skip
    force = pressed(tmp_path, pd.read_csv(found[0.6]))
    others = ("--area", found[0.0], "--area", found[1.5])
    m = told(
        done(elsewhere(modulus, tmp_path, *others, "--free", "adduction", area=found[-1.5], force=force, bootstrap=0))
    )
    assert m["adduction_deg"] == pytest.approx(0.6, abs=0.1) and m["E_star_Pa"] == pytest.approx(TRUE, rel=0.02)
    assert m["identifiability"]["free"]["verdict"] == "told apart"


def test_slope_of_the_radius(tmp_path: Path, elsewhere: Elsewhere) -> None:
    time = np.linspace(0.0, DURATION, 56)
    flexion = np.radians(50.0) * np.sin(np.pi * time / DURATION) ** 2
    rows = "\n".join(f"{t!r},{-float(np.degrees(f))!r}" for t, f in zip(time.tolist(), flexion.tolist(), strict=True))
    motion = written(tmp_path / "knee.csv", f"time [s],knee [deg]\n{rows}\n")
    force = pd.read_csv(forces(tmp_path, sides=False))
    force["total [N]"] /= 1.0 - 0.25 * flexion
    force.to_csv(tmp_path / "bent.csv", index=False)
    given = ("--flexion", motion, "--map", "flexion=-knee")
    m = told(done(elsewhere(modulus, tmp_path, "--free", "slope", *given, force=tmp_path / "bent.csv", bootstrap=0)))
    assert m["slope_per_rad"] == pytest.approx(-0.25, abs=1e-4) and m["E_star_Pa"] == pytest.approx(TRUE, rel=1e-4)
    assert any("only how it changes with flexion" in line for line in m["not_identifiable"])
    still = written(tmp_path / "still.csv", "time [s],knee [deg]\n0,-30\n1.2,-30\n")
    flat = ("--free", "slope", "--flexion", still, "--map", "flexion=-knee")
    result = done(elsewhere(modulus, tmp_path, *flat, force=tmp_path / "bent.csv", bootstrap=0))
    m = told(result)
    assert "slope" not in m["identifiable"]
    assert any("slope is not identifiable" in line for line in m["not_identifiable"])
    assert any("E*, slope are one number" in line for line in result.warnings)


REFUSED = {
    "plain table": (("--free", "adduction"), "needs areas at 3 offsets of it or more"),
    "no motion": (("--free", "slope"), "slope needs --flexion"),
    "idle motion": (("--flexion", "x.csv"), "does nothing without --profile or --free slope"),
    "prediction": (("--free", "slope", "--flexion", "x.csv", "--predict-area", "x.csv"), "do not go together"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused_in_one_line(tmp_path: Path, name: str) -> None:
    options, words = REFUSED[name]
    result = modulus(tmp_path, *options)
    assert (result.code, result.out) == (2, "") and words in result.err
    assert len(result.complaints) == 1 and not result.folder.exists()


def test_bounds_beyond_what_is_known_are_refused(tmp_path: Path) -> None:
    files = tilted(tmp_path, -2.0, 0.0, 2.0)
    others = ("--area", files[1], "--area", files[2])
    wide = modulus(tmp_path, *others, "--free", "adduction=-3:3", area=files[0], force=forces(tmp_path))
    assert wide.code == 2 and "reaches beyond the areas, -2 to 2 degrees" in wide.err
    without = modulus(tmp_path, "--area", files[2], area=files[0], force=forces(tmp_path))
    assert without.code == 2 and "give those without an offset as well" in without.err
    motion = written(tmp_path / "knee.csv", "time [s],flexion [deg]\n0,0\n1.2,60\n")
    steep = modulus(tmp_path, "--free", "slope=-2:0", "--flexion", motion)
    assert steep.code == 2 and "the radius would vanish" in steep.err


@pytest.mark.parametrize("text", ["2", "w=2", "x=", "x=90", "x=nan"])
def test_an_offset_that_is_none_is_refused(tmp_path: Path, text: str) -> None:
    result = area(tmp_path / "out", "--adduction", text, motion=gait(tmp_path))
    assert result.code == 2 and "--adduction" in result.err and len(result.complaints) == 1
    assert not result.folder.exists()
