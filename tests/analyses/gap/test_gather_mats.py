"""Mat recordings on a thigh, gathered into a gap case and diagnosed. All recordings here are synthetic."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from tests.cli.calls import MESHES, call, done, written
from tests.elsewhere import Elsewhere

pytestmark = pytest.mark.slow

ROWS, COLUMNS, AREA = 16, 8, 2e-4
ROW, COLUMN = np.divmod(np.arange(ROWS * COLUMNS), COLUMNS)
EDGE = (ROW >= 13) & (COLUMN >= 2) & (COLUMN <= 5)
"""12 cells at the lower end of the mat, where the strap pulls."""
STRAP = 14.0
"""N."""
TIME = np.arange(0.0, 8.0, 0.02)
SETTINGS = """format = 1
system = "sit_to_stand"
calibration = ["t01", "t02"]
evaluation = ["t03", "t04"]

[noise]
thigh_force = 0.5

[constants]
b = 80.0
rho_thigh = 0.02

[parameters.k_n_thigh]
start = 5000.0
lower = 1500.0
upper = 25000.0
unit = "N/m"
"""
TRIALS = ("t01", "t02", "t03", "t04")


def displacements(seed: int) -> dict[str, np.ndarray]:
    """Of a strapped thigh that stands up and sits down twice, each trial at a pace of its own."""
    rng = np.random.default_rng(seed)
    phase = 2.0 * np.pi * (2.0 + 0.3 * rng.standard_normal()) * TIME / TIME[-1]
    normal = 0.006 - 0.004 * np.cos(phase) + 0.0012 * np.sin(2.0 * phase + seed)
    return {"normal": normal, "tangential": 0.003 * np.sin(phase), "rotation": 0.08 * np.sin(phase + 0.4)}


def frames(motion: dict[str, np.ndarray], strap: float, seed: int) -> np.ndarray:
    """Pressure of each cell [kPa]: the model's force over a hill, the strap's on the edge, noise of each cell."""
    u = motion["normal"] + 0.02 * motion["rotation"]
    force = 5200.0 * u + 80.0 * np.gradient(u, TIME)
    hill = np.exp(-0.5 * (((ROW - 6.0) / 3.0) ** 2 + ((COLUMN - 3.5) / 2.0) ** 2))
    cells = np.outer(force, hill / hill.sum()) + strap * EDGE / EDGE.sum()
    noise = 0.03 * np.random.default_rng(seed).standard_normal(cells.shape) * (cells > 0.05)
    return np.maximum(cells + noise, 0.0) / AREA * 1e-3


def recorded(folder: Path, name: str, seed: int) -> pd.DataFrame:
    """Inputs of a trial as a file, and its frames."""
    motion = displacements(seed)
    units = {"normal": "m", "tangential": "m", "rotation": "rad"}
    inputs = pd.DataFrame({f"thigh_{key} [{units[key]}]": values for key, values in motion.items()})
    inputs.insert(0, "time [s]", TIME)
    inputs.to_csv(folder / f"{name}.csv", index=False, float_format="%.8g")
    names = [f"r{r}c{c} [kPa]" for r, c in zip(ROW, COLUMN, strict=True)]
    return pd.DataFrame(frames(motion, STRAP, seed), columns=names)


@pytest.fixture(scope="module")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The first mat through the command, the others written as it writes them, with cells where the first has them."""
    folder = tmp_path_factory.mktemp("recordings")
    tables = {name: recorded(folder, name, seed) for seed, name in enumerate(TRIALS)}
    first, *others = tables
    table = tables[first].copy()
    table.insert(0, "time [s]", TIME)
    table.to_csv(folder / "frames.csv", index=False, float_format="%.5g")
    home = MESHES / "mat_thigh_16x8"
    done(
        call(
            "mat", folder / "frames.csv", "--layout", home / "layout.toml", "--surface", MESHES / "thigh.stl",
            "--unit", "mm", "--landmarks", home / "landmarks.csv", "--cutoff", 0, "--out", folder / f"{first}_thigh",
        )
    )  # fmt: skip
    cells = pd.read_csv(folder / f"{first}_thigh" / "cells.csv")
    for name in others:
        seen = {
            f"{one['id']} [Pa]": 1e3 * tables[name][f"r{one['row']}c{one['column']} [kPa]"]
            for one in cells.to_dict("records")
        }
        shutil.copytree(folder / f"{first}_thigh", folder / f"{name}_thigh")
        frames_cells = pd.DataFrame({"time [s]": TIME} | seen)
        frames_cells.to_csv(folder / f"{name}_thigh" / "frames_cells.csv", index=False)
    return folder


