"""A still shows the contact where it is, by pyvista or by matplotlib, and says by which."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib import colormaps
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from geocontact.view.surfaces import child, render, still
from geocontact.view.surfaces.camera import Shot, View
from geocontact.view.surfaces.child import Probe
from geocontact.view.surfaces.legend import annotate, known_up_to
from geocontact.view.surfaces.painter import paint
from geocontact.view.surfaces.scene import ContactScene
from geocontact.view.surfaces.still import draw_stills
from tests.view.surfaces.ball import GAP, MM, RADIUS, ball, plate, scene, to_plate
from tests.view.surfaces.conftest import CRASH

SUPERIOR = View("superior", (0.0, 1.0, 0.0))
VIEWS = (SUPERIOR, View("oblique", (0.5, 0.8, 0.6)), View("inferior", (0.0, -1.0, 0.0)))


def shot_of(shown: ContactScene, view: View = SUPERIOR) -> Shot:
    """A third of the usual pixels."""
    shot = Shot.of(shown, view)
    return replace(shot, pixels=(shot.pixels[0] // 3, shot.pixels[1] // 3))


def by_pyvista(shown: ContactScene, shot: Shot) -> np.ndarray:
    return render.rendered(shown, shot) / 255.0  # in this process, after the probe has passed


def by_matplotlib(shown: ContactScene, shot: Shot) -> np.ndarray:
    figure = Figure(figsize=(shot.pixels[0] / 200, shot.pixels[1] / 200), dpi=200)
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    still._frame(axes, shot)
    paint(axes, shown, shot)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[:, :, :3] / 255.0


@pytest.fixture(params=["pyvista", "matplotlib"])
def picture(request: pytest.FixtureRequest):
    """A way to draw; pyvista's only where it works."""
    if request.param == "matplotlib":
        return by_matplotlib
    request.getfixturevalue("rendering")
    return by_pyvista


def colour_at(image: np.ndarray, shot: Shot, point: list[float]) -> np.ndarray:
    """Mean colour of a few pixels about a point of FIXED's frame [m]."""
    right, up, _ = shot.project(np.asarray(point)) / shot.half
    row, column = round((1.0 - up) / 2.0 * (image.shape[0] - 1)), round((1.0 + right) / 2.0 * (image.shape[1] - 1))
    return image[row - 2 : row + 3, column - 2 : column + 3].mean(axis=(0, 1))


def saturation(colour: np.ndarray) -> np.ndarray:
    return (colour.max(axis=-1) - colour.min(axis=-1)) / np.maximum(colour.max(axis=-1), 1e-9)


def hue(colour: np.ndarray) -> np.ndarray:
    grey = colour - colour.mean()
    return grey / np.linalg.norm(grey)


def test_colours_tell_the_distance(picture) -> None:
    """The hue at a point is that of its closed-form distance; far away there is none."""
    shown = scene()
    shot = shot_of(shown)
    image = picture(shown, shot)
    for x in (0.0, 3 * MM, 9 * MM):
        distance = np.hypot(x, RADIUS + GAP) - RADIUS
        expected = np.array(colormaps["viridis_r"]((distance + 2 * MM) / (10 * MM))[:3])
        assert hue(colour_at(image, shot, [x, 0.0, 0.4 * MM])) @ hue(expected) > 0.98, x
    for corner in ([28 * MM, 0.0, 28 * MM], [-28 * MM, 0.0, 28 * MM]):
        assert saturation(colour_at(image, shot, corner)) < 0.1


def test_the_coloured_part_has_the_size_of_what_is_known(picture) -> None:
    """Pixels with a hue make up the circle in which the distance is known."""
    shown = scene()
    shot = shot_of(shown)
    image = picture(shown, shot)
    pixel = 4.0 * shot.half[0] * shot.half[1] / (image.shape[0] * image.shape[1])
    radius = np.sqrt((RADIUS + known_up_to(shown.distance, shown.fixed_faces)) ** 2 - (RADIUS + GAP) ** 2)
    coloured = np.count_nonzero(saturation(image) > 0.25) * pixel
    assert coloured == pytest.approx(np.pi * radius**2, rel=0.08)  # the line and its white casing lie on the edge


def test_the_contact_follows_the_ball(picture) -> None:
    for x in (-12 * MM, 12 * MM):
        shown = scene(centre=(x, RADIUS + GAP, 0.0))
        shot = shot_of(shown)
        image = picture(shown, shot)
        assert saturation(colour_at(image, shot, [x, 0.0, 0.4 * MM])) > 0.3
        assert saturation(colour_at(image, shot, [-x, 0.0, 0.4 * MM])) < 0.1


def test_what_lies_behind_is_hidden(picture) -> None:
    """The ball as FIXED: its contact with the plate is seen from below the ball only."""
    (moving, moving_faces), (fixed, fixed_faces) = plate(2), ball(20)
    fixed = fixed + np.array([0.0, RADIUS + GAP, 0.0])
    shown = scene(
        fixed_vertices=fixed,
        fixed_faces=fixed_faces,
        distance=to_plate(fixed),
        moving_vertices=0.2 * moving,
        moving_faces=moving_faces,
        thresholds=(4 * MM,),
    )
    coloured = []
    for towards in (1.0, -1.0):
        shot = shot_of(shown, View("from above or below", (0.0, towards, 0.0)))
        coloured.append((saturation(picture(shown, shot)) > 0.25).mean())
    assert coloured[0] < 0.002 and coloured[1] > 0.2, coloured


