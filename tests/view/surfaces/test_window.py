"""The window: without a display one line; with one, the slider and the arrow keys choose the frame."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from geocontact.data.errors import InputError
from geocontact.view.surfaces import window
from geocontact.view.surfaces.window import OBLIQUE, arranged, show_window
from tests.view.surfaces.ball import series
from tests.view.surfaces.conftest import CRASH

linux = pytest.mark.skipif(sys.platform in ("darwin", "win32"), reason="these always have a display")


def refused() -> str:
    with pytest.raises(InputError) as error:
        show_window(series(2))
    assert "\n" not in str(error.value)
    return str(error.value)


@linux
def test_no_display(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pyvista")
    monkeypatch.delenv("DISPLAY", raising=False)
    said = "3-D window: there is no display to open a window on; run it on a desktop, or write stills or VTP files"
    assert refused().startswith(said)


def test_no_pyvista(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyvista", None)
    assert refused() == "3-D window: pyvista is not installed; pip install 'geocontact[view]'"


@linux
def test_a_display_that_does_not_answer(monkeypatch: pytest.MonkeyPatch, rendering: None) -> None:
    monkeypatch.setenv("DISPLAY", ":7777")
    assert refused().startswith("3-D window: ")


@pytest.mark.skipif(sys.platform == "win32", reason="signals end processes on POSIX only")
def test_a_driver_that_crashes(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pyvista")
    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.setattr(window, "PROGRAM", CRASH)
    assert refused().startswith("3-D window: ends the process (signal 11)")


def test_the_child_gets_the_series(monkeypatch: pytest.MonkeyPatch) -> None:
    """All of it: what the program of the child process builds is what was given."""
    pytest.importorskip("pyvista")
    monkeypatch.setenv("DISPLAY", ":0")
    given = series(3, time_unit="%")
    check = (
        "import sys; import numpy as np; from geocontact.view.surfaces import window\n"
        "def seen(s, view, off_screen):\n"
        f"    assert np.allclose(s.time, {given.time.tolist()}, rtol=0, atol=0) and s.time_unit == '%'\n"
        "    assert s.signed == 'fixed' and s.thresholds == (0.001, 0.004) and not off_screen\n"
        f"    assert np.allclose(s.placed(2)[0], {given.placed(2)[0].tolist()}, rtol=0, atol=1e-15)\n"
        f"    assert s.fixed.distance.min() == {given.fixed.distance.min()!r} and len(s.moving.faces) == 720\n"
        f"    assert np.allclose(view.axes(), {OBLIQUE.axes().tolist()})\n"
        "    raise SystemExit('as given')\n"
        "window.arranged = seen; window.main(sys.argv[1])"
    )
    monkeypatch.setattr(window, "PROGRAM", check)
    with pytest.raises(InputError, match="as given"):
        show_window(given)


def alike(one: np.ndarray, other: np.ndarray) -> bool:
    """But for single pixels along outlines."""
    return bool((np.abs(one.astype(int) - other) > 16).any(axis=2).mean() < 1e-3)


@pytest.mark.slow
def test_slider_and_keys_choose_the_frame(rendering: None) -> None:
    """Without a screen: the picture changes with the frame, and is the same again when the frame is."""
    plotter = arranged(series(4), OBLIQUE, off_screen=True)
    plotter.window_size = [320, 240]  # a sixteenth of the pixels: each picture takes seconds without a graphics card
    try:
        slider = getattr(plotter, "widgets", plotter).slider_widgets[0]

        def moved_to(time: float) -> np.ndarray:
            slider.GetRepresentation().SetValue(time)
            slider.InvokeEvent("InteractionEvent")
            return plotter.screenshot(return_img=True).copy()

        start, middle, last, again = (moved_to(t) for t in (0.0, 1.0 / 9.0, 1.0 / 3.0, 0.0))
        assert start.std() > 0
        assert not alike(start, middle) and not alike(middle, last)
        assert alike(start, again)
        keys = plotter.iren._key_press_event_callbacks
        keys["Right"][0]()
        assert slider.GetRepresentation().GetValue() == pytest.approx(1.0 / 9.0)
        assert alike(plotter.screenshot(return_img=True), middle)
        keys["Left"][0]()
        keys["Left"][0]()
        assert alike(plotter.screenshot(return_img=True), start)
    finally:
        plotter.close()


def test_one_frame_has_no_slider(rendering: None) -> None:
    plotter = arranged(series(1), OBLIQUE, off_screen=True)
    assert not getattr(plotter, "widgets", plotter).slider_widgets
    plotter.close()
