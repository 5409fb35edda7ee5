"""What notebooks keep of their outputs: the same after every run, small, and bound to their code."""

from __future__ import annotations

import base64
import copy
import html
import io
import json
from pathlib import Path
from typing import Any

import nbformat
import numpy as np
import PIL.Image
import pytest

from website import notebooks
from website.kept_outputs import LARGEST_PICTURE, code_hash, kept, small


def drawn(pixels: Any) -> bytes:
    """A picture with a word of its maker."""
    from PIL.PngImagePlugin import PngInfo

    maker, file = PngInfo(), io.BytesIO()
    maker.add_text("Software", "somebody")
    PIL.Image.fromarray(pixels).save(file, "PNG", pnginfo=maker)
    return file.getvalue()


SQUARE = drawn(np.full((4, 6, 3), 200, np.uint8))
NOISE = drawn(np.random.default_rng(5).integers(0, 256, (800, 1280, 3), dtype=np.uint8))


def shown(folder: str, pieces: list[str], moment: str) -> Any:
    """A notebook as it comes from a run in that folder, its stream cut into pieces."""
    v4 = nbformat.v4
    outputs = [v4.new_output("stream", name="stdout", text=piece) for piece in pieces]
    outputs.append(v4.new_output("stream", name="stderr", text=f"{folder}/ipykernel_7/8.py:1: UserWarning: odd\n  x\n"))
    inside = base64.b64encode(SQUARE).decode()
    result = {
        "text/html": f'<p>said</p><img src="data:image/png;base64,{inside}" alt="Figure: said"/>',
        "text/plain": "<R>",
    }
    outputs.append(v4.new_output("execute_result", result, execution_count=1))
    page = html.escape("<!doctype html><p>live</p>")
    frame = {
        "text/html": f'<iframe srcdoc="{page}" sandbox="allow-scripts"></iframe>',
        "text/plain": "Embedded(height=640)",
    }
    outputs.append(v4.new_output("execute_result", frame, execution_count=1))
    cell = v4.new_code_cell(
        "x = 1\nx", outputs=outputs, id="a", metadata={"execution": {"shell.execute_reply": moment}}
    )
    book = v4.new_notebook(cells=[v4.new_markdown_cell("Words.", id="b"), cell])
    book.metadata["language_info"] = {"name": "python", "version": "3.11.2"}
    return book


def test_two_runs_leave_the_same_bytes() -> None:
    pages: list[str] = []

    def photograph(page: str) -> bytes:
        pages.append(page)
        return SQUARE

    one = kept(shown("/tmp/one", ["read /tmp/one/", "a.csv\n"], "1"), "/tmp/one", photograph)
    other = kept(shown("/tmp/other", ["read /tmp/other/a.csv\n"], "2"), "/tmp/other", photograph)
    assert nbformat.writes(one) == nbformat.writes(other)
    assert pages == ["<!doctype html><p>live</p>"] * 2
    stdout, stderr, words, figure, live = one.cells[1].outputs
    assert stdout.text == "read a.csv\n" and stderr.text == "UserWarning: odd\n"
    assert words.data["text/html"] == "<p>said</p>" and figure.data["text/plain"] == "Figure: said"
    assert "text/html" not in live.data and {"image/png"} < set(live.data)
    picture = PIL.Image.open(io.BytesIO(base64.b64decode(figure.data["image/png"])))
    assert picture.convert("RGB").getpixel((0, 0)) == (200, 200, 200) and picture.info == {}


def test_a_changed_cell_of_code_changes_the_hash_and_words_do_not() -> None:
    book = kept(shown("/tmp/one", ["a\n"], "1"), "/tmp/one", lambda page: SQUARE)
    told = book.metadata["geocontact"]["code_sha256"]
    assert code_hash(json.loads(nbformat.writes(book))["cells"]) == told, "lines of a file are a list"
    worded, changed = copy.deepcopy(book), copy.deepcopy(book)
    worded.cells[0].source = "Other words."
    changed.cells[1].source = "x = 2\nx"
    assert code_hash(worded.cells) == told != code_hash(changed.cells)


def test_a_picture_that_is_large_loses_colours_and_size() -> None:
    assert len(NOISE) > 10 * LARGEST_PICTURE
    found = small(NOISE)
    image = PIL.Image.open(io.BytesIO(found))
    assert (
        len(found) <= LARGEST_PICTURE and image.width < 1280 and image.width / image.height == pytest.approx(1.6, 0.02)
    )


def test_what_is_transparent_is_on_white() -> None:
    clear = np.zeros((4, 4, 4), np.uint8)
    assert PIL.Image.open(io.BytesIO(small(drawn(clear)))).convert("RGB").getpixel((1, 1)) == (255, 255, 255)


@pytest.mark.slow
def test_a_notebook_is_written_with_its_outputs(tmp_path: Path) -> None:
    file = tmp_path / "one.ipynb"
    code = nbformat.v4.new_code_cell(
        "from pathlib import Path\nprint(Path('meshes').resolve().name, Path.cwd() / 'a')", id="a"
    )
    nbformat.write(nbformat.v4.new_notebook(cells=[code]), file)
    notebooks.keep(file, lambda page, scheme: SQUARE)
    first = file.read_bytes()
    (cell,) = nbformat.read(file, as_version=4).cells
    assert cell.outputs[0].text == "meshes a\n" and cell.execution_count == 1 and cell.metadata == {}
    notebooks.keep(file, lambda page, scheme: SQUARE)
    assert file.read_bytes() == first


def test_an_unknown_notebook_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        notebooks.main(["nobody"])
    assert "no notebook nobody; there are contact_area," in capsys.readouterr().err
