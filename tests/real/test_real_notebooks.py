"""Notebooks on real data, where the shipped meshes are only the beginning."""

from __future__ import annotations

import os
import re
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_contact_area_notebook_reaches_the_real_implant(data_dir, tmp_path, monkeypatch):
    monkeypatch.setenv("GEOCONTACT_DATA", str(data_dir))
    os.symlink(ROOT / "meshes", tmp_path / "meshes")
    book = nbformat.read(ROOT / "notebooks" / "contact_area.ipynb", as_version=4)
    last = [cell for cell in book.cells if cell.cell_type == "code"]
    book.cells = [last[0], last[-1]]  # imports, then the part on real data
    NotebookClient(book, timeout=600, resources={"metadata": {"path": str(tmp_path)}}).execute()
    said = "".join(output["text"] for output in book.cells[-1].outputs)
    found = re.search(r"DM: (\d+) … (\d+) mm² within 4 mm over (\d+) frames; signed: (\w+)", said)
    assert found, said
    low, high, frames = (int(group) for group in found.groups()[:3])
    assert 2150 <= low < high <= 2800 and frames > 50 and found[4] == "both"


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_knee_notebook_reaches_the_real_knee(data_dir, tmp_path, monkeypatch):
    monkeypatch.setenv("GEOCONTACT_DATA", str(data_dir))
    os.symlink(ROOT / "meshes", tmp_path / "meshes")
    book = nbformat.read(ROOT / "notebooks" / "knee.ipynb", as_version=4)
    NotebookClient(book, timeout=600, resources={"metadata": {"path": str(tmp_path)}}).execute()
    said = "".join(output["text"] for output in book.cells[-1].outputs)
    found = re.search(r"total: E\* ([\d.]+) MPa \(95 % ([\d.]+) … ([\d.]+)\), RMSE \d+ N, R² ([\d.]+)", said)
    assert found, said
    modulus, low, high, explained = (float(group) for group in found.groups())
    assert modulus == pytest.approx(1.53, rel=0.02) and low < modulus < high and 0.2 < explained < 0.4
