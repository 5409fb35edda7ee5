"""`numbers.csv` of `elbow fit` is what ran: it alone, beside the recordings, gives the same fit, in numpy and again."""

from __future__ import annotations

import ast
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import least_squares

import geocontact as gc
from geocontact.analyses.misalignment.identify import fitted, numbers, sentences
from geocontact.analyses.misalignment.identify.numbers import numbers_table
from geocontact.analyses.misalignment.identify.result import IdentifyResult
from geocontact.axis_misalignment import bins, compensation, prediction, uncertainty
from geocontact.axis_misalignment import least_squares as elbow_least_squares
from geocontact.identify.intervals import bin_tests, profile_likelihood
from geocontact.identify.noise import autoregressive
from geocontact.io.text.results import write_table
from tests.analyses.misalignment.trials import free, locked, quietly

MMHG = 133.322387415
ORDER = "kxylzs"
WIDTH = gc.deg(2.9)
"""No edge of a bin is a step of the angle's converter, where the last digit of an edge would decide."""
PRIOR: dict[str, Any] = {
    "known": {"z": 0.127},
    "prior": {"l": (0.175, 0.01)},
    "bounds": {"k": (50.0, 2000.0)},
    "start": {"x": 0.02, "s": 1e-7},
    "free": ("s",),
    "bin": WIDTH,
    "bootstrap": 0,
}
NO_NUMBER_OF_A_FIT = {"FACTORS", "BETA", "FORCE", "RATE", "PRESSURE", "DISPLACEMENT", "MOMENT", "ALPHA", "ABSENT"}
"""Points of a line that is drawn; places of channels."""


@pytest.fixture(scope="module")
def known_link(made: Path) -> IdentifyResult:
    """With a prior, a bound, a start and a number of each origin."""
    return quietly(gc.misalignment.identify, *locked(made), **PRIOR)


@pytest.fixture(scope="module")
def by_displacement(made: Path) -> IdentifyResult:
    """With nothing known: the free joint's displacement sets the scale."""
    return quietly(gc.misalignment.identify, *locked(made), unlocked=free(made), bin=WIDTH, bootstrap=0)


def in_file(result: IdentifyResult, folder: Path) -> pd.DataFrame:
    """The table as it stands in its file, by number."""
    write_table(result.table("numbers"), folder, "numbers")
    return pd.read_csv(folder / "numbers.csv").set_index("number")


def cells(files: tuple[Path, ...], told: pd.Series) -> pd.DataFrame:
    """Means of each trial in each bin: angle, force, pressure from its mean, samples."""
    found = []
    for file in files:
        rows = pd.read_csv(file)
        rows["beta"] = np.radians(rows["beta [deg]"])
        rows["over"] = MMHG * rows["pressure [mmHg]"] - told["pressure"]
        by_bin = rows.assign(count=1.0).groupby(np.floor(rows["beta"] / told["bin"]).astype(int))
        there = by_bin.mean(numeric_only=True).assign(count=by_bin["count"].sum())
        found.append(there[there["count"] * np.median(np.diff(rows["time [s]"])) >= told["bin least"]])
    return pd.concat(found)


def displacement(beta: np.ndarray, x: float, y: float, l: float, z: float) -> np.ndarray:
    """d_tot by the formulas at the head of the law."""
    s, c = np.sin(beta), np.cos(beta)
    straight = y + np.sqrt(l**2 - x**2) - np.sqrt((l * s - x) ** 2 + (y + l * c) ** 2)
    return np.asarray(straight - z * (x * c + y * s) / (l + y * c - x * s))


def while_sliding(data: pd.DataFrame, told: pd.Series) -> tuple[np.ndarray, np.ndarray]:
    """Mean angles of the bins over which the free joint slides, and its displacement less its mean there."""
    sums = data[["beta", "displacement [mm]"]].mul(data["count"], axis=0).groupby(level=0).sum()
    beta, joint = (sums.div(data["count"].groupby(level=0).sum(), axis=0) * [1.0, 1e-3]).to_numpy().T
    near = told["stroke still"] * np.ptp(joint)
    slides = (joint > joint.min() + near) & (joint < joint.max() - near)
    return beta[slides], joint[slides] - joint[slides].mean()


def fit_by_hand(told: pd.Series, files: tuple[Path, ...], unlocked: tuple[Path, ...] = ()) -> dict[str, float]:
    """Weighted least squares of the bins' forces with scipy, from nothing but the table and the recordings."""
    data = cells(files, told)
    beta, force, over = (data[name].to_numpy() for name in ("beta", "force [N]", "over"))
    seconds = told["step"] * data["count"].to_numpy()
    weight = np.sqrt(seconds / (2.0 * told["noise correlation_time"] + told["noise chunk"])) / told["noise sd"]
    names = [name for name in ORDER if f"{name} start" in told]
    fixed = {name: float(told[f"{name} fixed"]) for name in ORDER if name not in names}
    size = np.array([max(abs(told[f"{name} start"]), 1e-6) for name in names])
    if unlocked:
        where, off = while_sliding(cells(unlocked, told), told)

    def residual(scaled: np.ndarray) -> np.ndarray:
        n = fixed | dict(zip(names, scaled * size, strict=True))
        lengths = n["x"], n["y"], n["l"], n["z"]
        rest = [
            (n[name] - told[f"{name} prior mean"]) / told[f"{name} prior sd"]
            for name in names
            if f"{name} prior sd" in told
        ]
        if unlocked:
            rest.append((off @ displacement(where, *lengths) / (off @ off) - told["scale slope"]) / told["scale se"])
        modelled = n["k"] * (1.0 + n["s"] * over) * displacement(beta, *lengths)
        return np.concatenate([(modelled - force) * weight, rest])

    start = [told[f"{name} start"] for name in names] / size
    ends = [np.array([told[f"{name} {end}"] for name in names]) / size for end in ("least", "most")]
    found = least_squares(residual, np.clip(start, *ends), bounds=ends, xtol=1e-14, ftol=1e-14, gtol=1e-12)
    return fixed | dict(zip(names, map(float, found.x * size), strict=True))


