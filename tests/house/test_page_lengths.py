"""Pages do not grow again: words in all, words a page, letters a line."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.house.first_screens import ROOT

MOST = 3_500
"""Words of the longest page."""
ALL_WORDS = {"theory, reference": 47_440, "how-to": 28_100, "everything": 91_970}
"""Words of theory and reference together, made pages aside, of the guides, and of all pages; lowered when they become
shorter. Bars of tables count, as `wc -w` counts them. Raised by what was new: tables of checks, which are made from
their entries and name what the tests hold of each; sensors beside the force of an elbow; a shoulder's
controller; a foot of one's own; files of strangers; movements, shear, walking and muscles, a whole body in the
plane, pairs of bodies, keys and checks of made pages; marker sets, folders, an exoskeleton and a person of one's
own, picked landmarks, bodies at rest on several others, feet of a model, a window, segments and sensors, commands
beside peers and the growth of all."""
LIMITS = {
    "how-to/cohort.md": 950,
    "how-to/compare.md": 240,
    "how-to/cop.md": 1010,
    "how-to/elbow.md": 1350,
    "how-to/elbow_design.md": 950,
    "how-to/figures.md": 440,
    "how-to/fit.md": 640,
    "how-to/gap.md": 2010,
    "how-to/inverse.md": 1340,
    "how-to/knee_chain.md": 1050,
    "how-to/knee_settle.md": 920,
    "how-to/loadcells.md": 600,
    "how-to/mat.md": 1340,
    "how-to/modulus.md": 630,
    "how-to/my_exoskeleton.md": 500,
    "how-to/my_implant.md": 400,
    "how-to/my_markers.md": 540,
    "how-to/my_mat.md": 330,
    "how-to/my_prosthesis.md": 310,
    "how-to/my_simulator.md": 610,
    "how-to/my_study.md": 290,
    "how-to/open_or_closed.md": 440,
    "how-to/opensim_motion.md": 380,
    "how-to/other_programs.md": 260,
    "how-to/own_model.md": 1710,
    "how-to/page.md": 790,
    "how-to/paraview.md": 300,
    "how-to/pressure.md": 580,
    "how-to/prosthesis.md": 1540,
    "how-to/regions_and_sides.md": 440,
    "how-to/shoulder.md": 1060,
    "how-to/shoulder_support.md": 1040,
    "how-to/sit_to_stand.md": 1110,
    "how-to/sit_to_stand_design.md": 340,
    "how-to/units.md": 360,
    "reference/accuracy.md": 430,
    "reference/area_csv.md": 790,
    "reference/command_line.md": 420,
    "reference/corrected_numbers.md": 430,
    "reference/durability.md": 410,
    "reference/gap_benchmark.md": 2570,
    "reference/gap_case.md": 900,
    "reference/gap_effects.md": 1050,
    "reference/gap_real_data.md": 1620,
    "reference/input_files.md": 1900,
    "reference/large_study.md": 590,
    "reference/mat_files.md": 850,
    "reference/opensim_models.md": 600,
    "reference/paper_004.md": 1180,
    "reference/real_implants.md": 550,
    "reference/speed.md": 1360,
    "reference/terms.md": 540,
    "reference/written_files.md": 1800,
    "theory/centre_of_pressure.md": 720,
    "theory/collocation.md": 760,
    "theory/contact_area.md": 1660,
    "theory/contact_laws.md": 1440,
    "theory/corrections.md": 1060,
    "theory/elastic_identification.md": 570,
    "theory/elbow_misalignment.md": 1460,
    "theory/fitting.md": 600,
    "theory/gap_diagnosis.md": 3420,
    "theory/gap_models.md": 1340,
    "theory/mat_draping.md": 1070,
    "theory/multibody.md": 700,
    "theory/planar_joint.md": 500,
    "reference/descriptions.md": 4240,
    "theory/prosthesis_both_sides.md": 880,
    "theory/prosthesis_calibration.md": 1050,
    "theory/prosthesis_compare.md": 790,
    "theory/prosthesis_design.md": 1280,
    "theory/prosthesis_gap.md": 850,
    "theory/prosthesis_keel.md": 950,
    "theory/prosthesis_stance.md": 1140,
    "theory/shoulder_exoskeleton.md": 2160,
    "theory/shoulder_support.md": 1220,
    "theory/sit_to_stand.md": 2830,
    "theory/sit_to_stand_gap.md": 600,
}
"""Words of pages as they were last shortened, rounded up to ten."""
LONGEST_LINE = 120
RELEASES = {"Unreleased": 80, "0.1.0": 60}
THEORY = sorted(path for folder in ("theory", "reference") for path in (ROOT / "docs" / folder).glob("*.md"))
PAGES = sorted([*THEORY, *(ROOT / "docs" / "how-to").glob("*.md")])
MADE = ("limits.md", "validation.md", "gap_constants.md", "descriptions.md", "trial_checks.md")
"""Pages made by `python -m website.pages`: a paragraph is one line there, and they grow with what they are made of."""


def words(text: str) -> int:
    """As `wc -w` counts them."""
    return len(text.split())


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_a_page_has_no_more_words_than_before(path: Path) -> None:
    name = f"{path.parent.name}/{path.name}"
    count = words(path.read_text(encoding="utf-8"))
    assert count <= LIMITS.get(name, MOST), f"{name}: {count} words"


@pytest.mark.parametrize(
    ("what", "pages"),
    [
        ("theory, reference", [path for path in THEORY if path.name not in MADE]),
        ("how-to", [path for path in PAGES if path not in THEORY]),
        ("everything", sorted((ROOT / "docs").rglob("*.md"))),
    ],
)
def test_all_pages_together(what: str, pages: list[Path]) -> None:
    assert sum(words(path.read_text(encoding="utf-8")) for path in pages) <= ALL_WORDS[what]


@pytest.mark.parametrize("path", [one for one in THEORY if one.name not in MADE], ids=lambda path: path.stem)
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
