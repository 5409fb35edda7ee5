"""`prosthesis keel`: planted compressions, the study's, and what cannot be."""

from __future__ import annotations

import re
import shutil
import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.prosthesis.foot_file import foot_of
from geocontact.identify.goodness_of_fit import of_residual
from meshes import bench_foot
from tests.cli.calls import MESHES

BENCH = MESHES / "foot_bench"


def copied(folder: Path, *changes: tuple[str, str]) -> Path:
    """The bench's files with some words of the description changed."""
    shutil.copytree(BENCH, folder / "bench")
    file = folder / "bench" / "foot.toml"
    text = file.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    file.write_text(text)
    return file


def test_planted_numbers_are_inside_their_intervals_and_the_foot_goes_on(tmp_path: Path) -> None:
    """28 N m², 120 N/mm and 118 mm are Euler and Bernoulli by hand in `bench_foot`; the written foot is read again."""
    with pytest.warns(gc.InputWarning, match="the fit is doubtful: the sole is"):
        found = gc.prosthesis.keel(BENCH / "foot.toml")
    planted = {
        "EI, plate on the keel": bench_foot.BENDING,
        "in series": bench_foot.SERIES,
        "fulcrum of walking": bench_foot.FULCRUMS["walking"],
    }
    for name, value in planted.items():
        low, high = found.intervals[name]
        assert low < value < high and high / low < 1.05
    missed = "the sole is -0.0661 N/mm off the stiffness of soft, 3.03 times its standard deviation"
    assert found.warnings == (f"the fit is doubtful: {missed}",)  # the bench is a beam, and no sole on spheres
    foot = foot_of(found.write(tmp_path / "out") / "foot.toml")
    assert foot.keel.bending == found.foot.keel.bending and foot.record.settings["walking"] == found.beam.fulcrums[1]
    rows = found.table("compressions").set_index("compression")
    for name, place in bench_foot.FULCRUMS.items():
        assert rows.loc[name, "measured [N/m]"] == pytest.approx(1.0 / bench_foot.compliance(place), rel=0.01)
        assert rows.loc[name, "sole [N/m]"] == pytest.approx(1.0 / bench_foot.compliance(place), rel=0.02)
    with pytest.warns(gc.InputWarning, match="the fit is doubtful: the sole is .* off the stiffness of soft"):
        again = gc.prosthesis.keel(tmp_path / "out" / "foot.toml")
    assert again.bending == pytest.approx(found.bending, rel=0.005)


def test_the_shipped_foot_has_the_numbers_of_the_theory() -> None:
    """docs/theory/prosthesis_keel.md: 22.7 N m², 92 N/mm, 117.4 mm; on the sole 19.7 N m², 38.5 N/mm, within 0.7 %."""
    with pytest.warns(gc.InputWarning, match="nothing is over to test beam theory with"):
        found = gc.prosthesis.keel()
    values = found.table("keel").set_index("number")["value"]
    assert values["EI, plate on the keel"] == pytest.approx(22.7, abs=0.05)
    assert values["in series"] == pytest.approx(92e3, abs=500.0)
    assert values["fulcrum of medium"] == pytest.approx(0.1174, abs=5e-5)
    assert values["EI, plate on the sole"] == pytest.approx(foot_of(None).keel.bending, rel=1e-6)
    assert values["stiffness of a sphere, forefoot"] == pytest.approx(38.5e3, abs=50.0)
    rows = found.table("compressions")
    assert np.abs(rows["sole [N/m]"] / rows["measured [N/m]"] - 1.0).max() < 0.0075


SD = 0.06
"""N/mm, of each stiffness."""


def of_stiffnesses(folder: Path, off: float) -> Path:
    """The bench's foot with stiffnesses by Euler and Bernoulli in place of curves, that of firm `off` [N/mm]."""
    file = copied(folder)
    text = file.read_text()
    rows = ""
    for name, place in (bench_foot.FULCRUMS | {"softer": 0.09}).items():
        stiffness = 1e-3 / bench_foot.compliance(place) + off * (name == "firm")
        rows += f'\n[[compressions]]\nname = "{name}"\nfulcrum = {{ value = {1e3 * place:g}, unit = "mm" }}\n'
        rows += f'stiffness = {{ value = {stiffness:.6f}, unit = "N/mm" }}\nsd = {{ value = {SD}, unit = "N/mm" }}\n'
    file.write_text(text[: text.index("[[compressions]]")] + rows)
    return file