def test_the_table_alone_gives_the_same_fit_in_numpy(known_link: IdentifyResult, made: Path, tmp_path: Path) -> None:
    told = in_file(known_link, tmp_path)["value"]
    found = fit_by_hand(told, locked(made))
    assert {name: known_link.numbers[name] for name in ORDER} == pytest.approx(found, rel=3e-5, abs=1e-12)
    other = fit_by_hand(told.where(told.index != "noise sd", 3.0 * told), locked(made))
    assert abs(other["l"] - found["l"]) > 1e-5  # the noise weighs the prior


def test_the_displacements_scale_is_that_of_the_table(
    by_displacement: IdentifyResult, made: Path, tmp_path: Path
) -> None:
    told = in_file(by_displacement, tmp_path)["value"]
    found = fit_by_hand(told, locked(made), free(made))
    assert {name: by_displacement.numbers[name] for name in ORDER} == pytest.approx(found, rel=3e-5, abs=1e-12)


def test_options_from_the_table_alone_give_the_same_tables(
    known_link: IdentifyResult, made: Path, tmp_path: Path
) -> None:
    told = in_file(known_link, tmp_path)
    asked: dict[str, Any] = {"known": {}, "prior": {}, "bounds": {}, "start": {}}
    asked["free"] = tuple(name for name in "bsc" if f"{name} start" in told.index)
    for number, row in told[told["source"] == "option"].iterrows():
        name, _, kind = str(number).partition(" ")
        value = float(row["value"])
        if kind == "fixed":
            asked["known"][name] = value
        elif kind == "start":
            asked["start"][name] = value
        elif kind in ("most", "prior sd"):
            first = float(told.loc[f"{name} {'least' if kind == 'most' else 'prior mean'}", "value"])
            asked["bounds" if kind == "most" else "prior"][name] = (first, value)
        elif not kind:
            asked[name] = int(value) if name == "bootstrap" else value
    again = quietly(gc.misalignment.identify, *locked(made), **asked)
    for name, table in known_link.tables().items():
        if name != "numbers":
            pd.testing.assert_frame_equal(again.table(name), table, rtol=1e-9)


def test_sources_are_where_numbers_are_from(
    known_link: IdentifyResult, by_displacement: IdentifyResult, tmp_path: Path
) -> None:
    told, other = in_file(known_link, tmp_path), in_file(by_displacement, tmp_path)
    asked = {"z fixed", "l start", "l prior mean", "l prior sd", "k least", "k most", "x start", "s start", "bin"}
    assert set(told.index[told["source"] == "option"]) == {*asked, "bootstrap"}
    assert set(other.index[other["source"] == "option"]) == {"bin", "bootstrap"}
    files = {"noise sd", "noise correlation_time", "step", "stretch", "pressure"}
    assert set(told.index[told["source"] == "file"]) == files
    assert set(other.index[other["source"] == "file"]) == {*files, "scale se"}
    assert told["value"].notna().all() and told["unit"].notna().all() and not told.index.duplicated().any()


def test_a_filter_is_told(known_link: IdentifyResult) -> None:
    table = numbers_table(known_link.fit, None, replace(known_link.options, cutoff=6.0)).set_index("number")
    assert table.loc["cutoff", ["value", "unit", "source"]].tolist() == [6.0, "Hz", "option"]


CONSTANTS = (
    *(fitted, numbers, sentences, bins, compensation, prediction, uncertainty, elbow_least_squares),
    *(bin_tests, profile_likelihood, autoregressive),
)


def numbers_of(module: ModuleType) -> dict[str, float]:
    """Constants of a module that are numbers, or pairs of them."""
    found: dict[str, float] = {}
    for node in ast.parse(Path(str(module.__file__)).read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign):
            for name in (each.id for target in node.targets for each in ast.walk(target) if isinstance(each, ast.Name)):
                if name.isupper() and isinstance(value := getattr(module, name), int | float):
                    found[name] = float(value)
    return found


@pytest.mark.parametrize("module", CONSTANTS, ids=lambda module: module.__name__.rpartition(".")[2])
def test_no_constant_that_decides_is_left_out(
    module: ModuleType, known_link: IdentifyResult, by_displacement: IdentifyResult
) -> None:
    told = {*known_link.table("numbers")["value"], *by_displacement.table("numbers")["value"]}
    left = {name: value for name, value in numbers_of(module).items() if name not in NO_NUMBER_OF_A_FIT}
    assert not {name: value for name, value in left.items() if value not in told}
