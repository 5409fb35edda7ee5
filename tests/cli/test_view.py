"""`geocontact view`: the page of a result, or a line that says which one is missing."""

import hashlib
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


@pytest.fixture
def there(tmp_path, monkeypatch):
    """An empty folder that is the current one, so that pages are written into it."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_page_of_a_surface_is_made_and_opened_and_renewed(there, opened, capsys):
    for _ in range(2):
        assert run(["view", str(SPHERE), "--unit", "mm"]) == 0
    page = there / "sphere_r20_surface.html"
    assert opened == [page.as_uri()] * 2
    assert capsys.readouterr().out.splitlines() == [str(page)] * 2
    assert hashlib.sha256(SPHERE.read_bytes()).hexdigest() in page.read_text("utf-8")
    assert run(["view", str(SPHERE), "--unit", "mm", "--out", str(there / "ball.html")]) == 0
    assert (there / "ball.html").read_bytes() == page.read_bytes()


def test_landmarks_of_a_file_stand_on_the_page(there, opened, capsys):
    (there / "mine.csv").write_text("id,x [mm],y [mm],z [mm]\nepicondyle,0,0,20.0\nfar,0,0,25.5\n")
    assert run(["view", str(SPHERE), "--unit", "mm", "--landmarks", "mine.csv"]) == 0
    said = "landmark far of mine.csv is 5.5 mm off sphere_r20.stl"
    assert said in capsys.readouterr().err
    page = (there / "sphere_r20_surface.html").read_text("utf-8")
    assert said in page and "epicondyle" in page


REFUSED_SURFACES = {
    "no unit": ([str(SPHERE)], "--unit: is missing"),
    "a window": ([str(SPHERE), "--unit", "mm", "--window"], "--window: shows results, not a mesh"),
    "something else there": ([str(SPHERE), "--unit", "mm", "--out", "mine.html"], "is no page of a surface"),
    "no folder": ([str(SPHERE), "--unit", "mm", "--out", "no/where.html"], "its folder is not there"),
    "a damaged mesh": (["bad.stl", "--unit", "mm"], "bad.stl"),
    "a mesh that is not there": (["no.stl", "--unit", "mm"], "no.stl: there is no such file or folder"),
    "a unit for a result": (["result", "--unit", "mm"], "--unit: is for a mesh"),
    "landmarks for a result": (["result", "--landmarks", "l.csv"], "--landmarks: is for a mesh"),
    "landmarks of another unit": ([str(SPHERE), "--unit", "mm", "--landmarks", "cm.csv"], "was picked in cm"),
    "landmarks of another mesh": ([str(SPHERE), "--unit", "mm", "--landmarks", "other.csv"], "not on sphere_r20.stl"),
    "landmarks that are not there": ([str(SPHERE), "--unit", "mm", "--landmarks", "none.csv"], "none.csv"),
    "landmarks twice": ([str(SPHERE), "--unit", "mm", "--landmarks", "twice.csv"], "id A occurs twice"),
}


@pytest.mark.parametrize("what", REFUSED_SURFACES)
def test_a_surface_that_cannot_be_shown_is_one_line(there, opened, capsys, what):
    words, said = REFUSED_SURFACES[what]
    head = "id,x [{0}],y [{0}],z [{0}]\nA,0,0,20\n"
    (there / "mine.html").write_text("my own page")
    (there / "bad.stl").write_bytes(SPHERE.read_bytes()[:500])
    (there / "result").mkdir()
    (there / "result" / "report.html").write_text("x")
    (there / "cm.csv").write_text("# unit = cm\n" + head.format("cm"))
    (there / "other.csv").write_text(f"# mesh_sha256 = {'0' * 64}\n" + head.format("mm"))
    (there / "twice.csv").write_text(head.format("mm") + "A,0,0,-20\n")
    assert run(["view", *words]) == 2
    err = capsys.readouterr().err
    assert said in err and len(err.splitlines()) == 1
    assert opened == []
    assert (there / "mine.html").read_text() == "my own page"
    assert not (there / "sphere_r20_surface.html").exists()
