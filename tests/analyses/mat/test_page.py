"""The page of a mat: no choice where there is none, and the colours of the figure."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.mat.loads import ALONG
from geocontact.analyses.mat.show import mat_page
from geocontact.view.page.content import Curves, Readout, Scene
from geocontact.view.page.write import page_html
from tests.analyses.mat.samples import COLS, ROWS, flat


def test_colours_are_offered_only_where_there_are_several(tmp_path: Path) -> None:
    """A mat has pressures and no distance, so there is nothing to choose."""
    page = page_html(mat_page(flat(tmp_path, np.full((2, ROWS, COLS), 10.0)), np.arange(2), b"<svg/>"))
    assert "<option" not in page.split('id="tools"')[1].split('class="group views"')[0]
    assert "distances in 8 bits" not in page


def test_every_force_is_named_apart_and_moments_have_their_point(tmp_path: Path) -> None:
    """The sum of the headline is a row and a curve: pressure times area, by hand."""
    result = flat(tmp_path, np.full((2, ROWS, COLS), 10.0))
    page = mat_page(result, np.arange(2), b"<svg/>")
    rows = {row.label: row for s in page.sections if isinstance(s, Readout) for row in s.rows}
    (force,) = [s for s in page.sections if isinstance(s, Curves) and s.title == "Force on the body"]
    total = 10e3 * float(result.cells.area.sum())
    assert float(rows["sum of pressure × area"].texts[0]) == pytest.approx(total, abs=0.05)
    assert force.curves[0].name == "sum of pressure × area" and force.curves[0].values[0] == pytest.approx(total)
    assert [each.name for each in force.curves[1:]] == [ALONG, "resultant x", "resultant y", "resultant z"]
    assert "moment x about the origin" in rows and ALONG in rows
    assert any(s.title == "Moment about the origin" for s in page.sections if isinstance(s, Curves))
    facts = dict(page.facts)
    assert facts["Largest force"] == f"{total:.1f} N at 0.00 s (sum of pressure × area)"
    assert facts["Resultant along the mean normal, then"] == f"{total:.1f} N", "flat: the same"


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
