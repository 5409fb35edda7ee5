"""Files of figures: the same bytes for the same input, text as text, nothing left behind in matplotlib."""

from __future__ import annotations

import re
import subprocess
import sys
import xml.etree.ElementTree as ET
import zlib
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread

from geocontact.view.curves.over_cycle import mean_over_cycle
from geocontact.view.curves.path import contact_path
from geocontact.view.curves.quantity import FORCE
from geocontact.view.curves.style import DOUBLE, INCH, SINGLE, save

Specimen = Callable[[str], Figure]
HOSTILE = ("$x_$", "a$b", "_hidden", "<b>&amp;", r"\alpha \$", "Ωé–²", "%s {0}", "__init__")


def texts_of_svg(file: Path) -> list[str]:
    return [
        "".join(e.itertext()).replace("\u200b", "").strip() for e in ET.parse(file).iter() if e.tag.endswith("}text")
    ]


def texts_of_pdf(file: Path) -> list[str]:
    """Strings that the page shows, through the two-byte codes of its fonts; rare letters have fonts of their own."""
    found = []
    for packed in re.findall(rb"stream\r?\n(.*?)\r?\nendstream", file.read_bytes(), re.DOTALL):
        try:
            page = zlib.decompressobj().decompress(packed)  # a checksum that ends in \r loses it before the line's end
        except zlib.error:
            continue
        for shown in re.findall(rb"BT\n(.*?)ET", page, re.DOTALL):
            codes = b"".join(re.findall(rb"\(((?:\\.|[^\\)])*)\)", shown, re.DOTALL))
            found.append(re.sub(rb"\\(.)", rb"\1", codes, flags=re.DOTALL).decode("utf-16-be", "replace"))
    return found


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Callable[[Specimen], Path]:
    """SVG file of a specimen with a plain name, made once for all tests."""

    @cache
    def of(specimen: Specimen) -> Path:
        file = tmp_path_factory.mktemp("saved") / "knee.svg"
        save(specimen("knee"), file)
        return file

    return of


def test_same_input_gives_same_bytes_whatever_the_users_settings(
    specimen: Specimen, saved: Callable[[Specimen], Path], tmp_path: Path
) -> None:
    """Saved twice, and drawn again for the first file; the settings neither change nor count."""
    first = saved(specimen).read_bytes()
    with mpl.rc_context({"font.size": 20.0, "lines.linewidth": 9.0, "axes.facecolor": "red", "svg.fonttype": "path"}):
        mine = dict(mpl.rcParams)
        figure = specimen("knee")
        for name in ("drawn_again", "saved_twice"):
            save(figure, tmp_path / f"{name}.svg")
            assert (tmp_path / f"{name}.svg").read_bytes() == first, name
        assert dict(mpl.rcParams) == mine


@pytest.mark.parametrize("ending", ["pdf", "png"])
def test_same_input_gives_same_bytes_in_every_format(ending: str, tmp_path: Path) -> None:
    steps = np.arange(9.0)
    check_bytes(lambda: contact_path(steps, {"Ω": np.c_[np.cos(steps), np.sin(steps)]}), ending, tmp_path)


def check_bytes(draw: Callable[[], Figure], ending: str, folder: Path) -> None:
    figure = draw()
    for name, drawn in (("first", figure), ("saved_twice", figure), ("drawn_twice", draw())):
        save(drawn, folder / f"{name}.{ending}")
        assert (folder / f"{name}.{ending}").read_bytes() == (folder / f"first.{ending}").read_bytes(), name


def test_vector_files_hold_text(specimen: Specimen, saved: Callable[[Specimen], Path], tmp_path: Path) -> None:
    figure = specimen("knee")
    label = figure.axes[0].get_ylabel().replace("−", "-").split("\n")[0]
    save(figure, tmp_path / "a.pdf")
    assert label in [text.replace("−", "-") for text in texts_of_svg(saved(specimen))]
    found = "\n".join(texts_of_pdf(tmp_path / "a.pdf"))
    assert label.partition("²")[0].partition("-")[0].strip() in found
    assert b"/Type3" not in (tmp_path / "a.pdf").read_bytes(), "letters drawn as shapes"
    assert b"/FontFile2" in (tmp_path / "a.pdf").read_bytes(), "the font comes with the file"


@pytest.mark.parametrize("name", ["_hidden $x_$ <b>", r"$a \alpha \$ é"])
def test_hostile_names_are_drawn_as_they_stand(specimen: Specimen, name: str, tmp_path: Path) -> None:
    figure = specimen(name)
    save(figure, tmp_path / "a.svg")
    assert any(name in text for text in texts_of_svg(tmp_path / "a.svg"))


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_names_are_drawn_in_every_format(name: str, tmp_path: Path) -> None:
    figure = mean_over_cycle(np.arange(5.0), {name: np.ones((2, 5))}, replace(FORCE, name=name))
    save(figure, tmp_path / "a.png")
    save(figure, tmp_path / "a.pdf")
    usual = name.encode("ascii", "ignore").decode()  # rarer letters may come from a second font, with codes of its own
    assert usual in "".join(texts_of_pdf(tmp_path / "a.pdf")).replace("\u200b", "")


def test_control_characters_do_not_break_the_file(specimen: Specimen, tmp_path: Path) -> None:
    save(specimen("a\x00b\nc\u202ed\udcff"), tmp_path / "a.svg")
    assert any("a\ufffdb c\ufffdd\ufffd" in text for text in texts_of_svg(tmp_path / "a.svg"))


def test_png_is_as_wide_as_the_column_at_300_dots_per_inch(specimen: Specimen, tmp_path: Path) -> None:
    save(specimen("knee"), tmp_path / "a.PNG")
    width = imread(tmp_path / "a.PNG", format="png").shape[1] / 300.0 * INCH
    assert min(abs(width - SINGLE), abs(width - DOUBLE)) < INCH / 300.0


def test_another_ending_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"a\.jpg: figures are written as \.svg, \.pdf, \.png"):
        save(Figure(), tmp_path / "a.jpg")
    assert not list(tmp_path.iterdir())


def test_pyplot_is_not_loaded() -> None:
    program = (
        "import sys, numpy as np\n"
        "from geocontact.view.curves.quantity import FORCE\n"
        "from geocontact.view.curves.residuals import residual_figure\n"
        "assert 'matplotlib' not in sys.modules\n"
        "residual_figure(np.arange(9.0), FORCE).canvas.draw()\n"
        "assert 'matplotlib.pyplot' not in sys.modules\n"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