def test_both_ways_show_the_same(rendering: None) -> None:
    shown = scene()
    for view in VIEWS:
        shot = shot_of(shown, view)
        one, other = ((saturation(draw(shown, shot)) > 0.25) for draw in (by_pyvista, by_matplotlib))
        assert (one & other).sum() > 0.85 * (one | other).sum(), view.name


def test_nothing_near_and_everything_deep(picture) -> None:
    """No distance known at all; and a ball so deep that none is finite in the middle."""
    count = len(scene().distance)
    for distance in (np.full(count, np.inf), np.full(count, -np.inf), np.where(np.arange(count) % 2, np.inf, 0.0)):
        shown = scene(distance=distance)
        image = picture(shown, shot_of(shown))
        assert image.std() > 0.0


def said_and_drawn(folder: Path, renderer: str) -> str:
    """Draw two views; the files are pictures with a hue, the answer names the renderer. Returns the note."""
    views = {folder / f"{view.name}.png": view for view in VIEWS[:2]}
    stills = draw_stills(scene(), views, "ball $x$ on plate")
    assert [s.file for s in stills] == list(views)
    assert {s.renderer for s in stills} == {renderer}
    for file in views:
        image = np.asarray(Image.open(file).convert("RGB")) / 255.0
        assert image.shape == (1280, 1600, 3)
        assert 0.03 < (saturation(image) > 0.25).mean() < 0.3
        assert (image == 1.0).all(axis=2).mean() > 0.2
    return stills[0].note


@pytest.mark.slow
def test_stills_by_pyvista(rendering: None, tmp_path: Path) -> None:
    assert said_and_drawn(tmp_path, "pyvista") == ""


@pytest.mark.skipif(sys.platform == "win32", reason="signals end processes on POSIX only")
def test_a_long_title_stays_inside_the_picture() -> None:
    """Names of files with dollar signs too, which would start a formula; nothing of them is lost."""
    shown = scene()
    figure = Figure(figsize=(8.0, 6.4), layout="constrained")
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    still._frame(axes, shot_of(shown))
    title = "MOVING femoral_component_right_coarse.stl on FIXED $a$_insert_right_coarse.stl, run 12, " + "x" * 40
    annotate(figure, axes, shown, SUPERIOR, shot_of(shown), title)
    figure.set_dpi(200)
    canvas.draw()
    (above,) = (each for each in figure.texts if each.get_text().startswith("MOVING"))
    drawn, whole, below = above.get_window_extent(), figure.bbox, axes.get_window_extent()
    assert drawn.x0 >= whole.x0 and drawn.x1 <= whole.x1 and below.y1 <= drawn.y0 < drawn.y1 <= whole.y1 - 2.0
    written = above.get_text().replace("\n", " ").replace(r"\$", "$")
    assert written.startswith(f"{title}, superior, t = ")


def test_without_a_driver_matplotlib_draws_and_says_so(without_rendering: None, tmp_path: Path) -> None:
    pytest.importorskip("pyvista")
    note = said_and_drawn(tmp_path, "matplotlib")
    assert note.startswith("3-D stills drawn by matplotlib, because pyvista cannot render here")
    assert "signal 11" in note


def test_without_pyvista_matplotlib_draws_and_says_so(
    monkeypatch: pytest.MonkeyPatch, asked_anew: None, tmp_path: Path
) -> None:
    monkeypatch.setitem(sys.modules, "pyvista", None)
    assert "pyvista is not installed" in said_and_drawn(tmp_path, "matplotlib")


@pytest.mark.slow
@pytest.mark.parametrize("program", [CRASH, "raise MemoryError('too large')", "import time; time.sleep(60)"])
def test_a_render_that_fails_after_the_probe_passed(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, program: str
) -> None:
    monkeypatch.setattr(still, "off_screen_works", lambda: Probe(True))
    monkeypatch.setattr(render, "PROGRAM", program)
    monkeypatch.setattr(still, "PATIENCE", 2.0)
    assert "because pyvista cannot render here" in said_and_drawn(tmp_path, "matplotlib")


@pytest.mark.slow
def test_nothing_is_left_behind(rendering: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "tmp").mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "tmp"))
    draw_stills(scene(), {tmp_path / "a.svg": SUPERIOR})
    assert [file.name for file in tmp_path.rglob("*") if file.is_file()] == ["a.svg"]
    assert not list((tmp_path / "tmp").iterdir())


def test_the_probe_is_not_the_render(rendering: None) -> None:
    assert child.PROGRAM != render.PROGRAM


def test_a_scene_refuses_what_is_not_a_distance() -> None:
    with pytest.raises(ValueError, match="not a number"):
        scene(distance=np.full(len(scene().distance), np.nan))
    with pytest.raises(ValueError, match="thresholds"):
        scene(thresholds=())
