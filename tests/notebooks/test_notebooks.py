"""Every notebook runs from top to bottom, and is kept without outputs."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path

import nbformat
import numpy as np
import pytest
from nbclient import NotebookClient

from tests.cli.calls import FEMUR, INSERT, MESHES, call, unpictured

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Execute a notebook with a folder of its own as the place where it writes; returns what its cells said."""

    def executed(notebook: Path, **environment: str) -> str:
        for name, value in environment.items():
            monkeypatch.setenv(name, value)
        os.symlink(ROOT / "meshes", tmp_path / "meshes")
        book = nbformat.read(notebook, as_version=4)
        NotebookClient(book, timeout=600, resources={"metadata": {"path": str(tmp_path)}}).execute()
        outputs = [output for cell in book.cells if cell.cell_type == "code" for output in cell.outputs]
        return "".join(output.get("text", "") for output in outputs)

    return executed


def test_there_is_one_for_each_part():
    assert {"contact_area", "gap", "gap_own_model", "knee", "mat", "elbow", "motion"} <= {
        notebook.stem for notebook in NOTEBOOKS
    }


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_kept_without_outputs_and_with_any_python(notebook):
    book = json.loads(notebook.read_text(encoding="utf-8"))
    nbformat.validate(nbformat.from_dict(book))
    for cell in book["cells"]:
        assert not cell.get("outputs") and cell.get("execution_count") is None
        assert cell["metadata"] == {}
    assert book["metadata"]["kernelspec"]["name"] == "python3"
    assert "version" not in book["metadata"].get("language_info", {})


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_contact_area_writes_what_the_command_writes(run, tmp_path):
    said = run(ROOT / "notebooks" / "contact_area.ipynb", GEOCONTACT_DATA=str(tmp_path / "none"))
    assert "101 frames, signed: both" in said and "no real data here; everything above is synthetic" in said
    given = ("--unit", "mm", "--motion", MESHES / "gait.csv", "--threshold", "1,4", "--split", "z")
    with unpictured():
        assert call("area", FEMUR, INSERT, *given, "--out", tmp_path / "out").code == 0
    notebook = tmp_path / "contact-area-result"
    assert (notebook / "area.csv").read_bytes() == (tmp_path / "out/area.csv").read_bytes()
    page = (notebook / "report.html").read_text(encoding="utf-8")
    assert f"MOVING {FEMUR.name} on FIXED {INSERT.name}" in page


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_mat_runs_on_the_shipped_recording(run):
    said = run(ROOT / "notebooks" / "mat.ipynb")
    assert "151 frames of 16 x 8 cells" in said and "exactly" in said


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_elbow_shows_the_line_and_finds_the_numbers_that_were_planted(run):
    said = run(ROOT / "notebooks" / "elbow.ipynb")
    assert "d_lin 153 mm, d_tot 109 mm" in said
    assert re.search(r"direction told least: \[-1\. +1\. +1\. +1\. +1\.\]", said)
    low, high = map(float, re.findall(r"R² along the line ([\d.]+) to ([\d.]+)", said)[0])
    assert low == high > 0.98
    leaves = float(re.findall(r"slides from (\d+)°", said)[0])
    assert 60.0 <= leaves <= 68.0
    assert 190.0 < float(re.findall(r"k by displacement (\d+) N/m", said)[0]) < 255.0


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_gap_runs_on_the_case_that_it_plants(run):
    said = run(ROOT / "notebooks" / "gap.ipynb")
    assert "on fresh trials of this kind the error shrinks by" in said
    assert "planted: viscous damping" in said and "named: ('damping',) - right" in said


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_gap_own_model_finds_what_it_plants_and_nothing_where_nothing_is(run):
    """The angle's noise went through no filter."""
    said = run(ROOT / "notebooks" / "gap_own_model.ipynb")
    assert "as measured: no_gap" in said
    assert "not to be seen at any plausible size: sensor_gain.torque" in said
    assert "not to be told apart (less than 5 nats between any two): time_shift and filter_lag" in said
    planted, found = (float(value) for value in re.findall(r"damping\.b'?:? ([\d.]+)", said)[:2])
    assert found == pytest.approx(planted, rel=0.1)
    assert re.search(r"known load of .* N m .*: tells .*sensor_gain.* nats more", said)


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_knee_goes_from_meshes_to_a_modulus_that_was_planted(run, tmp_path):
    said = run(ROOT / "notebooks" / "knee.ipynb", GEOCONTACT_DATA=str(tmp_path / "none"))
    assert "no real data here; everything above is synthetic" in said
    assert "sagittal radius 33.9 mm at 0°, 22.0 mm at 80° of flexion" in said
    peak, strain = map(float, re.findall(r"largest pressure ([\d.]+) MPa, strain up to ([\d.]+)%", said)[0])
    assert 1.0 < peak < 100.0 and 0.1 < strain < 30.0
    by_layer, by_cells = map(int, re.findall(r"load: (\d+)% by the layer, (\d+)% by the cells", said)[0])
    assert 0 < by_layer < 100 and abs(by_layer - by_cells) < 25
    modulus = [float(value) for value in re.findall(r"E\* ([\d.]+) MPa, 95 %", said)]
    assert modulus == pytest.approx([6.8, 6.8], rel=0.02)
    explained = [float(value) for value in re.findall(r"trial not used: .* R² ([\d.]+)", said)]
    assert len(explained) == 2 and min(explained) > 0.98


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_motion_finds_what_it_planted(run):
    said = run(ROOT / "notebooks" / "motion.ipynb")
    markers, angles = map(float, re.findall(r"markers ([\d.]+) mm, angles ([\d.]+) deg", said)[0])
    assert 4.0 < markers < 5.5 and 0.1 < angles < 3.0
    centre = [float(value) for value in re.findall(r"in the pelvis \[mm\]: \[\s*(.*?)\]", said)[0].split()]
    assert np.abs(np.subtract(centre, [0.0, -80.0, 0.0])).max() < 5.0
    errors = [float(value) for value in re.findall(r"at most ([\d.e+-]+) mm from the finest", said)]
    assert len(errors) == 3 and errors[0] > errors[1] > errors[2] and errors[2] < 1e-2
