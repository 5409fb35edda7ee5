"""`geocontact elbow population`: what it writes for people of a known distribution, and what it refuses."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from unittest import mock

import numpy as np
import pytest
from scipy import stats

from benchmarks.elbow_population import drawn
from geocontact.analyses.stale_results import NAMES
from geocontact.axis_misalignment.population import Exposure, peak_forces
from tests.cli.calls import ROOT, Call, call, done, inventory, written

FILES = {
    "population.json", "quantiles.csv", "exceedance.csv", "influence.csv", "population.png", "population.svg",
    "report.html", "run.json",
}  # fmt: skip
PARTS = {
    "k": 'unit = "N/m"\nvalue = 200',
    "l": 'unit = "cm"\nvalue = 20',
    "z": 'unit = "mm"\nvalue = 0',
    "x": 'unit = "mm"\nvalue = 0',
    "y": 'unit = "mm"\nnormal = { mean = 0, sd = 0.01 }',
}
"""Force k |y| (1 - cos 120°) to first order: half normal with a scale of 200 N/m · 0.01 mm · 1.5 = 3 mN."""

SCALE = 3e-3


def description(folder: Path, **changes: str) -> Path:
    parts = {**PARTS, **changes}
    return written(folder / "people.toml", "\n".join(f"[{name}]\n{text}" for name, text in parts.items() if text))


def population(
    folder: Path, *options: object, samples: int = 5000, limit: float = 6e-3, picture: bool = False, **changes: str
) -> Call:
    """The command; most of its time are figure and page, which only one test looks at."""
    with ExitStack() as stack:
        if not picture:
            stack.enter_context(unpictured())
        given = ["--range=0:120deg", f"--limit={limit}", f"--samples={samples}", f"--out={folder / 'out'}"]
        return call("elbow", "population", description(folder, **changes), *given, *options, folder=folder / "out")


@contextmanager
def unpictured() -> Iterator[None]:
    """Neither figure nor page are made."""
    with ExitStack() as stack:
        for name in ("population_figure", "save_both", "write_population_report"):
            stack.enter_context(
                mock.patch(f"geocontact.analyses.misalignment.population.write.{name}", return_value=b"")
            )
        yield


def told(result: Call) -> dict:
    return json.loads((result.folder / "population.json").read_text(encoding="utf-8"))


def test_a_half_normal_force(tmp_path: Path) -> None:
    result = done(population(tmp_path, samples=40_000, picture=True))
    assert set(inventory(result.folder)) == FILES <= NAMES
    m = told(result)
    true = stats.halfnorm(scale=SCALE)
    assert m["above_limit"]["lower"] < true.sf(6e-3) < m["above_limit"]["upper"]
    for share, one in m["quantiles_N"].items():
        assert one["lower"] <= true.ppf(float(share)) * (1 + 1e-3) and one["upper"] >= true.ppf(float(share)) * (
            1 - 1e-3
        )
        assert one["value"] == pytest.approx(true.ppf(float(share)), rel=0.08)
    rows = result.table("exceedance.csv")
    np.testing.assert_allclose(rows["probability [-]"], true.sf(rows["force [N]"]), atol=0.01)
    assert (rows["lower [-]"] <= rows["probability [-]"]).all() and (rows["probability [-]"] <= rows["upper [-]"]).all()
    assert m["synthetic"] and "synthetic people" in result.out
    page = (result.folder / "report.html").read_text(encoding="utf-8")
    assert "The people are synthetic" in page and "Probability of more" in page


def test_the_same_seed_gives_the_same_numbers(tmp_path: Path) -> None:
    runs = []
    for name, seed in (("a", 3), ("b", 3), ("c", 4)):
        (tmp_path / name).mkdir()
        runs.append(done(population(tmp_path / name, f"--seed={seed}")).folder / "population.json")
    one, again, other = (path.read_bytes() for path in runs)
    assert one == again != other


def test_where_the_spread_comes_from(tmp_path: Path) -> None:
    k = 'unit = "N/m"\nuniform = { lower = 199, upper = 201 }'
    rows = done(population(tmp_path, k=k)).table("influence.csv").set_index("quantity")
    assert list(rows.index) == ["k", "y"]
    assert rows.loc["y", "sobol_first"] == pytest.approx(1.0, abs=0.01) and rows.loc["k", "sobol_total"] < 0.01
    assert rows.loc["y", "distance_rank_coefficient"] > 0.99 and abs(rows.loc["y", "rank_coefficient"]) < 0.05


def test_correlated_offsets_have_ranks_only(tmp_path: Path) -> None:
    x = 'unit = "mm"\nnormal = { mean = 0, sd = 0.01 }'
    result = done(population(tmp_path, "--keep", x=x, correlation="x_y = -0.8"))
    samples = result.table("samples.csv")
    assert np.corrcoef(samples["x [mm]"], samples["y [mm]"])[0, 1] == pytest.approx(-0.8, abs=0.02)
    columns = [samples["k [N/m]"], *(samples[f"{name} [mm]"] / 1e3 for name in "lzxy")]
    want = peak_forces(np.column_stack(columns), Exposure(0.0, np.radians(120.0)))[0]
    np.testing.assert_allclose(samples["peak_force [N]"], want, rtol=1e-6)
    assert result.table("influence.csv")["sobol_first"].isna().all()
    assert any("factors are correlated" in line for line in result.warnings)


def test_people_of_a_table_are_drawn_whole(tmp_path: Path) -> None:
    written(tmp_path / "measured.csv", "who,x [mm],y [mm]\na,1,10\nb,2,20\nc,3,30\n")
    table = 'table = "measured.csv"'
    result = done(population(tmp_path, "--keep", x=table, y=table, limit=5.0))
    samples = result.table("samples.csv")
    np.testing.assert_allclose(samples["y [mm]"], 10.0 * samples["x [mm]"])
    assert set(samples["x [mm]"].round(9)) == {1.0, 2.0, 3.0}
    assert set(result.table("influence.csv")["factor"]) == {"x and y"}
    assert [entry["role"] for entry in result.record()["inputs"]] == ["description", "table"]


def test_a_stroke_takes_the_force_away(tmp_path: Path) -> None:
    y = 'unit = "mm"\nuniform = { lower = 0, upper = 20 }'
    locked = told(done(population(tmp_path, y=y, limit=2.0)))["quantiles_N"]["0.95"]["value"]
    free = told(done(population(tmp_path, "--stroke-mm=0:10", y=y, limit=2.0)))["quantiles_N"]["0.95"]["value"]
    assert free == pytest.approx(locked - 200.0 * 0.01, abs=1e-6)


def test_samples_without_a_force_are_counted_and_named(tmp_path: Path) -> None:
    x = 'unit = "mm"\nuniform = { lower = 150, upper = 250 }'
    y = 'unit = "mm"\nuniform = { lower = -200, upper = 200 }'
    result = done(population(tmp_path, x=x, y=y, limit=10.0))
    m = told(result)
    assert m["without_a_force"]["fold"] == pytest.approx(2500, abs=150) and m["without_a_force"]["pole"] > 500
    assert m["above_limit"]["value"] > 0.5 and m["quantiles_N"]["0.99"]["value"] is None
    lines = "\n".join(result.warnings)
    assert "the offset x is longer than the link" in lines and "tan γ has a pole" in lines
    assert "the first: k = 200 N/m" in lines and "no shares of the variance" in lines


def test_the_people_of_the_page_are_those_of_the_benchmark(tmp_path: Path) -> None:
    text = (ROOT / "docs/how-to/elbow_design.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```toml\n(.*?)```", text, re.DOTALL)
    file = written(tmp_path / "people.toml", block)
    options = ("--range=0:120deg", "--limit=10", "--samples=1000", "--seed=5", "--keep", f"--out={tmp_path / 'out'}")
    with unpictured():
        result = done(call("elbow", "population", file, *options, folder=tmp_path / "out"))
    people = drawn(1000, 5)
    np.testing.assert_allclose(result.table("samples.csv")["x [mm]"], people[:, 3] * 1e3, rtol=1e-9)
    np.testing.assert_allclose(result.table("samples.csv")["k [N/m]"], people[:, 0], rtol=1e-9)


@pytest.mark.parametrize(
    ("options", "changes", "said"),
    [
        ([], {"y": ""}, "no [y]"),
        ([], {"w": "value = 1"}, "[w]"),
        ([], {"y": 'unit = "mm"\nvalue = 3'}, "the same for everybody"),
        ([], {"y": 'unit = "N"\nvalue = 3'}, "unit is 'N'"),
        ([], {"y": 'unit = "mm"\nvalue = 3\nnormal = { mean = 0, sd = 1 }'}, "told in 2 ways"),
        ([], {"y": 'unit = "mm"\nnormal = { mean = 0 }'}, "sd is missing"),
        ([], {"y": 'unit = "mm"\nnormal = { mean = 0, sd = 0 }'}, "sd is not above 0"),
        ([], {"y": 'unit = "mm"\nnormal = { mean = 0, sd = 1, most = 2 }'}, "'most' is not known"),
        ([], {"y": 'unit = "mm"\nuniform = { lower = 2, upper = 1 }'}, "upper is not above lower"),
        ([], {"k": 'unit = "N/m"\nuniform = { lower = -1, upper = 200 }'}, "samples of k are not above 0"),
        ([], {"correlation": "x_y = 0.4"}, "x is told by value"),
        ([], {"correlation": "y_y = 0.4"}, "no pair"),
        ([], {"y": 'table = "nowhere.csv"'}, "nowhere.csv"),
        (["--samples=10"], {}, "--samples"),
        (["--seed=-1"], {}, "--seed"),
        (["--range=0:120"], {}, "--range"),
    ],
)
def test_refused_in_one_line(tmp_path: Path, options: list[str], changes: dict[str, str], said: str) -> None:
    result = population(tmp_path, *options, **changes)
    assert result.code == 2
    (line,) = result.complaints
    assert said in line and not (tmp_path / "out").exists()