def test_one_stiffness_that_is_missed_is_said(tmp_path: Path) -> None:
    """By more than 3 of its standard deviations, where the mean square of all is still that of their errors."""
    said, off = {}, {}
    for planted in (0.0, 4.4 * SD):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", gc.InputWarning)
            found = gc.prosthesis.keel(of_stiffnesses(tmp_path / f"{planted:g}", planted))
        said[planted] = " ".join(found.warnings)
        rows = found.table("compressions")
        off[planted] = ((rows["beam [N/m]"] - rows["measured [N/m]"]) / rows["sd [N/m]"]).to_numpy()
    assert np.abs(off[0.0]).max() < 0.01 and "beam theory" not in said[0.0]
    missed = off[4.4 * SD]
    assert 3.0 < -missed[2] < 4.4 and np.abs(np.delete(missed, 2)).max() < 3.0
    assert not [*of_residual("stiffnesses", "", missed, 1.0)]
    times = f"{-missed[2]:.3g} times its standard deviation"
    assert f"beam theory is {missed[2] * SD:+.3g} N/mm off the stiffness of firm, {times}" in said[4.4 * SD]


def test_a_foot_that_is_no_beam_contradicts_its_curves(tmp_path: Path) -> None:
    """A soft setting that stiffens to twice its slope is not described, and the command ends with 1."""
    file = copied(tmp_path)
    curve = pd.read_csv(file.parent / "soft.csv")
    force = curve["force [N]"]
    curve["deflection [mm]"] -= 3.0 * (force / force.max()) ** 2
    curve.to_csv(file.parent / "soft.csv", index=False)
    with pytest.warns(gc.InputWarning, match="the result contradicts its data"):
        found = gc.prosthesis.keel(file)
    assert found.fit_outcome == "contradicts" and found.exit_code == 1
    assert "compression soft: residual 0.255 mm is 8.5 times the stated noise" in found.sentences[0]


def test_a_wrong_unit_of_the_curve_is_refused(tmp_path: Path) -> None:
    file = copied(tmp_path)
    curve = file.parent / "soft.csv"
    curve.write_text(curve.read_text().replace("[mm]", "[m]"))
    with pytest.raises(gc.InputError, match=r"soft\.csv deflection .* check the unit"):
        gc.prosthesis.keel(file)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('curve = "soft.csv"', 'curve = "none.csv"', "there is no file none.csv"),
        ('setting = "hard"\n', "", "[[compressions]] 4: needs a setting or a fulcrum"),
        ('setting = "hard"\n', 'setting = "harder"\n', "'harder' is none of the settings"),
        ('[bench]\n', '[bench]\nat = { value = 120, unit = "mm" }\n', "not in front of all fulcrums"),
        ("noise = { value = 0.03", "noise = { value = 0", "no deflection is measured so well"),
        ('setting = "soft"\n', 'fulcrum = { value = 30, unit = "mm" }\n', "30 mm is out of the fulcrum's range"),

        ('curve = "hard.csv"\n', 'stiffness = { value = 40, unit = "N/mm" }\n', "needs sd beside stiffness"),
    ],
)  # fmt: skip
def test_refused(tmp_path: Path, old: str, new: str, words: str) -> None:
    with pytest.raises(gc.InputError, match=re.escape(words)):
        gc.prosthesis.keel(copied(tmp_path, (old, new)))


def test_one_known_fulcrum_needs_the_stiffness_in_series(tmp_path: Path) -> None:
    changes = [(f'setting = "{name}"\n', f'setting = "{name}"\nsought = true\n') for name in ("firm", "hard")]
    file = copied(tmp_path, *changes)
    with pytest.raises(gc.InputError, match="need compressions at 2 known places of the fulcrum, there are 1"):
        gc.prosthesis.keel(file)
    file.write_text(file.read_text().replace("[bench]\n", '[bench]\nseries = { value = 120, unit = "N/mm" }\n'))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.prosthesis.keel(file)
    assert found.bending == pytest.approx(bench_foot.BENDING, rel=0.02)
    assert found.beam.fulcrums[3] == pytest.approx(bench_foot.FULCRUMS["hard"], abs=1e-3)


def test_the_bench_is_what_its_script_writes(tmp_path: Path) -> None:
    bench_foot.main(tmp_path)
    for file in sorted(BENCH.iterdir()):
        assert (tmp_path / file.name).read_text() == file.read_text(), file.name
