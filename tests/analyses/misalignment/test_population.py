"""The largest force over synthetic people of a known distribution."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats

import geocontact as gc
from benchmarks.elbow.population import drawn
from geocontact.axis_misalignment.design import Exposure, peak_forces
from geocontact.view.page.content import Table
from tests.analyses.misalignment.trials import quietly

ROOT = Path(__file__).resolve().parents[3]
PARTS = {
    "k": 'unit = "N/m"\nvalue = 200',
    "l": 'unit = "cm"\nvalue = 20',
    "z": 'unit = "mm"\nvalue = 0',
    "x": 'unit = "mm"\nvalue = 0',
    "y": 'unit = "mm"\nnormal = { mean = 0, sd = 0.01 }',
}
"""Force k |y| (1 - cos 120°) to first order: half normal with a scale of 200 N/m · 0.01 mm · 1.5 = 3 mN."""
SCALE = 3e-3
USUAL: dict[str, Any] = {"range": gc.deg(0, 120), "limit": 6e-3, "samples": 5000}


def described(folder: Path, **changes: str) -> Path:
    """A description whose parts are those above, or others."""
    file = folder / "people.toml"
    file.write_text("\n".join(f"[{name}]\n{text}" for name, text in (PARTS | changes).items() if text))
    return file


def population(file: Path, **options: Any) -> Any:
    """People of a description."""
    return quietly(lambda _, **given: gc.misalignment.population(file, **given), **USUAL | options)


def test_a_half_normal_force(tmp_path: Path) -> None:
    result = population(described(tmp_path), samples=40_000)
    true = stats.halfnorm(scale=SCALE)
    beyond = result.drawn.beyond
    assert beyond.lower < true.sf(6e-3) < beyond.upper
    for share, one in result.drawn.quantiles.items():
        expected = true.ppf(share)
        assert one.lower <= expected * (1 + 1e-3) and one.upper >= expected * (1 - 1e-3)
        assert one.value == pytest.approx(expected, rel=0.08)
    rows = result.table("exceedance")
    np.testing.assert_allclose(rows["probability [-]"], true.sf(rows["force [N]"]), atol=0.01)
    assert (rows["lower [-]"] <= rows["probability [-]"]).all() and (rows["probability [-]"] <= rows["upper [-]"]).all()
    assert result.summary["synthetic"] is True
    assert str(result).startswith("largest |F| of 40000 synthetic people: median ")


def test_the_same_seed_gives_the_same_numbers(tmp_path: Path) -> None:
    one, again, other = (population(described(tmp_path), seed=seed).summary for seed in (3, 3, 4))
    assert one == again != other


def test_where_the_spread_comes_from(tmp_path: Path) -> None:
    k = 'unit = "N/m"\nuniform = { lower = 199, upper = 201 }'
    rows = population(described(tmp_path, k=k)).table("influence").set_index("quantity")
    assert list(rows.index) == ["k", "y"]
    assert rows.loc["y", "sobol_first"] == pytest.approx(1.0, abs=0.01) and rows.loc["k", "sobol_total"] < 0.01
    assert rows.loc["y", "distance_rank_coefficient"] > 0.99 and abs(rows.loc["y", "rank_coefficient"]) < 0.05


def test_correlated_offsets_have_ranks_only(tmp_path: Path) -> None:
    x = 'unit = "mm"\nnormal = { mean = 0, sd = 0.01 }'
    result = population(described(tmp_path, x=x, correlation="x_y = -0.8"), keep=True)
    samples = result.table("samples")
    assert np.corrcoef(samples["x [mm]"], samples["y [mm]"])[0, 1] == pytest.approx(-0.8, abs=0.02)
    columns = [samples["k [N/m]"], *(samples[f"{name} [mm]"] / 1e3 for name in "lzxy")]
    want = peak_forces(np.column_stack(columns), Exposure(0.0, np.radians(120.0)))[0]
    np.testing.assert_allclose(samples["peak_force [N]"], want, rtol=1e-9)
    assert result.table("influence")["sobol_first"].isna().all()
    assert any("factors are correlated" in line for line in result.warnings)


def test_people_of_a_table_are_drawn_whole(tmp_path: Path) -> None:
    (tmp_path / "measured.csv").write_text("who,x [mm],y [mm]\na,1,10\nb,2,20\nc,3,30\n")
    table = 'table = "measured.csv"'
    result = population(described(tmp_path, x=table, y=table), keep=True, limit=5.0)
    samples = result.table("samples")
    np.testing.assert_allclose(samples["y [mm]"], 10.0 * samples["x [mm]"])
    assert set(samples["x [mm]"].round(9)) == {1.0, 2.0, 3.0}
    assert set(result.table("influence")["factor"]) == {"x and y"}
    assert [entry["role"] for entry in result.record.inputs] == ["description", "table"]


def test_a_stroke_takes_the_force_away(tmp_path: Path) -> None:
    file = described(tmp_path, y='unit = "mm"\nuniform = { lower = 0, upper = 20 }')
    locked, free = (population(file, stroke=stroke, limit=2.0) for stroke in (None, gc.mm(0, 10)))
    assert free.drawn.quantiles[0.95].value == pytest.approx(locked.drawn.quantiles[0.95].value - 2.0, abs=1e-6)


def test_samples_without_a_force_are_counted_and_named(tmp_path: Path) -> None:
    x = 'unit = "mm"\nuniform = { lower = 150, upper = 250 }'
    y = 'unit = "mm"\nuniform = { lower = -200, upper = 200 }'
    result = population(described(tmp_path, x=x, y=y), limit=10.0)
    m = result.summary
    assert m["without_a_force"]["fold"] == pytest.approx(2500, abs=150) and m["without_a_force"]["pole"] > 500
    assert m["above_limit"]["value"] > 0.5 and m["quantiles_N"]["0.99"]["value"] is None
    # half of them have no force: such a description is of no people, and that is the first sentence, not a warning
    first, lines = result.sentences[0], "\n".join(result.warnings)
    assert result.fit_outcome == "contradicts"
    assert "the offset x is longer than the link" in first and "tan γ has a pole" in first
    assert "the first: k = 200 N/m" in first and "no shares of the variance" in lines


def test_the_people_of_the_how_to_are_those_of_the_benchmark(tmp_path: Path) -> None:
    text = (ROOT / "docs/how-to/elbow_design.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"people.toml << 'END'\n(.*?)^END", text, re.DOTALL | re.MULTILINE)
    file = tmp_path / "people.toml"
    file.write_text(block)
    result = population(file, limit=10.0, samples=1000, seed=5)
    np.testing.assert_allclose(result.drawn.people, drawn(1000, 5), rtol=1e-12)


def test_a_stiffness_in_another_unit_than_meant_is_asked_about(tmp_path: Path) -> None:
    """222 N/mm are 222 kN/m; the number stands in the file, so the question is about it."""
    file = tmp_path / "people.toml"
    rows = ['[k]\nunit = "N/mm"\nnormal = { mean = 222, sd = 40, lower = 50 }']
    rows += [f'[{name}]\nunit = "mm"\nnormal = {{ mean = {mean}, sd = 5 }}' for name, mean in
             (("l", 180), ("z", 100), ("x", 0), ("y", 0))]  # fmt: skip
    file.write_text("\n".join(rows), encoding="utf-8")
    with pytest.warns(gc.InputWarning) as heard:
        gc.misalignment.population(file, range=gc.deg(0, 120), limit=1e4, samples=1000, seed=1)
    (line,) = [str(w.message) for w in heard if "[k]" in str(w.message)]
    assert line.endswith("[k] mean: 222000 N/m is unusual for the stiffness of an attachment, which mostly is "
                         "10 to 100000 N/m; is 222 N/m meant?")  # fmt: skip


def test_a_deviation_in_another_unit_is_refused_with_the_likely_one(tmp_path: Path) -> None:
    """15 m for 15 mm about 0; a mean says nothing there."""
    with pytest.raises(gc.InputError, match=r"\[x\] sd: .*is 15 mm meant\?"):
        population(described(tmp_path, x='unit = "m"\nnormal = { mean = 0, sd = 15 }'))


def test_the_page_has_no_infinite_force_and_names_of_quantities(tmp_path: Path) -> None:
    """Offsets about as long as the link: more than 5 % have no force."""
    wide = 'unit = "mm"\nnormal = { mean = 0, sd = 120 }'
    page = population(described(tmp_path, x=wide), limit=10.0).pages({})["report.html"]
    texts = [text for _, text in page.facts] + [
        cell for section in page.sections if isinstance(section, Table) for row in section.rows for cell in row
    ]
    assert dict(page.facts)["95 % stay below"] == "no finite force"
    assert not any(re.search(r"\b(inf|nan)\b", text) for text in texts)
    assert any("offset across the upper arm (x)" in text for text in texts)
