"""The page of a mat: no choice where there is none, and the colours of the figure."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.mat.show import mat_page
from geocontact.view.page.content import Scene
from geocontact.view.page.write import page_html
from tests.analyses.mat.samples import COLS, ROWS, flat


def test_colours_are_offered_only_where_there_are_several(tmp_path: Path) -> None:
    """A mat has pressures and no distance, so there is nothing to choose."""
    page = page_html(mat_page(flat(tmp_path, np.full((2, ROWS, COLS), 10.0)), np.arange(2), b"<svg/>"))
    assert "<option" not in page.split('id="tools"')[1].split('class="group views"')[0]
    assert "distances in 8 bits" not in page


def test_page_and_figure_share_colours_and_their_limits(tmp_path: Path) -> None:
    pressure = np.zeros((2, ROWS, COLS))
    pressure[1, 1, 1] = 20.0
    pressure[0, 2:] = 5.0
    result = flat(tmp_path, pressure)
    (scene,) = [s for s in mat_page(result, np.arange(2), b"<svg/>").sections if isinstance(s, Scene)]
    (image,) = [image for axes in result.figure().axes for image in axes.images]
    assert image.get_clim() == pytest.approx((0.0, scene.maps[0].upper))
    assert image.get_cmap().name == "inferno_r"
    drawn = np.asarray(image.get_array())
    assert (drawn < 0.0).sum() == (pressure.max(axis=0) == 0.0).sum(), "no pressure is grey, as on the page"
