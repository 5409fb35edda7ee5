"""Free adduction and slope from Python: areas at several offsets, a radius that follows flexion, bounds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.modulus.identified import describe
from geocontact.analyses.modulus.result import modulus
from geocontact.data.errors import InputError, InputWarning
from tests.analyses.modulus.synthetic_step import areas, forces, pressed, tilted, written
from tests.identify.synthetic_contact import DURATION, TRUE

KNOWN = {"radius": 0.037, "bootstrap": 0}


@pytest.mark.slow
def test_adduction_from_tables_at_several_offsets(tmp_path: Path) -> None:
    files = tilted(tmp_path, -2.0, 0.0, 2.0, 0.8)
    force = pressed(tmp_path, pd.read_csv(files.pop()))
    trial = {"predict_area": files, "predict_force": force}
    with pytest.warns(InputWarning, match=r"`predict_area` has the areas of `area`, sample by sample"):
        result = modulus(files, force, free={"adduction": None}, **trial, **KNOWN)
    numbers = describe(result.found)
    assert numbers["side"] == "both" and numbers["compartments"] == {} and numbers["frames"] == 56
    assert numbers["adduction_deg"] == pytest.approx(0.8, abs=1e-3)
    assert result.modulus == pytest.approx(TRUE, rel=1e-4)
    assert numbers["intervals"]["adduction"]["unit"] == "deg" and numbers["identifiable"] == ["E*", "adduction"]
    curves = result.table("curves")
    assert list(curves["side"].unique()) == ["medial", "lateral"] and numbers["window_s"] == [0.0, DURATION]
    np.testing.assert_allclose(curves["predicted [N]"], curves["measured [N]"], rtol=1e-3)
    told = {p.side: p.r2 for p in result.found.predictions}
    assert told == pytest.approx({"medial": 1.0, "lateral": 1.0}, abs=1e-6)
    page = result.page(tmp_path / "page.html").read_text(encoding="utf-8")
    assert "adduction" in page and "Contact force, lateral" in page


@pytest.mark.slow
def test_tables_at_offsets_without_a_free_one_are_those_at_none(tmp_path: Path) -> None:
    files = tilted(tmp_path, 2.0, 0.0)
    result = modulus(files, pressed(tmp_path, pd.read_csv(files[1])), **KNOWN)
    assert result.sides["medial"].modulus == pytest.approx(TRUE, rel=1e-5)


def knee(folder: Path, flexion: np.ndarray, name: str = "knee.csv") -> Path:
    """A motion whose column is minus the flexion [rad], evenly over the step."""
    time = np.linspace(0.0, DURATION, len(flexion))
    rows = "\n".join(f"{t!r},{-float(np.degrees(f))!r}" for t, f in zip(time.tolist(), flexion.tolist(), strict=True))
    return written(folder / name, f"time [s],knee [deg]\n{rows}\n")


def bent(folder: Path, flexion: np.ndarray) -> Path:
    """Total forces of a radius that shrinks by a quarter per rad of flexion."""
    force = pd.read_csv(forces(folder, sides=False))
    force["total [N]"] /= 1.0 - 0.25 * flexion
    force.to_csv(folder / "bent.csv", index=False)
    return folder / "bent.csv"


FLEXION = np.radians(50.0) * np.sin(np.pi * np.linspace(0.0, 1.0, 56)) ** 2


@pytest.mark.slow
def test_slope_of_the_radius(tmp_path: Path) -> None:
    motion = {"flexion": knee(tmp_path, FLEXION), "map": "flexion=-knee"}
    result = modulus(areas(tmp_path), bent(tmp_path, FLEXION), free={"slope": None}, **motion, **KNOWN)
    assert result.sides["total"].profiles["slope"].best == pytest.approx(-0.25, abs=1e-4)
    assert result.modulus == pytest.approx(TRUE, rel=1e-4)
    assert any("only how it changes with flexion" in line for line in result.not_identifiable)


@pytest.mark.slow
def test_slope_of_a_knee_that_stays_bent_is_not_identifiable(tmp_path: Path) -> None:
    motion = {"flexion": knee(tmp_path, np.full(2, np.radians(30.0))), "map": "flexion=-knee"}
    with pytest.warns(InputWarning) as said:
        result = modulus(areas(tmp_path), bent(tmp_path, FLEXION), free={"slope": None}, **motion, **KNOWN)
    assert "slope" not in describe(result.found)["identifiable"]
    assert any("slope is not identifiable" in line for line in result.not_identifiable)
    assert any("E*, slope are one number" in str(each.message) for each in said)


def test_bounds_beyond_what_is_known_are_refused(tmp_path: Path) -> None:
    files = tilted(tmp_path, -2.0, 0.0, 2.0)
    force = forces(tmp_path)
    wide = {"free": {"adduction": (-np.radians(3.0), np.radians(3.0))}}
    with pytest.raises(InputError, match="adduction of -3 to 3 degrees reaches beyond the areas, -2 to 2 degrees"):
        modulus(files, force, **wide, **KNOWN)
    with pytest.raises(InputError, match="give those without an offset as well"):
        modulus([files[0], files[2]], force, **KNOWN)
    with pytest.raises(InputError, match="threshold of 1 to 9 mm reaches beyond the areas, 1 to 5 mm"):
        modulus(areas(tmp_path), force, free={"threshold": (1e-3, 9e-3)}, **KNOWN)
    motion = written(tmp_path / "knee.csv", "time [s],flexion [deg]\n0,0\n1.2,60\n")
    with pytest.raises(InputError, match="the radius would vanish"):
        modulus(areas(tmp_path), force, free={"slope": (-2.0, 0.0)}, flexion=motion, **KNOWN)
    with pytest.raises(InputError, match="needs areas at 3 offsets of it or more"):
        modulus(areas(tmp_path), force, free={"adduction": None}, **KNOWN)
