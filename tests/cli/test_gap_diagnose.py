"""`geocontact gap diagnose`: what it writes, that it is the contract's, and that names and units do not matter."""

from __future__ import annotations

import json
import math
import re
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.frame.rerun import read_run
from geocontact.analyses.gap.diagnose.many import kept
from geocontact.analyses.gap.diagnose.options import ManyOptions
from tests.cli.calls import Call, call, done, inventory, process
from tests.cli.gap_cases import damped_elbow, in_degrees_and_kilonewtons, known, reordered, spoilt
from tests.systems.examples import ELBOW_VALUES
from tests.unchecked import unchecked

TABLES = {"diagnosis.json", "run.json", "gap_map.csv", "ranking.csv", "held_out.csv", "trials.csv", "budget.csv"}
FIGURES = {
    f"{name}.{ending}"
    for name in ("budget", "gap_map", "reductions", "ranking", "gap_residuals")
    for ending in ("png", "svg")
}
KEYS = [
    "case",
    "system",
    "verdict",
    "effects",
    "probabilities",
    "ambiguity",
    "behind",
    "one_law",
    "apart",
    "absorbed",
    "where",
    "gap",
    "budget",
    "detected",
    "unmodelled",
    "regions",
    "parameters",
]
KEYS += ["partial", "next_experiment", "faults", "remarks", "thinned", "seconds", "version"]
CHANNEL = ["rmse_before", "rmse_after", "noise_floor", "reduction", "ci95", "unexplained"]