def plan(folder: Path, change: Callable[[str], str] = lambda text: text, name: str = "gather.toml") -> Path:
    sources = "".join(f'\n[from.{t}]\ninputs = "{t}.csv"\nthigh = "{t}_thigh"\n' for t in TRIALS)
    return written(folder / name, change(SETTINGS + sources))


@pytest.fixture(scope="module")
def case(recordings: Path) -> Path:
    result = gc.gather(plan(recordings))
    assert result.sentences == (f"4 trials, thigh ({ROWS * COLUMNS} cells)",)
    return result.write(recordings / "case")


def test_the_case_holds_forces_cells_and_their_places(case: Path) -> None:
    trial = pd.read_csv(case / "trials" / "t01.csv")
    assert list(trial.columns) == [
        "time [s]", "thigh_normal [m]", "thigh_tangential [m]", "thigh_rotation [rad]", "thigh_force [N]"
    ]  # fmt: skip
    wrench = pd.read_csv(case.parent / "t01_thigh" / "wrench.csv")
    np.testing.assert_allclose(trial["thigh_force [N]"], wrench["normal [N]"], rtol=1e-6, atol=1e-6)
    layout = pd.read_csv(case / "thigh_layout.csv").set_index("id")
    cells = pd.read_csv(case / "trials" / "t01_thigh_cells.csv")
    assert list(cells.columns[1:]) == [f"{name} [Pa]" for name in layout.index]
    there = pd.read_csv(case.parent / "t01_thigh" / "cells.csv").set_index(["row", "column"]).loc[(13, 4)]
    columns = ["x [m]", "y [m]", "z [m]", "area [m^2]"]
    np.testing.assert_allclose(layout.loc["r13c4", columns].to_numpy(float), there[columns].to_numpy(float), rtol=1e-9)
    settings = (case / "case.toml").read_text("utf-8")
    assert '[layout]\nthigh = "thigh_layout.csv"' in settings and "from" not in settings


@pytest.fixture(scope="module")
def strapped(case: Path, tmp_path_factory: pytest.TempPathFactory, elsewhere: Elsewhere) -> tuple[Any, Path]:
    """What the diagnosis prints, and where it writes: a strap pulls at one end of the mat all the time."""
    out = tmp_path_factory.mktemp("strapped") / "out"
    return done(elsewhere(call, "gap", "diagnose", case, "--out", out)), out


@pytest.mark.slow
@pytest.mark.long
def test_only_what_the_model_cannot_tell_from_a_preload_is_in_question(strapped: tuple[Any, Path]) -> None:
    said = json.loads((strapped[1] / "diagnosis.json").read_text("utf-8"))
    assert set(said["ambiguity"]) == {"preload", "motion_offset", "sensor_offset"}


