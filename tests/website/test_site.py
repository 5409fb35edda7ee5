"""Pages that are made from other files are up to date, and the site's contents name every page."""

from __future__ import annotations

from pathlib import Path

import nbformat
import pytest

from website.contents import listed
from website.kept_outputs import plain
from website.limits import sections, xfails
from website.notebooks import describe, execute
from website.pages import MADE
from website.stage import INDEX, ROOT, pages, stage, with_tables_marked
from website.validation import FACTORS, report


@pytest.mark.parametrize("place", MADE)
def test_a_generated_page_is_up_to_date(place: str) -> None:
    assert (ROOT / place).read_text(encoding="utf-8") == MADE[place](), "run `python -m website.pages`"


def test_every_page_stands_in_the_contents_once() -> None:
    index = (ROOT / INDEX).read_text(encoding="utf-8")
    named = [(ROOT / "docs" / page).resolve().relative_to(ROOT) for _, found in listed(index) for page in found]
    assert sorted(named) == [page for page in pages() if page != Path(INDEX)]


@pytest.mark.parametrize(
    ("title", "what"),
    [(one, one) for one in ("implant", "mat", "exoskeleton", "prosthesis", "simulator", "study")]
    + [("markers and plates", "markers")],
)
def test_the_index_leads_from_what_a_reader_has_to_a_guide(title: str, what: str) -> None:
    index = (ROOT / INDEX).read_text(encoding="utf-8")
    _, _, below = index.partition(f"\n### My {title}\n")
    assert f"(how-to/my_{what}.md)" in below.partition("\n#")[0]
    assert (ROOT / "docs" / "how-to" / f"my_{what}.md").read_text(encoding="utf-8").startswith(f"# My {title}\n")


def test_every_page_is_reached_from_another_one_than_the_index() -> None:
    index, written = ROOT / INDEX, [ROOT / page for page in pages() if page.suffix == ".md"]
    told = {one: one.read_text(encoding="utf-8") for one in written if one != index}
    lost = [one.name for one in told if not any(f"{one.name}" in text for other, text in told.items() if other != one)]
    assert {name for name in lost if not name[0].isdigit()} == set(), "decisions stand by themselves"


def test_warnings_of_notebooks_name_no_place_of_this_machine() -> None:
    told = "/tmp/ipykernel_12/34.py:1: InputWarning: /tmp/a/meshes/truth.csv is odd\n  found = gc.mat(\nelse\n"
    assert plain(told, "/tmp/a") == "InputWarning: meshes/truth.csv is odd\nelse\n"


@pytest.mark.slow
def test_a_notebook_is_run_in_a_folder_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "notebooks").mkdir()
    file = tmp_path / "notebooks" / "one.ipynb"
    cell = nbformat.v4.new_code_cell("from pathlib import Path\nPath('meshes/gait.csv').is_file()")
    nbformat.write(nbformat.v4.new_notebook(cells=[cell]), file)
    execute(tmp_path)
    (done,) = nbformat.read(file, as_version=4).cells
    assert done.outputs[0]["data"]["text/plain"] == "True"


def test_figures_of_notebooks_are_described_by_the_text_above() -> None:
    shown = nbformat.v4.new_output("display_data", {"image/png": ""})
    text = nbformat.v4.new_markdown_cell("The `area` on either half. And more.")
    drawn, printed = (nbformat.v4.new_code_cell("x", outputs=outputs) for outputs in ([shown], []))
    describe([text, drawn, printed])
    assert drawn.metadata["mystnb"]["image"]["alt"] == "Figure: The area on either half"
    assert "mystnb" not in printed.metadata


def test_pages_and_the_files_that_they_link_to_are_staged(tmp_path: Path) -> None:
    stage(tmp_path / "sources", {"docs/reference/api/index.md": "# Functions\n"})
    staged = tmp_path / "sources"
    assert all((staged / page).is_file() for page in pages())
    assert (staged / "docs/reference/gap_reliability.svg").is_file()
    index = (staged / INDEX).read_text(encoding="utf-8")
    assert "/docs/tutorial\n" in index and "(reference/api/index.md)" in index


def test_only_tables_that_are_printed_keep_their_lines() -> None:
    sentence, table = "```text\nresults in result: a.csv\n```\n", "```text\n time [s]  ours  theirs\n0  1.5  2.0\n```\n"
    assert with_tables_marked(sentence) == sentence
    assert with_tables_marked(sentence + table) == sentence + table.replace(
        "```text\n", "```{code-block} text\n:class: columns\n\n"
    )


def test_limits_are_read_from_their_sections_without_code() -> None:
    text = "# A\n\n## Limits\n\nNone.\n\n```sh\nx\n```\n\n## Else\n\nNo.\n"
    assert sections(text) == [("Limits", "None.")]


def test_reasons_of_expected_failures_are_found() -> None:
    found = dict(reversed(one) for one in xfails())
    assert "8 nats of two short trials name nothing since held-out trials decide" in found
    assert sum(place == "tests/real/test_real_gap.py" for place in found.values()) > 3, "those in tables"


def test_evidence_of_an_unknown_factor_is_refused(tmp_path: Path) -> None:
    words = tmp_path / "words.toml"
    aims = "".join(
        f'{name} = ""\n' for name in ("question", "context", "influence", "consequence", "risk", "judgement")
    )
    words.write_text(f'introduction = []\n[system.a]\n{aims}more = {{}}\n[[system.a.evidence."Luck"]]\ntext = "x"\n')
    assert "Luck" not in FACTORS
    with pytest.raises(ValueError, match="Luck"):
        report(words)