@pytest.fixture(scope="session")
def good(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The case of a damped elbow."""
    return damped_elbow(tmp_path_factory.mktemp("gap") / "elbow_7")


@pytest.fixture(scope="session")
def diagnosed(good: Path, tmp_path_factory: pytest.TempPathFactory) -> Call:
    """Its diagnosis with everything that is written."""
    out = tmp_path_factory.mktemp("diagnosed") / "out"

    with known():
        return done(call("gap", "diagnose", good, "--out", out, folder=out))


@pytest.fixture(scope="session")
def answer(diagnosed: Call) -> dict[str, Any]:
    """diagnosis.json; NaN and Infinity are no JSON."""
    return answer_in(diagnosed.folder)


def answer_in(folder: Path) -> dict[str, Any]:
    def refused(word: str) -> float:
        raise AssertionError(f"{word} is not JSON")

    return json.loads((folder / "diagnosis.json").read_text(encoding="utf-8"), parse_constant=refused)


def numbers(value: Any) -> Iterator[float]:
    """Every number in a nested answer."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for each in value:
            yield from numbers(each)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield float(value)


def estimated(answer: dict[str, Any]) -> list[tuple[float, float]]:
    """What depends on how large the noise is estimated, with its scale: shares of the gap, ends of intervals.

    Shares of noise in the budget are proportional to its square: 0.9 % of themselves where the noise is off by 0.45 %.
    """
    gaps, parameters = answer["gap"].values(), answer["parameters"].values()
    shares = [(share, 1.0) for said in gaps for share in (said["reduction"], *said["ci95"], said["unexplained"])]
    parts = [part for channel in answer["budget"].values() for part in channel.values()]
    shares += [(share, 10.0) for part in parts for share in (part["share"], *part["ci95"])]
    ends = [(end, 50.0 * (said["ci95"][1] - said["ci95"][0])) for said in parameters for end in said["ci95"]]
    return shares + ends


def without_estimated(answer: dict[str, Any]) -> dict[str, Any]:
    """All else of the answer but its name and its time."""
    left_out = ("reduction", "ci95", "unexplained")
    kept = {
        key: {name: {k: v for k, v in said.items() if k not in left_out} for name, said in answer[key].items()}
        for key in ("gap", "parameters")
    }
    return {k: v for k, v in answer.items() if k not in ("case", "seconds", "budget")} | kept


def test_everything_is_written_and_listed(diagnosed: Call) -> None:
    expected = TABLES | FIGURES | {"report.html", "before_after_force.png", "before_after_force.svg"}
    assert set(inventory(diagnosed.folder)) == expected
    record = diagnosed.record()
    assert record["command"] == "gap diagnose" and set(record["files"]) == expected
    assert list(record["options"]) == ["case", "bare", "run_simulator", "many", "resume", "out"]
    roles = [entry["role"] for entry in record["inputs"]]
    assert roles == ["case", "calibration", "calibration", "evaluation", "evaluation"]
    assert all(re.fullmatch("[0-9a-f]{64}", entry["sha256"]) for entry in record["inputs"])


def test_the_answer_has_the_keys_of_the_contract_and_values_in_range(answer: dict[str, Any]) -> None:
    assert list(answer) == KEYS
    assert (answer["case"], answer["system"]) == ("elbow_7", "elbow")
    assert answer["verdict"] in ("explained", "partly_explained", "no_gap", "unknown", "unresolved")
    assert (answer["verdict"] in ("explained", "partly_explained")) == bool(answer["effects"])
    assert all(math.isfinite(value) for value in numbers(answer))
    probabilities = answer["probabilities"]
    assert sum(probabilities.values()) == pytest.approx(1.0, abs=1e-12)
    assert all(0.0 <= value <= 1.0 for value in probabilities.values())
    assert {"none", "unknown"} <= set(probabilities)
    assert answer["ambiguity"][: len(answer["effects"])] == answer["effects"]
    assert len(answer["absorbed"]) <= 10
    for where in answer["where"]:
        assert set(where) <= {"channel", "phase", "share", "p_value", "stage"}
        low, high = where["phase"]
        assert 0.0 <= low < high <= 1.0 and 0.0 < where["p_value"] <= 1.0
    assert sum(where["share"] for where in answer["where"]) == pytest.approx(1.0)
    for gap in answer["gap"].values():
        assert list(gap) == CHANNEL
        low, high = gap["ci95"]
        assert low <= gap["reduction"] <= high <= 1.0
        assert gap["rmse_after"] > 0.0 and gap["noise_floor"] > 0.0
        assert gap["unexplained"] is None or gap["unexplained"] >= 0.0
    for parameter in answer["parameters"].values():
        assert list(parameter) == ["value", "ci95", "unit", "identifiable"]
        low, high = parameter["ci95"]
        assert low <= parameter["value"] <= high and isinstance(parameter["identifiable"], bool)


@dataclass(frozen=True)
class Many:
    """What one call with --many returned, said and wrote."""

    code: int
    out: str
    err: str
    folder: Path


SAME = {"elbow_7": "itself", "Ωmega, turned": "another name and order", "degrees": "other units"}


@pytest.fixture(scope="session")
def many(good: Path, tmp_path_factory: pytest.TempPathFactory) -> Many:
    """The same case in three guises, a wrong one and a folder that is none, in processes of their own."""
    folder = tmp_path_factory.mktemp("many")
    cases, out = folder / "cases", folder / "out"
    cases.mkdir()
    spoilt(good, cases / "elbow_7", "case.toml", "format = 1", "format = 1  # the same")
    reordered(good, cases / "Ωmega, turned", ["t02", "t01"], ["t04", "t03"])
    in_degrees_and_kilonewtons(good, cases / "degrees")
    spoilt(good, cases / "wrong", "trials/t02.csv", "force [N]", "force [furlong]")
    (cases / "no case").mkdir()
    found = process("gap", "diagnose", cases, "--many", "--bare", "--workers", 2, "--out", out)
    return Many(found.returncode, found.stdout, found.stderr, out)


@pytest.mark.slow
def test_a_wrong_case_costs_the_others_nothing(many: Many) -> None:
    assert many.code == 2, many.err
    said = many.err.splitlines()
    (line,) = [each for each in said if "furlong" in each]  # how far the work is stands beside it on a busy machine
    assert not [each for each in said if each.startswith("warning:")] and "Traceback" not in many.err
    assert "wrong" in line and "t02.csv line 1, column 3: 'force' is in 'furlong'" in line
    expected = {"run.json", "summary.csv", *SAME, *(f"{name}/{table}" for name in SAME for table in TABLES)}
    assert set(inventory(many.folder)) == expected
    assert pd.read_csv(many.folder / "summary.csv")["effects"].tolist() == ["damping"] * len(SAME)
    told = json.loads((many.folder / "run.json").read_text(encoding="utf-8"))["results"]["cases"]
    assert told.keys() == {*SAME, "wrong"} and told["Ωmega, turned"] == "done" and "furlong" in told["wrong"]
    assert all(f"{name}: damping is missing; it sits in force" in many.out for name in SAME)


@pytest.mark.slow
@pytest.mark.parametrize("name", SAME)
def test_names_order_and_units_do_not_change_the_answer(answer: dict[str, Any], many: Many, name: str) -> None:
    """Also not from one process to another: the answer beside it was made in this one.

    Rounding of other units goes through searches that end a little before their optimum. Which way depends on the
    processor: on one of them a probability of 0.8945 changed by 4e-5 of itself, half a thousandth of a nat, and the
    noise so much that intervals are narrower by 0.45 % and reductions, which are shares of one, larger by 4e-5. It is
    not the units: forces, angles or times that differ in the sixteenth digit alone end at that same place, to 1e-9.
    """
    again = answer_in(many.folder / name)
    assert again["case"] == name
    exact = name == "elbow_7"
    for (first, scale), (second, _) in zip(estimated(answer), estimated(again), strict=True):
        assert first == pytest.approx(second, rel=1e-5 if exact else 0.0, abs=1e-9 if exact else 1e-4 * scale)
    same, other = without_estimated(answer), without_estimated(again)
    for key in ("verdict", "effects", "ambiguity", "absorbed", "faults", "remarks"):
        assert same[key] == other[key]
    for first, second in zip(numbers(same), numbers(other), strict=True):
        assert first == pytest.approx(second, rel=1e-5 if exact else 1e-4, abs=1e-9)


@pytest.mark.slow
def test_a_run_goes_on_where_it_was_stopped(many: Many, tmp_path: Path) -> None:
    """Cases that are finished are kept byte by byte; one whose results were touched comes anew."""
    out = tmp_path / "out"
    shutil.copytree(many.folder, out)
    cases = tmp_path / "cases"
    shutil.copytree(many.folder.parent / "cases", cases)
    told = read_run(out / "degrees")
    assert kept(many.folder.parent / "cases" / "degrees", out / "degrees", ManyOptions(cases, many=True), "") is None
    before = json.loads((out / "elbow_7" / "run.json").read_bytes())["results"]
    left = partial(kept, o=ManyOptions(cases, many=True, bare=True), sources=before["sources"])
    home = many.folder.parent / "cases"
    first = left(home / "elbow_7", out / "elbow_7")
    assert first is not None and dict(first.row)["effects"] == "damping" and first.line.startswith("damping is missing")
    assert left(cases / "elbow_7", out / "elbow_7") is None, "another case"
    assert kept(home / "elbow_7", out / "elbow_7", ManyOptions(home, many=True, bare=True), "other sources") is None
    assert kept(home / "elbow_7", out / "elbow_7", ManyOptions(home, many=True), before["sources"]) is None, "options"
    (out / "Ωmega, turned" / "ranking.csv").write_text("touched")
    assert left(home / "Ωmega, turned", out / "Ωmega, turned") is None and told.command == "gap diagnose"
    with known():
        again = call("gap", "diagnose", home, "--many", "--bare", "--workers", 1, "--resume", "--out", out)
    assert again.code == 2 and "2 of 4 cases as an earlier run left them" in again.out
    for name in SAME:
        same = (out / name / "run.json").read_bytes() == (many.folder / name / "run.json").read_bytes()
        assert same == (name != "Ωmega, turned"), name
    assert pd.read_csv(out / "summary.csv")["effects"].tolist() == ["damping"] * len(SAME)


@pytest.mark.slow
def test_bare_leaves_pictures_out_and_takes_old_ones_away(good: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "notes.txt").write_text("mine")
    with known(), unchecked():
        done(call("gap", "diagnose", good, "--out", out))
        assert (out / "ranking.png").is_file()
        done(call("gap", "diagnose", good, "--bare", "--out", out))
    assert set(inventory(out)) == TABLES | {"notes.txt"}


def test_cases_that_are_gone_leave_nothing_behind(good: Path, tmp_path: Path) -> None:
    """OUT/<case> of the run before goes when the case can no longer be diagnosed, unless another run has filled it."""
    cases, out = tmp_path / "cases", tmp_path / "out"
    for name in ("a", "gone", "others"):
        spoilt(good, cases / name, "case.toml", "format = 1", "format = 1 ")
    with known():
        done(call("gap", "diagnose", cases, "--many", "--bare", "--workers", 1, "--out", out))
        done(call("gap", "diagnose", cases / "others", "--bare", "--out", out / "others"))
        assert (out / "gone" / "gap_map.csv").is_file()
        for name in ("gone", "others"):
            shutil.rmtree(cases / name)
        done(call("gap", "diagnose", cases, "--many", "--bare", "--out", out))
    left = {name.partition("/")[0] for name in inventory(out)}
    assert left == {"run.json", "summary.csv", "a", "others"}
    assert {p.name for p in (out / "others").iterdir()} == TABLES


def test_json_holds_pythons_own_numbers() -> None:
    given = {"a": np.float64(1.5), "b": [np.nan, np.inf, -np.inf], "c": np.bool_(True), "d": (np.int64(3), None, "x")}
    made = plain(given)
    assert made == {"a": 1.5, "b": [None, None, None], "c": True, "d": [3, None, "x"]}
    assert type(made["a"]) is float and type(made["d"][0]) is int and made["c"] is True


@pytest.mark.slow
def test_base_parameters_may_all_be_known(tmp_path: Path) -> None:
    """Nothing is left to refit: the effect is found beside them."""
    case = damped_elbow(tmp_path / "elbow_7", samples=80)
    text = (case / "case.toml").read_text()
    for name, start in (("k", "280.0"), ("x", "0.03"), ("y", "0.04")):
        known = f"[parameters.{name}]\nfixed = true\nstart = {ELBOW_VALUES[name]}"
        text = text.replace(f"[parameters.{name}]\nstart = {start}", known)
    (case / "case.toml").write_text(text)
    done(call("gap", "diagnose", case, "--out", tmp_path / "out"))
    assert text.count("fixed = true") == 3
    found = answer_in(tmp_path / "out")
    assert (found["verdict"], found["effects"]) == ("explained", ["damping"])