@pytest.mark.slow
def test_the_diagnosis_says_where_the_strap_pulls(strapped: tuple[Any, Path]) -> None:
    """Pulled at one end of the mat all the time: a preload, or what the model cannot tell from one."""
    out, folder = strapped
    said = json.loads((folder / "diagnosis.json").read_text("utf-8"))
    assert said["verdict"] == "explained" and set(said["effects"]) <= set(said["ambiguity"])
    assert set(said["ambiguity"][:3]) == {"preload", "motion_offset", "sensor_offset"}
    assert sum(said["probabilities"][name] for name in said["ambiguity"][:3]) > 0.9
    entry = said["where"][0]
    edge = {f"r{r}c{c}" for r, c in zip(ROW[EDGE], COLUMN[EDGE], strict=True)}
    assert entry["channel"] == "thigh_force" and set(entry["cells"]) <= edge and len(entry["cells"]) >= 8
    assert entry["cells_p_value"] < 0.05 and entry["cells_load"] < 0.3 < 0.7 <= entry["cells_share"]
    table = pd.read_csv(folder / "surface.csv")
    assert table["gap_share [-]"].sum() == pytest.approx(1.0) and set(table["site"]) == {"thigh"}
    assert "cells that carry" in out.out
    assert "Where on the surface" in (folder / "report.html").read_text("utf-8")
    assert (folder / "gap_surface_thigh.svg").is_file()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda text: text.replace("[from.t03]", "[from.t09]"), r"gather.toml [from.t03]: is missing"),
        (
            lambda text: text + '[from.t09]\ninputs = "a"\nthigh = "b"\n',
            "[from.t09]: neither calibration nor evaluation",
        ),
        (lambda text: text.replace('thigh = "t02_thigh"\n', ""), "[from.t02]: names no mat, plates, forces or outputs"),
        (lambda text: text.replace('thigh = "t02', 'shank = "t02'), "[from.t02]: has no mat of thigh"),
        (lambda text: text.replace("t02_thigh", "nowhere"), "nowhere: no cells.csv in it; name the folder that"),
        (lambda text: text.replace('"t02.csv"', '"t08.csv"'), "t08.csv: there is no such file"),
        (lambda text: text.split("\n[from")[0], "gather.toml: no [from.NAME]; write one for each, with inputs"),
        (lambda text: 'layout = {thigh = "a.csv"}\n' + text, "gather.toml layout: is written by geocontact gap gather"),
        (lambda text: text.replace("[noise]", "[noise]\nshank_force = 0.5"), "no trial has a channel 'shank_force'"),
        (lambda text: text.replace('"t02.csv"', '"t02_late.csv"'), "t02_late.csv: runs from 7 to 14.98 s, the mat in"),
        (lambda text: text.replace('"t02.csv"', '"t02_full.csv"'), "has a column 'thigh_force' already"),
    ],
)
def test_what_cannot_be_gathered_is_refused(
    recordings: Path, case: Path, change: Callable[[str], str], message: str
) -> None:
    late = pd.read_csv(recordings / "t02.csv")
    late.assign(**{"time [s]": late["time [s]"] + 7.0}).to_csv(recordings / "t02_late.csv", index=False)
    late.assign(**{"thigh_force [N]": 1.0}).to_csv(recordings / "t02_full.csv", index=False)
    with pytest.raises(gc.InputError, match=re.escape(message.replace("gather.toml", "wrong.toml"))):
        gc.gather(plan(recordings, change, "wrong.toml"))


def test_cells_that_one_trial_lacks_are_left_out(recordings: Path, case: Path, tmp_path: Path) -> None:
    """The mat of one trial has no working cell r13c4, and lies elsewhere."""
    home = recordings / "t02_short"
    home.mkdir(exist_ok=True)
    table = pd.read_csv(recordings / "t02_thigh" / "cells.csv")
    gone = table[(table["row"] == 13) & (table["column"] == 4)].iloc[0]["id"]
    moved = table[table["id"] != gone].assign(**{"y [m]": lambda rows: rows["y [m]"] + 0.02})
    moved.to_csv(home / "cells.csv", index=False)
    frames = pd.read_csv(recordings / "t02_thigh" / "frames_cells.csv").drop(columns=f"{gone} [Pa]")
    frames.to_csv(home / "frames_cells.csv", index=False)
    with pytest.warns(gc.InputWarning) as warned:
        result = gc.gather(plan(recordings, lambda t: t.replace("t02_thigh", "t02_short"), "short.toml"))
    said = " ".join(str(each.message) for each in warned)
    assert "1 cells of thigh in t01, t03, t04 are not in every trial and left out" in said
    assert "the mat of thigh lies up to 15 mm elsewhere in t02" in said
    result.write(tmp_path / "case")
    layout = pd.read_csv(tmp_path / "case" / "thigh_layout.csv")
    assert len(layout) == ROWS * COLUMNS - 1 and "r13c4" not in set(layout["id"])
