"""`geocontact elbow simulate`, `fit` and `compare`: what they write, say and refuse; numbers are tested as analyses."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.misalignment.law_numbers import PER_SI
from geocontact.analyses.misalignment.simulate.result import SEED, TRIALS, USUAL
from geocontact.axis_misalignment.synthetic import PAPER
from geocontact.gap.case.admission import admitted
from tests.analyses.misalignment.trials import free, locked, quietly
from tests.cli.calls import Call, call, done, inventory, written
from tests.cli.elbow_calls import elbow, same_csv, unpictured

QUICK = ("--seconds", 20, "--rate", 50, "--noise", 0.2, "--memory", 0.1, "--trials", 3)
TRIALS_MADE = ("--stroke-mm=-10:60", "--pressure", "10:60")
KNOWN = ("--known", "l=169,z=127", "--bootstrap", 0)
PICTURES = {f"{name}.{ending}" for name in ("forces", "identifiability", "residuals") for ending in ("png", "svg")}
FIT = {"elbow.json", "bins.csv", "boxes.csv", "intervals.csv", "scale_line.csv", "held_out.csv", "report.html"}
FIT |= PICTURES | {"numbers.csv", "run.json"}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three locked and three free trials."""
    folder = tmp_path_factory.mktemp("made")
    done(elbow("simulate", folder, *QUICK, *TRIALS_MADE))
    return folder


@pytest.fixture(scope="module")
def fitted(made: Path, tmp_path_factory: pytest.TempPathFactory) -> Call:
    """With the link known and the first free trial, with its figures and page."""
    options = (*KNOWN, "--cutoff", 5, "--unlocked", free(made)[0])
    return done(elbow("fit", tmp_path_factory.mktemp("fit"), *locked(made), *options, picture=True))


def told(result: Call) -> dict[str, Any]:
    return json.loads(result.bytes("elbow.json"))


def page_of(result: Call) -> str:
    return (result.folder / "report.html").read_text(encoding="utf-8")


def test_simulated_trials_say_what_they_are(made: Path) -> None:
    assert {p.name for p in made.glob("*.csv")} == {
        *(f"{kind}_{k}.csv" for kind in ("locked", "free") for k in (1, 2, 3)),
        "surfaces.csv",
        "numbers.csv",
    }
    record = json.loads((made / "run.json").read_text(encoding="utf-8"))
    for file in (*locked(made), *free(made)):
        assert file.read_text(encoding="utf-8").startswith("time [s],beta [deg]")
        assert record["tables"][file.name]["synthetic"] is True
    truth = json.loads((made / "truth.json").read_text(encoding="utf-8"))
    assert truth["synthetic"] is True and truth["stroke_mm"] == [-10.0, 60.0]


@pytest.mark.slow
def test_a_simulation_with_its_figure_and_page(tmp_path: Path) -> None:
    result = done(elbow("simulate", tmp_path, *QUICK, "--stroke-mm=-10:60", "--parquet", picture=True))
    trials = {f"{kind}_{k}" for kind in ("locked", "free") for k in (1, 2, 3)} | {"surfaces", "numbers"}
    tables = {f"{name}.{ending}" for name in trials for ending in ("csv", "parquet")}
    assert set(inventory(tmp_path)) == tables | {
        "truth.json",
        "surfaces.png",
        "surfaces.svg",
        "report.html",
        "run.json",
    }
    assert "Displacement of the joint, free_1 (synthetic)" in page_of(result)
    assert "These recordings are synthetic" in page_of(result)
    assert result.out.startswith("locked_1, synthetic: ")
    options = result.record()["options"]
    assert options["stroke_mm"] == "-10:60" and options["recordings"] == [] and "band" not in options
    assert result.record()["options_si"]["stroke [m]"] == [-0.01, 0.06]


def test_python_simulates_as_the_command_does(tmp_path: Path, made: Path) -> None:
    options: dict[str, Any] = {"seconds": 20.0, "rate": 50.0, "noise": 0.2, "memory": 0.1, "trials": 3}
    result = gc.misalignment.simulate(**options, stroke=gc.mm(-10, 60), pressure=gc.mmHg(10, 60))
    with unpictured():
        assert len(same_csv(result.write(tmp_path), made)) == 8


