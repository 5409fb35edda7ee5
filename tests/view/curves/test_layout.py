"""What an art editor looks for: units on every axis, nothing clipped, no text on text, no legend on data."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from geocontact.view.curves.diagnosis_answers import EffectVisibility, detectability_figure
from geocontact.view.curves.style import save

Specimen = Callable[[str], Figure]
LONG = "a name as long as file names are, with/folders/and_all/of/that.csv"
NAMES = pytest.mark.parametrize("name", ["knee", LONG], ids=["short", "long"])


def saved_texts(figure: Figure, file: Path, monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, Bbox]]:
    """Every text that reaches the page, with the box around it as a share of the page."""
    seen: dict[int, tuple[str, Bbox]] = {}
    draw = RendererAgg.draw_text

    def recorded(renderer: RendererAgg, *args: Any, mtext: Text | None = None, **kwargs: Any) -> None:
        if mtext is not None:
            box = mtext.get_window_extent(renderer).transformed(figure.transFigure.inverted())
            seen[id(mtext)] = (mtext.get_text(), box)
        draw(renderer, *args, mtext=mtext, **kwargs)

    monkeypatch.setattr(RendererAgg, "draw_text", recorded)
    save(figure, file)
    return list(seen.values())


@NAMES
def test_no_text_is_clipped_or_covers_another(
    specimen: Specimen, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    figure = specimen(name)
    texts = saved_texts(figure, tmp_path / "a.png", monkeypatch)
    assert len(texts) > 5
    for text, box in texts:
        assert (box.min >= 0.0).all() and (box.max <= 1.0).all(), f"{text!r} {box} leaves the page"
    for (one, a), (other, b) in itertools.combinations(texts, 2):
        both = Bbox.intersection(a, b)
        assert both is None or both.width * both.height < 1e-6, f"{one!r} and {other!r} overlap"


def test_small_letters_of_many_effects_stay_on_the_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Letters of six points are drawn wider at the resolution of the file than on the screen."""
    shares = [1e-6 * 10.0**k for k in range(5)] * 6
    effects = [EffectVisibility("contact_loss.negative", share, "1.61e−05 m/(N s)") for share in shares]
    figure = detectability_figure([*effects, EffectVisibility("end_stop.lower.buffer", None, "not to be seen")])
    drawn = saved_texts(figure, tmp_path / "a.png", monkeypatch)
    assert len(drawn) > 60
    for text, box in drawn:
        assert (box.min >= 0.0).all() and (box.max <= 1.0).all(), f"{text!r} {box} leaves the page"


@NAMES
def test_legends_and_titles_stay_off_the_data(specimen: Specimen, name: str) -> None:
    figure = specimen(name)
    FigureCanvasAgg(figure).draw()
    boxes = [axes.get_window_extent() for axes in figure.axes]
    assert all(box.width > 40.0 and box.height > 20.0 for box in boxes if box.width > 10.0), "squeezed by its legend"
    words = [axes.get_legend() for axes in figure.axes] + [axes.title for axes in figure.axes] + list(figure.legends)
    for word in filter(None, words):
        assert not any(word.get_window_extent().overlaps(box) for box in boxes if word.get_window_extent().width > 1.0)


def test_every_axis_says_its_unit(specimen: Specimen) -> None:
    for axes in specimen("knee").axes:
        for axis in (axes.xaxis, axes.yaxis):
            numbered = any(
                label.get_visible() and re.fullmatch(r"[−\d.]+", label.get_text()) for label in axis.get_ticklabels()
            )
            if numbered:
                assert re.search(r"\[(mm²?|N|%|s|–|1/mm|nats|Hz|rad|rad/s)\]$", axis.label.get_text()), (
                    axis.label.get_text()
                )
