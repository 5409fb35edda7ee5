"""`geocontact view`: the page of a result, or a line that says which one is missing."""

import webbrowser

import pytest

from geocontact.cli.main import run
from tests.cli.calls import PLATE, SPHERE, area, done, poses


@pytest.fixture
def opened(monkeypatch):
    """Addresses that would have been opened; a browser that starts."""
    seen = []
    monkeypatch.setattr(webbrowser, "open", lambda address: seen.append(address) or True)
    return seen


@pytest.mark.parametrize("named", ["", "report.html", "gait 1"])
def test_page_of_a_result_is_opened(tmp_path, opened, capsys, named):
    folder = tmp_path / 'it\'s a "result" & more'
    home = folder / "gait 1" if named == "gait 1" else folder
    home.mkdir(parents=True)
    (home / "report.html").write_text("x")
    assert run(["view", str(folder / ("" if named == "gait 1" else named))]) == 0
    assert opened == [(home / "report.html").resolve().as_uri()]
    assert str(home / "report.html") in capsys.readouterr().out


def test_without_a_browser_the_path_is_said(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(webbrowser, "open", lambda address: False)
    (tmp_path / "report.html").write_text("x")
    assert run(["view", str(tmp_path)]) == 0
    assert str(tmp_path / "report.html") in (said := capsys.readouterr().out) and "no browser" in said


def test_several_results_ask_which_one(tmp_path, opened, capsys):
    for name in ("walk", "stairs"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "report.html").write_text("x")
    assert run(["view", str(tmp_path)]) == 2
    assert "holds 2 results: stairs, walk" in capsys.readouterr().err
    assert opened == []


@pytest.mark.parametrize("name", ["empty", "missing", "area.csv"])
def test_no_page_is_one_line(tmp_path, opened, capsys, name):
    (tmp_path / "empty").mkdir()
    (tmp_path / "area.csv").write_text("x")
    assert run(["view", str(tmp_path / name)]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1
    assert opened == []


def test_window_shows_what_the_maps_hold(tmp_path, monkeypatch):
    shown = []
    monkeypatch.setattr("geocontact.view.surfaces.window.show_window", shown.append)
    motion = poses(tmp_path, (0, 22, 0), (0, 20, 0))
    result = done(area(tmp_path / "out", "--save-map", moving=SPHERE, fixed=PLATE, motion=motion))
    assert run(["view", str(result.folder), "--window"]) == 0
    (series,) = shown
    assert (len(series), series.signed, series.thresholds, series.time_unit) == (2, "both", (4e-3,), "s")
    assert series.placed(0).mean(axis=0) - series.placed(1).mean(axis=0) == pytest.approx([0, 2e-3, 0], abs=1e-12)
    assert series.fixed.distance[1].min() == pytest.approx(0.0, abs=1e-5)


@pytest.mark.parametrize("content", [None, b"", b"PK\x03\x04 not an archive", b"time"])
def test_window_without_maps_is_one_line(tmp_path, capsys, content):
    if content is not None:
        (tmp_path / "distances.npz").write_bytes(content)
    assert run(["view", str(tmp_path), "--window"]) == 2
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1 and "run the analysis again with --save-map" in said