def test_python_identifies_as_the_command_does(tmp_path: Path, made: Path, fitted: Call) -> None:
    known = {"l": gc.mm(169), "z": gc.mm(127)}
    options: dict[str, Any] = {"known": known, "bootstrap": 0, "cutoff": 5.0, "unlocked": free(made)[:1]}
    result = quietly(gc.misalignment.identify, *locked(made), **options)
    with unpictured():
        assert len(same_csv(result.write(tmp_path), fitted.folder)) == 8  # numbers.csv is the eighth
    assert (tmp_path / "elbow.json").read_bytes() == fitted.bytes("elbow.json")


def test_python_compares_as_the_command_does(tmp_path: Path, made: Path, fitted: Call) -> None:
    fit = fitted.folder / "elbow.json"
    with unpictured():
        done(elbow("compare", tmp_path / "typed", *free(made), "--fit", fit, "--stroke-mm=-10:60"))
        result = quietly(gc.misalignment.compare, *free(made), fit=fit, stroke=gc.mm(-10, 60))
        assert same_csv(result.write(tmp_path / "python"), tmp_path / "typed") == ["comparison.csv"]


def test_the_help_says_what_each_command_does(tmp_path: Path) -> None:
    shown = done(call("elbow", "--help", folder=tmp_path)).out
    for command in ("simulate", "fit", "compare", "design", "population"):
        assert re.search(rf"{command} +[A-Z]", shown), shown


def test_the_help_of_a_simulation_tells_what_it_takes_unless_given(tmp_path: Path) -> None:
    """Numbers of the design and the law as they are, held against what stands in the help."""
    shown = done(call("elbow", "simulate", "--help", folder=tmp_path)).out
    options = re.split(r" --(?=[\w-]+ [A-Z]+ )", " ".join(shown.replace("│", " ").split()))
    told = {each.split(" ")[0]: each for each in options}
    low, high = np.degrees(USUAL.reach)
    expected = {
        "numbers": "the paper's " + ",".join(f"{name}={value * PER_SI[name]:g}" for name, value in PAPER.items()),
        "trials": TRIALS,
        "seconds": f"{USUAL.seconds:g}",
        "noise": USUAL.noise,
        "rate": f"{USUAL.rate:g}",
        "band": "{:g}:{:g}".format(*USUAL.band),
        "range": f"{low:g}:{high:g}",
        "memory": USUAL.memory,
        "donning-mm": f"{USUAL.donning * 1e3:g}",
        "bits": USUAL.bits,
        "seed": SEED,
        "stroke-mm": "None",
        "pressure": "no pressure",
    }
    assert USUAL.pressures is None
    for option, default in expected.items():
        assert f" {default} by default." in told[option], told[option]


def test_tables_of_an_earlier_simulation_go(tmp_path: Path) -> None:
    source = written(tmp_path / "walk.csv", "time [s],hinge [deg]\n0,20\n1,60\n2,90\n3,120\n")
    result = done(elbow("simulate", tmp_path / "out", source, "--map", "beta=hinge", "--numbers", "k=300,x=30,y=40"))
    record = result.record()
    assert record["inputs"][0]["role"] == "angle" and "simulated_walk.csv" in record["files"]
    assert record["options_si"]["numbers"] == {"k": 300.0, "x": 0.03, "y": 0.04}
    again = done(elbow("simulate", tmp_path / "out", *QUICK))
    assert not (again.folder / "simulated_walk.csv").exists(), "left over from the first run"


def test_the_page_and_its_figures(fitted: Call) -> None:
    assert set(inventory(fitted.folder)) == FIT | {
        "conditions.csv",
        "boxes_free.csv",
        "conditions.png",
        "conditions.svg",
    }
    page = page_of(fitted)
    assert "bootstrap lower" not in page, "without a bootstrap no empty columns"
    for words in (
        "What the data identify",
        "known beforehand",
        "comes from prior knowledge",
        "Lilliefors",
        "Mean force, joint locked and free",
    ):
        assert words in page
    assert fitted.out.startswith("k ") and "k by the free joint's displacement" in fitted.out
    assert told(fitted)["intervals"]["k"]["wild_bootstrap"] is None
    assert fitted.record()["results"]["elbow"] == told(fitted)


