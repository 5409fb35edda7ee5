"""Synthetic recordings of an exoskeleton: as asked for, reproducible, and refused where no force is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from tests.analyses.misalignment.trials import PAPER, QUICK, STROKE, recorded

simulate = gc.misalignment.simulate


def test_trials_are_as_asked_and_the_truth_is_told() -> None:
    result = simulate(**QUICK, stroke=STROKE, pressure=gc.mmHg(10, 60))
    trials = [f"{kind}_{k}" for kind in ("locked", "free") for k in (1, 2, 3)]
    assert list(result.tables()) == [*trials, "surfaces", "numbers"]
    table = result.table("free_1")
    recorded = ["time [s]", "beta [deg]", "force [N]", "displacement [mm]", "pressure [mmHg]"]
    assert list(table) == [*recorded, "gamma [deg]", "cuff_moment [N m]"]
    assert len(table) == 1001 and table["displacement [mm]"].min() == pytest.approx(-10.0, abs=0.05)
    assert table["beta [deg]"].min() == pytest.approx(8.0, abs=0.05)
    assert 10.0 < table["pressure [mmHg]"].iloc[0] < 60.0
    assert result.truth["synthetic"] is True and result.truth["stroke_mm"] == pytest.approx([-10.0, 60.0])
    numbers = {"k_N_per_m": 222.43, "x_mm": 48.0, "y_mm": 59.0, "l_mm": 169.0, "z_mm": 127.0}
    assert result.truth["numbers"] == pytest.approx(
        {**numbers, "b_N_s_per_m": 0.0, "s_per_mmHg": 0.0, "c_mm_per_N": 0.0}
    )
    assert result.numbers == pytest.approx({**PAPER, "l": 0.169, "z": 0.127, "b": 0.0, "s": 0.0, "c": 0.0})
    low, high = result.trials[0].force.min(), result.trials[0].force.max()
    assert str(result).startswith(f"locked_1, synthetic: {low:.1f} … {high:.1f} N over 8 … 92°, 20 s")


def test_the_same_seed_gives_the_same_recordings() -> None:
    one, two, other = (simulate(**QUICK, seed=seed) for seed in (4, 4, 5))
    first = [result.trials[0].force for result in (one, two, other)]
    np.testing.assert_array_equal(first[0], first[1])
    assert not np.array_equal(first[0], first[2]) and not np.array_equal(first[0], one.trials[1].force)


def test_forces_along_recorded_angles(tmp_path: Path) -> None:
    file = tmp_path / "walk.csv"
    file.write_text("time [s],hinge [deg]\n0,20\n1,60\n2,90\n3,120\n")
    numbers = {"k": 300.0, "x": 0.03, "y": 0.04, "l": 0.17, "z": 0.1}
    result = simulate((file,), map="beta=hinge", numbers=numbers)
    assert result.trials[0].force[2] == pytest.approx(9.947513684, rel=1e-9)  # the right angle worked by hand
    assert [trial.name for trial in result.trials] == ["simulated_walk"]


def test_the_cuffs_pressure_is_heeded_along_a_recording(tmp_path: Path) -> None:
    file = recorded(tmp_path, pressure=gc.mmHg(10, 60)) / "locked_1.csv"
    stiff, plain = (simulate((file,), numbers={"s": s}).trials[0] for s in (1e-4, 0.0))
    assert stiff.pressure is not None
    np.testing.assert_allclose(stiff.force, plain.force * (1.0 + 1e-4 * (stiff.pressure - stiff.pressure.mean())))


def test_surfaces_are_those_of_the_link() -> None:
    table = simulate(**QUICK, numbers={"l": 0.2, "z": 0.08}).table("surfaces")
    row = table[(table["beta [deg]"] == 0.0) & (table["offset [mm]"].abs() < 1e-9)]
    assert row["d_tot over x [mm]"].item() == pytest.approx(0.0, abs=1e-12)
    assert table["offset [mm]"].max() == pytest.approx(0.6 * 200.0) and table["beta [deg]"].max() == 135.0


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"range": (8.0, 92.0)}, "458.366 deg cannot be an angle of an elbow: that is -30 to 180 deg; is 8 deg meant?"),
        ({"range": gc.deg(8, 9)}, "hardly a range"),
        ({"range": gc.deg(0, 190)}, "190 deg cannot be an angle of an elbow"),
        ({"stroke": gc.mm(10, -10)}, "`stroke`: its upper end is below"),
        ({"band": (0.3, 0.1)}, "`band`: has no room"),
        ({"numbers": {"q": 1.0}}, "'q' is not a number of the law; these are k, x, y, l, z, b, s, c"),
        ({"numbers": {"s": 1e-4}}, "give `pressure`"),
        ({"seed": -1}, "`seed`: -1 is not 0 or more"),
        ({"recordings": (Path("a.csv"),), "noise": 0.1}, "`noise`: has no effect along a recording; leave it out"),
        ({"recordings": (Path("a/x.csv"), Path("b/x.csv"))}, "two recordings are named 'x'"),
    ],
)
def test_what_cannot_be_is_refused_in_si(given: dict, said: str) -> None:
    with pytest.raises(gc.InputError) as refused:
        simulate(**given)
    assert said in str(refused.value)
