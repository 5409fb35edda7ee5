"""The page of an identification says first whether the law describes the forces, then what E* is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.frame.result import REPORT
from geocontact.analyses.modulus.result import ModulusResult, modulus
from geocontact.analyses.modulus.show import moduli, modulus_curves, modulus_page
from geocontact.data.errors import InputWarning
from geocontact.view.page.content import Curves, Intervals, Page
from tests.analyses.modulus.synthetic_step import SHARE, areas, forces
from tests.identify.synthetic_contact import TRUE


def page_of(result: ModulusResult) -> Page:
    return modulus_page("E*", result.found, modulus_curves(result.found), [moduli(result.found)])


def test_a_law_that_holds_gives_its_modulus_and_the_interval(tmp_path: Path) -> None:
    page = page_of(modulus(areas(tmp_path), forces(tmp_path, sides=False), radius=0.037, bootstrap=0))
    assert page.headline[0].startswith(f"E* is {TRUE * 1e-6:g} MPa (95 %") and "R² 1.00" in page.headline[0]
    assert page.leads and isinstance(page.sections[page.leads[0]], Intervals)
    assert not page.plays and len(page.facts) <= 5


def test_a_law_that_does_not_hold_is_said_before_its_modulus(tmp_path: Path) -> None:
    """The force falls while the area grows: the best E* describes nothing."""
    file = forces(tmp_path, sides=False)
    table = pd.read_csv(file)
    name = table.columns[-1]
    table[name] = table[name].max() + table[name].min() - table[name]
    table.to_csv(file, index=False)
    with pytest.warns(InputWarning, match="contradicts its data"):
        page = modulus(areas(tmp_path), file, radius=0.037, bootstrap=0).pages({})[REPORT]
    assert isinstance(page, Page)
    assert page.headline[0].startswith("The law does not describe the total force: R² −")
    assert page.headline[0].endswith("a constant force would do better.")
    assert len(page.headline) == 1, "no E* is an answer to forces that contradict the law"
    assert page.leads and isinstance(page.sections[page.leads[0]], Curves), "the forces show why"


def test_a_soft_body_that_sticks_is_identified_and_named_with_its_law(tmp_path: Path) -> None:
    """1.4 MPa by Johnson, Kendall and Roberts' own formula, w = 1 J/m² given, the areas of the synthetic step."""
    file = areas(tmp_path)
    rows = pd.read_csv(file)
    at = rows[rows["threshold [mm]"] == 4.0]
    cubed = (at["area_fixed [mm^2]"].to_numpy() * 1e-6 / np.pi) ** 1.5
    force = 4.0 / 3.0 * 1.4e6 * cubed / 0.037 - np.sqrt(8.0 * np.pi * 1.0 * 1.4e6 * cubed)
    pd.DataFrame({"time [s]": at["time [s]"], "total [N]": force}).to_csv(tmp_path / "jkr.csv", index=False)
    result = modulus(file, tmp_path / "jkr.csv", radius=0.037, adhesion="jkr", work_of_adhesion=1.0, bootstrap=100)
    assert result.modulus == pytest.approx(1.4e6, rel=1e-6)
    sticks = "JKR's adhesion with a work of 1 J/m²"
    page = page_of(result)
    assert f"the law with {sticks} meets the total force" in page.headline[0]
    assert sticks in page.subtitle and sticks in repr(result)


def test_two_patches_read_as_one_are_not_the_answer(tmp_path: Path) -> None:
    """The law's own force of each side, and their sum: by hand the total is too soft by the sum of the shares' powers.

    Both sides have the same modulus; A^3/2 (s^3/2 + (1 - s)^3/2) is the total's force, A^3/2 what it is read by.
    """
    file = forces(tmp_path)
    table = pd.read_csv(file)
    table["total [N]"] = table["medial [N]"] + table["lateral [N]"]
    table.to_csv(file, index=False)
    result = modulus(areas(tmp_path), file, radius=0.037, bootstrap=0)
    soft = TRUE * (SHARE**1.5 + (1.0 - SHARE) ** 1.5)
    assert result.modulus == pytest.approx(soft, rel=1e-3), "the first side stays the total"
    page = page_of(result)
    assert page.headline[0].startswith(f"E* is {TRUE * 1e-6:g} MPa (95 %") and "lateral: the law" in page.headline[0]
    assert page.headline[1].startswith(f"Use E* of the sides, which agree: the total's {soft * 1e-6:.4g} MPa reads two")
    assert [name for name, _ in page.facts][:3] == ["E*, medial, use", "E*, lateral, use", "E*, total, do not use"]
    assert any(line.startswith("use E* of the sides") for line in result.sentences)


@pytest.mark.parametrize(("factor", "words"), [(1.0, "use E* of the total: "), (2.0, "since they differ")])
def test_the_total_is_the_answer_where_all_agree(tmp_path: Path, factor: float, words: str) -> None:
    """Total and sides of one modulus; then a lateral side that is twice as stiff."""
    file = forces(tmp_path)
    table = pd.read_csv(file)
    table["total [N]"] = (table["medial [N]"] + table["lateral [N]"]) / (SHARE**1.5 + (1.0 - SHARE) ** 1.5)
    table["lateral [N]"] *= factor
    table.to_csv(file, index=False)
    result = modulus(areas(tmp_path), file, radius=0.037, bootstrap=0)
    assert any(words in line for line in result.sentences)
    assert page_of(result).facts[0][0] == ("E*, total, use" if factor == 1.0 else "E*, medial, use")
