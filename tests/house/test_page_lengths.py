"""Pages of theory and reference do not grow again: words in all, words a page, letters a line."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.house.first_screens import ROOT

MOST = 3_500
"""Words of the longest page."""
ALL_WORDS = 55_200
"""Words of theory and reference together, made pages aside; lowered when pages become shorter."""
LIMITS = {
    "reference/accuracy.md": 330,
    "reference/area_csv.md": 830,
    "reference/command_line.md": 440,
    "reference/corrected_numbers.md": 1440,
    "reference/durability.md": 420,
    "reference/gap_benchmark.md": 3460,
    "reference/gap_case.md": 930,
    "reference/gap_effects.md": 1060,
    "reference/gap_real_data.md": 2010,
    "reference/input_files.md": 2190,
    "reference/large_study.md": 970,
    "reference/mat_files.md": 870,
    "reference/opensim_models.md": 1280,
    "reference/paper_004.md": 1470,
    "reference/real_implants.md": 660,
    "reference/speed.md": 1190,
    "reference/terms.md": 730,
    "reference/written_files.md": 2780,
    "theory/centre_of_pressure.md": 600,
    "theory/collocation.md": 860,
    "theory/contact_area.md": 1870,
    "theory/contact_laws.md": 1570,
    "theory/corrections.md": 1100,
    "theory/elastic_identification.md": 630,
    "theory/elbow_misalignment.md": 1660,
    "theory/fitting.md": 630,
    "theory/gap_diagnosis.md": 3490,
    "theory/gap_models.md": 1450,
    "theory/mat_draping.md": 1280,
    "theory/multibody.md": 750,
    "theory/planar_joint.md": 510,
    "theory/prosthesis_both_sides.md": 1070,
    "theory/prosthesis_calibration.md": 1210,
    "theory/prosthesis_compare.md": 900,
    "theory/prosthesis_design.md": 1490,
    "theory/prosthesis_gap.md": 920,
    "theory/prosthesis_keel.md": 1170,
    "theory/prosthesis_stance.md": 1430,
    "theory/shoulder_exoskeleton.md": 2560,
    "theory/shoulder_support.md": 1390,
    "theory/sit_to_stand.md": 3470,
    "theory/sit_to_stand_gap.md": 630,
}
"""Words of pages as they were last shortened, rounded up to ten."""
LONGEST_LINE = 120
RELEASES = {"Unreleased": 60, "0.1.0": 60}
PAGES = sorted(path for folder in ("theory", "reference") for path in (ROOT / "docs" / folder).glob("*.md"))
MADE = ("limits.md", "validation.md", "gap_constants.md", "descriptions.md")
"""Pages made by `python -m website.pages`: a paragraph is one line there, and they grow with what they are made of."""


def words(text: str) -> int:
    """As `wc -w` counts them."""
    return len(text.split())


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_a_page_has_no_more_words_than_before(path: Path) -> None:
    name = f"{path.parent.name}/{path.name}"
    count = words(path.read_text(encoding="utf-8"))
    assert count <= LIMITS.get(name, MOST), f"{name}: {count} words"


def test_all_pages_together() -> None:
    written = [path for path in PAGES if path.name not in MADE]
    assert sum(words(path.read_text(encoding="utf-8")) for path in written) <= ALL_WORDS


@pytest.mark.parametrize("path", [one for one in PAGES if one.name not in MADE], ids=lambda path: path.stem)
def test_lines_of_prose_are_short(path: Path) -> None:
    """Rows of tables, figures and lines of code cannot be broken."""
    text = re.sub(r"^```.*?^```", "", path.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    long = [
        line
        for line in text.splitlines()
        if len(line) > LONGEST_LINE and not re.match(r"\s*\||!\[| {4}", line) and " " in line.strip()
    ]
    assert long == []


def test_the_changelog_has_one_line_for_one_thing() -> None:
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    for release, body in re.findall(r"^## (\S+).*\n((?:(?!## ).*\n)*)", text, re.MULTILINE):
        lines = [line for line in body.splitlines() if line]
        assert all(line.startswith("- ") and len(line) <= LONGEST_LINE for line in lines), release
        if release in RELEASES:
            assert len(lines) <= RELEASES[release], release