@pytest.mark.slow
def test_without_anything_known_the_options_that_would_help_are_named(tmp_path: Path, made: Path) -> None:
    result = done(elbow("fit", tmp_path, *locked(made), "--bootstrap", 0))
    words = (
        "state l, z or k (--known), give a prior (--prior), record the cuff's moment (a column moment), or the free "
        "joint's displacement (--unlocked)"
    )
    assert any(words in line for line in result.warnings) and words in page_of(result).replace("&#39;", "'").replace(
        "&#x27;", "'"
    )


def test_a_comparison_with_its_figure_and_page(tmp_path: Path, made: Path, fitted: Call) -> None:
    fit = fitted.folder / "elbow.json"
    result = done(elbow("compare", tmp_path, *locked(made)[:1], "--fit", fit, picture=True))
    pictures = {"comparison_force.png", "comparison_force.svg"}
    assert set(inventory(tmp_path)) == pictures | {"comparison.csv", "report.html", "run.json"}
    assert "Model against 1 recording" in page_of(result) and "locked_1, force: MAE " in result.out


REFUSED = {
    "known twice": (("--known", "l=169,l=170"), "l is given twice"),
    "no such number": (("--known", "q=3"), "these are k, x, y"),
    "not a number": (("--known", "l=long"), "'long' is not a finite number"),
    "prior of a known one": (("--known", "l=169", "--prior", "l=169:5"), "l is known already"),
    "prior without SD": (("--prior", "l=169"), "not a pair"),
    "SD of 0": (("--prior", "l=169:0"), "not above 0"),
    "bounds without room": (("--bounds", "x=60:-60"), "no room between its bounds"),
    "start outside": (("--bounds", "x=0:10", "--start", "x=20"), "x = 20 mm is not between its bounds"),
    "everything known": (("--known", "k=222,x=48,y=59,l=169,z=127"), "leaves nothing"),
    "negative link": (("--known", "l=-169"), "--known l: -169 mm cannot be a link"),
    "link in metres": (
        ("--known", "l=0.169"),
        "0.169 mm cannot be a link of an exoskeleton: that is 20 to 2000 mm; is 0.169 m meant?",
    ),
    "prior on a link in metres": (("--prior", "l=0.185:0.01"), "--prior l: 0.185 mm cannot be a link"),
    "start of a link in metres": (("--start", "l=0.2"), "--start l: 0.2 mm cannot be a link"),
    "bounds of a link in metres": (("--bounds", "l=0.16:0.21"), "--bounds l: 0.21 mm cannot be a link"),
    "free what is free": (("--free", "k"), "not b, s or c"),
    "pressure that is not there": (("--free", "s", "--map", "pressure=cuff"), "cuff"),
    "damping bounds unasked": (("--bounds", "b=0:10"), "b is not free; give --free b"),
    "bins of nothing": (("--bin-deg", "0"), "0.1 to 30"),
    "wide bins": (("--bin-deg", "20"), "give narrower bins (--bin-deg)"),
    "few replicates": (("--bootstrap", "5"), "100 to 100000"),
    "cut-off beyond": (("--cutoff", "40"), "cut-off of 40 Hz"),
    "a fold": (("--known", "l=40,x=48,y=0,z=0"), "beyond the model: |x| = 48 mm"),
    "rotary without a free trial": (("--rotary-free",), "--rotary-free: has no effect without --unlocked"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_fits_that_cannot_be_are_refused_in_one_line(tmp_path: Path, made: Path, name: str) -> None:
    options, said = REFUSED[name]
    result = elbow("fit", tmp_path / "out", *locked(made), *options)
    assert result.code == 2 and len(result.complaints) == 1 and said in result.err, result.err
    assert not (tmp_path / "out").exists()


SIMULATED = {
    "a fold": (("--numbers", "x=180"), "|x| = 180 mm is more than the link's l = 169 mm"),
    "a pole": (("--numbers", "x=150,y=150", "--range", "0:140"), "tan γ has a pole at"),
    "a range in radians": (("--range", "0.1:1.6"), "are degrees and radians mixed up?"),
    "a range beyond any elbow": (("--range", "0:200"), "200 deg cannot be an angle of an elbow"),
    "a band that aliases": (("--band", "10:90", "--rate", 100), "half of 100 Hz; give a higher --rate"),
    "s without a pressure": (("--numbers", "s=0.01"), "s has no effect without a cuff pressure; give --pressure"),
    "no stiffness": (("--numbers", "k=0"), "0 N/m cannot be the stiffness"),
    "a stroke that ends first": (("--stroke-mm=10:-10",), "--stroke-mm: its upper end is below the lower one"),
    "no trials": (("--trials", 0), "1 to 1000"),
    "negative noise": (("--noise", -1), "-1 N cannot be the noise"),
    "a map of nothing": (("--map", "beta=b"), "--map: has no effect without RECORDINGS"),
    "a band from 0": (("--band", "0:0.3"), "0 Hz cannot be a frequency"),
    "trials along a recording": (("walk.csv", "--trials", 3), "--trials: has no effect along a recording"),
}


@pytest.mark.parametrize("name", SIMULATED)
def test_simulations_that_cannot_be_are_refused_in_one_line(tmp_path: Path, name: str) -> None:
    options, said = SIMULATED[name]
    result = elbow("simulate", tmp_path / "out", *options)
    assert result.code == 2 and len(result.complaints) == 1 and said in result.err, result.err
    assert not (tmp_path / "out").exists()


def test_comparisons_that_cannot_be_are_refused(tmp_path: Path, made: Path) -> None:
    one, bad = locked(made)[0], written(tmp_path / "elbow.json", "{}")
    for options, said in (
        ((), "--fit: or --simulated: exactly one is compared with"),
        (("--fit", bad), "holds no law of an elbow"),
        (("--simulated", one, "--simulated", one), "--simulated: is given 2 times for 1 recording; "),
        (("--simulated", one, "--stroke-mm=0:1"), "--stroke-mm: has no effect without --fit"),
        (("--fit", tmp_path / "none.json"), "none.json"),
    ):
        result = elbow("compare", tmp_path / "out", one, *options)
        assert result.code == 2 and said in result.err, result.err


def test_recordings_of_other_columns_are_mapped(tmp_path: Path, made: Path) -> None:
    """A sign turned in the map turns the force back that was turned in the file."""
    table = pd.read_csv(locked(made)[0])
    table["Fx [N]"] = -table.pop("force [N]")
    table.rename(columns={"beta [deg]": "flexion [deg]"}).to_csv(tmp_path / "locked_1.csv", index=False)
    columns = ("--map", "beta=flexion,force=-Fx", "--simulated", locked(made)[0])
    result = done(elbow("compare", tmp_path / "out", tmp_path / "locked_1.csv", *columns))
    assert result.table("comparison.csv")["mae"].item() == 0.0


def test_recordings_become_a_gap_case(tmp_path: Path) -> None:
    """Locked trials only, angle and force as in the tables beside it; l and z are known, k, x, y are free."""
    result = done(elbow("simulate", tmp_path, *QUICK[:-1], 4, "--stroke-mm=-10:60", "--case"))
    case = gc.read_gap_case(result.folder / "case")
    assert [each.name for each in (*case.calibration, *case.evaluation)] == [f"locked_{k}" for k in range(1, 5)]
    assert len(case.calibration) == 2 and [each.name for each in case.parameters] == ["k", "x", "y"]
    assert case.constants == pytest.approx({"l": 0.169, "z": 0.127})
    table = pd.read_csv(result.folder / "locked_1.csv", comment="#")
    np.testing.assert_allclose(case.calibration[0].column("beta"), np.radians(table["beta [deg]"]), rtol=1e-8)
    np.testing.assert_allclose(case.calibration[0].column("force"), table["force [N]"], rtol=1e-8)
    system = gc.system_of(case)
    assert len(admitted(case, system).evaluation) == 2, "a diagnosis takes it"
    numbers = {each.name: each.start for each in case.parameters} | dict(case.constants)
    off = system.simulate(case.evaluation[0], numbers)[:, 0] - case.evaluation[0].column("force")
    assert np.sqrt(np.mean(off**2)) < 2.0, "what is left is what the person adds"


@pytest.mark.parametrize(
    ("options", "line"),
    [(("--trials", "3", "--case"), "--trials: 3 trials are too few for --case; give 4 or more")],
)
def test_a_case_needs_trials_to_hold_out(tmp_path: Path, options: tuple[str, ...], line: str) -> None:
    result = elbow("simulate", tmp_path, *options)
    assert result.code == 2 and result.complaints[0].startswith(line)
