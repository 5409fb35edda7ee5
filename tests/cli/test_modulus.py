"""`geocontact modulus`: what it writes, that it is what Python writes, and what it refuses."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from unittest import mock

import pytest

import geocontact as gc
from tests.analyses.modulus.synthetic_step import areas, forces
from tests.cli.calls import Call, call, done, inventory, written
from tests.drawing import unwritten
from tests.identify.synthetic_contact import TRUE

TABLES = {"curves", "sensitivity", "prediction"}
FILES = {"modulus.json", "modulus.png", "modulus.svg", "report.html", "run.json"}


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
    with mock.patch("geocontact.analyses.modulus.result.ModulusResult.figures", return_value={}), unwritten():
        yield


def told(result: Call) -> dict:
    """`modulus.json`."""
    return json.loads((result.folder / "modulus.json").read_text(encoding="utf-8"))


def test_writes_what_python_writes(tmp_path: Path) -> None:
    """Files by name, tables byte for byte, options as typed and in SI."""
    one, two = areas(tmp_path, "one.csv", levels=slice(0, 3)), areas(tmp_path, "two.csv", levels=slice(3, 5))
    other, force = areas(tmp_path, "other.csv", scale=1.3), forces(tmp_path)
    typed = ("--area", two, "--poisson", "0.25,0.46", "--threshold", "4mm", "--predict-area", other, "--parquet")
    result = done(modulus(tmp_path, *typed, area=one, force=force, picture=True))
    tables = {f"{name}.{ending}" for name in TABLES for ending in ("csv", "parquet")} | {"modulus.parquet"}
    assert set(inventory(result.folder)) == FILES | tables
    python = gc.modulus(
        (one, two),
        force,
        radius=gc.mm(37),
        threshold=gc.mm(4),
        poisson=(0.25, 0.46),
        predict_area=other,
        bootstrap=100,
    )
    python.write(tmp_path / "python", parquet=True)
    for name in {*tables, "modulus.json"}:
        assert (tmp_path / "python" / name).read_bytes() == result.bytes(name), name
    assert result.out.splitlines()[:-1] == list(python.sentences)
    assert result.record()["options"] == {
        "area": [str(one), str(two)],
        "force": str(force),
        "radius_mm": 37.0,
        "threshold": "4mm",
        "reading": "disc",
        "poisson": "0.25,0.46",
        "predict_area": [str(other)],
        "bootstrap": 100,
        "parquet": True,
        "out": str(result.folder),
    }
    assert result.record()["options_si"]["radius [m]"] == pytest.approx(0.037, rel=1e-12)


def test_page_and_numbers_of_a_synthetic_step(tmp_path: Path) -> None:
    result = done(modulus(tmp_path, picture=True))
    m = told(result)
    assert m["E_star_Pa"] == pytest.approx(TRUE, rel=1e-5) and m["side"] == "total" and m["threshold_mm"] == 4.0
    assert m["E_Pa"] == {"0.25": pytest.approx(TRUE * (1 - 0.0625), rel=1e-5)}
    page = (result.folder / "report.html").read_text(encoding="utf-8")
    assert "E and nu are one number here" in page and "What was identified" in page
    assert "6.8 MPa" in result.out.replace("6.800", "6.8")
    roles = [entry["role"] for entry in result.record()["inputs"]]
    assert roles == ["--area", "--force"] and result.record()["results"]["modulus"] == m


def test_free_numbers_are_typed_in_units_of_the_field(tmp_path: Path) -> None:
    free = "threshold=3:5"
    result = done(modulus(tmp_path, "--free", free, bootstrap=0))
    assert result.record()["options"]["free"] == free
    assert result.record()["options_si"]["free"] == {"threshold": [0.003, 0.005]}
    intervals = told(result)["intervals"]
    assert 3.0 <= intervals["threshold"]["value"] <= 5.0 and intervals["threshold"]["unit"] == "mm"


REFUSED = {
    "no radius": (("--poisson", "0.3"), "or --profile: exactly one", False),
    "threshold not there": (("--threshold", "2.5"), "2.5 mm was not evaluated", True),
    "unknown beyond the areas": (("--free", "threshold=1:9"), "reaches beyond the areas", True),
    "no such unknown": (("--free", "nu"), "is none of threshold, lag, adduction, slope", True),
    "impossible ratio": (("--poisson", "0.6"), "cannot be Poisson's ratio", True),
    "strip without length": (("--reading", "strip"), "--length-mm: is missing", True),
    "no such reading": (("--reading", "circle"), "circle", True),
    "radius in metres": (
        ("--radius-mm", "0.037"),
        "--radius-mm: 0.037 mm cannot be the radius of a contact: that is 0.1 to 10000 mm; is 0.037 m meant?",
        False,
    ),
    "lower bound above": (("--free", "lag=0.1:-0.1"), "has no room between its bounds", True),
    "one bound": (("--free", "lag=0.1"), "--free: '0.1' is not lower:upper", True),
    "named twice": (("--free", "lag,lag"), "or is named twice", True),
    "no number": (("--poisson", "0.3,x"), "--poisson: 'x' is not a finite number", True),
    "clocks apart": (("--lag", "50"), "0 frames of the area", True),
    "idle prediction": (("--predict-force", "x.csv"), "has no effect without --predict-area", True),
    "idle angles": (("--angles", "deg"), "has no effect without --flexion", True),
    "negative strip": (("--length-mm", "-5"), "cannot be the length of a contact", True),
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
