"""`geocontact elbow population`: what it writes, says and refuses; its numbers are tested as an analysis."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import pytest

import geocontact as gc
from tests.analyses.misalignment.test_population import described
from tests.cli.calls import Call, done, inventory
from tests.cli.elbow_calls import elbow, same_csv, unpictured

FILES = {"population.json", "quantiles.csv", "exceedance.csv", "influence.csv", "population.png", "population.svg"}
FILES |= {"report.html", "run.json"}


USUAL = {"--range": "0:120deg", "--limit": 0.006, "--samples": 5000}


def population(
    folder: Path, options: Mapping[str, object] | None = None, *flags: str, picture: bool = False, **changes: str
) -> Call:
    """The command for people of whom one offset differs, or others."""
    given = [f"{name}={value}" for name, value in {**USUAL, **(options or {})}.items()]
    return elbow("population", folder / "out", described(folder, **changes), *given, *flags, picture=picture)


def test_a_population_with_its_figure_and_page(tmp_path: Path) -> None:
    result = done(population(tmp_path, picture=True))
    assert set(inventory(result.folder)) == FILES
    m = json.loads(result.bytes("population.json"))
    assert m["synthetic"] and m["samples"] == 5000 and m["limit_N"] == 0.006
    assert "5000 synthetic people" in result.out
    page = (result.folder / "report.html").read_text(encoding="utf-8")
    assert "The people are synthetic" in page and "Probability of more" in page
    assert result.record()["results"]["population"] == m


@pytest.mark.filterwarnings("ignore:.*is unusual for")
def test_python_draws_as_the_command_does(tmp_path: Path) -> None:
    typed = done(population(tmp_path, {"--seed": 3, "--stroke-mm": "-0.01:0.02"}, "--keep")).folder
    file, span = tmp_path / "people.toml", gc.deg(0, 120)
    stroke = gc.mm(-0.01, 0.02)
    result = gc.misalignment.population(file, range=span, limit=6e-3, samples=5000, seed=3, keep=True, stroke=stroke)
    with unpictured():
        files = same_csv(result.write(tmp_path / "python"), typed)
    assert files == ["exceedance.csv", "influence.csv", "quantiles.csv", "samples.csv"]


@pytest.mark.parametrize(
    ("options", "changes", "said"),
    [
        ({}, {"y": ""}, "no [y]"),
        ({}, {"w": "value = 1"}, "w: is not known here"),
        ({}, {"y": 'unit = "mm"\nvalue = 3'}, "the same for everybody"),
        ({}, {"k": 'unit = "N/m"\nvalue = 0.22'}, "[k] value: 0.22 N/m cannot be the stiffness of an attachment"),
        ({}, {"l": 'unit = "m"\nnormal = { mean = 185, sd = 10 }'}, "[l] mean: 185000 mm cannot be a link"),
        ({}, {"y": 'unit = "N"\nvalue = 3'}, "[y] unit: 'N' is not a unit of it"),
        ({}, {"y": 'unit = "mm"\nvalue = 3\nnormal = { mean = 0, sd = 1 }'}, "[y]: is described in 2 ways"),
        ({}, {"y": 'unit = "mm"\nnormal = { mean = 0 }'}, "[y.normal]: no sd"),
        ({}, {"y": 'unit = "mm"\nnormal = { mean = 0, sd = 0 }'}, "[y.normal] sd: is not above 0"),
        ({}, {"y": 'unit = "mm"\nnormal = { mean = 0, sd = 1, most = 2 }'}, "[y.normal] most: is not known"),
        ({}, {"y": 'unit = "mm"\nuniform = { lower = 2, upper = 1 }'}, "[y.uniform] upper: is not above lower"),
        ({}, {"k": 'unit = "N/m"\nuniform = { lower = -1, upper = 200 }'}, "samples of k are not above 0"),
        ({}, {"correlation": "x_y = 0.4"}, "[correlation] x_y: x is described by value"),
        ({}, {"correlation": "y_y = 0.4"}, "[correlation] y_y: is not a pair"),
        ({}, {"y": 'table = "nowhere.csv"'}, "nowhere.csv"),
        ({"--samples": 10}, {}, "--samples: 10 is not 100 to 20000000"),
        ({"--seed": -1}, {}, "--seed: -1 is not 0 or more"),
        ({"--range": "0:120"}, {}, "--range: '0:120' is not a range of angles with its unit"),
    ],
)
def test_refused_in_one_line(tmp_path: Path, options: dict[str, object], changes: dict[str, str], said: str) -> None:
    result = population(tmp_path, options, **changes)
    assert result.code == 2
    (line,) = result.complaints
    assert said in line and not (tmp_path / "out").exists()
