"""Published contact areas: sources of the table, and a run beside them by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from geocontact.data.published_areas import PUBLISHED_AREAS, PublishedArea
from geocontact.geometry.contact_area.published import AreasWithin, KneeRun, beside_published, published_sentences

MM, MM2 = 1e-3, 1e-6
FILM = "film 1995, seven implants"
FLEXION = np.radians([0.0, 30.0, 60.0])


def row(table: pd.DataFrame, name: str = FILM) -> pd.Series:
    """The row of one publication."""
    return table[table["published"] == name].iloc[0]


def pressed(area: list[float], load: float = 2000.0) -> KneeRun:
    """Areas [mm^2] under a load at 0, 30 and 60 degrees."""
    return KneeRun(FLEXION, np.full(3, load), {"total": np.array(area) * MM2})


def test_every_row_says_where_its_number_was_read() -> None:
    names = [each.name for each in PUBLISHED_AREAS]
    assert len(set(names)) == len(names) > 8
    for each in PUBLISHED_AREAS:
        assert each.citation and "http" in each.read_in
        assert 0.0 <= each.least <= each.most and (each.threshold is None) == (each.basis != "within a distance")
        assert each.doi.startswith("10.") or each.name.startswith("Szivek 1996")


def test_areas_of_films_carry_the_load_at_the_average_stress() -> None:
    """2000 N at 25 and 13 MPa: the abstract has the stresses, the balance of forces the areas."""
    found = next(each for each in PUBLISHED_AREAS if each.name == FILM)
    assert found.least * 25e6 == pytest.approx(2000.0) and found.most * 13e6 == pytest.approx(2000.0)
    assert found.most / MM2 == pytest.approx(153.846, abs=1e-3)


def test_the_mean_over_frames_at_flexion_and_load_is_compared() -> None:
    found = row(beside_published(pressed([100.0, 120.0, 170.0])))
    assert found["ours [mm^2]"] == pytest.approx(130.0) and found["comparable"] == "yes"
    assert found["difference [mm^2]"] == 0.0 and found["relative [-]"] == 0.0
    above = row(beside_published(pressed([200.0, 200.0, 200.0])))
    assert above["difference [mm^2]"] == pytest.approx(200.0 - 2000.0 / 13.0)
    assert above["relative [-]"] == pytest.approx(0.3)
    below = row(beside_published(pressed([60.0, 60.0, 60.0])))
    assert below["difference [mm^2]"] == pytest.approx(-20.0) and below["relative [-]"] == pytest.approx(-0.25)


def test_open_ends_are_no_numbers() -> None:
    """200 mm^2 or more; up to 100 mm^2."""
    table = beside_published(pressed([150.0, 150.0, 150.0]))
    at_least, at_most = (row(table, name) for name in table["published"][1:3])
    assert at_least["difference [mm^2]"] == pytest.approx(-50.0) and np.isnan(at_least["area_most [mm^2]"])
    assert at_most["difference [mm^2]"] == pytest.approx(50.0) and at_most["relative [-]"] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("run", "why"),
    [
        (KneeRun(within={"total": AreasWithin(np.array([4 * MM]), np.ones((1, 1)))}), "presses nothing"),
        (replace(pressed([1.0, 1.0, 1.0]), flexion=None), "the flexion of this run is not known"),
        (replace(pressed([1.0, 1.0, 1.0]), flexion=FLEXION + 2.0), "this run flexes by 115 … 175°, not by 0 … 60°"),
        (pressed([1.0, 1.0, 1.0], 1000.0), "its load is 2000 N, that of this run 1000 N there"),
    ],
)
def test_what_cannot_be_compared_says_why(run: KneeRun, why: str) -> None:
    found = row(beside_published(run))
    assert found["comparable"] == "no" and why in found["why"] and np.isnan(found["ours [mm^2]"])


def test_natural_knees_are_not_compared_with_an_implant() -> None:
    found = row(beside_published(pressed([1.0, 1.0, 1.0], 1000.0)), "Fukubayashi 1980, with menisci")
    assert found["why"] == "it is of a natural knee" and found["area_least [mm^2]"] == 1150.0


def test_the_threshold_that_gives_an_area_is_linear_between_those_evaluated() -> None:
    """Areas of 1000 mm^2 for each mm at 0 degrees, of 500 at 60: 80 to 153.8 mm^2 are 0.08 to 0.31 mm."""
    levels = np.array([0.0, 1.0, 4.0]) * MM
    areas = np.outer([1000.0, 500.0], levels / MM) * MM2
    run = KneeRun(np.radians([0.0, 60.0]), within={"total": AreasWithin(levels, areas)})
    found = row(beside_published(run))
    assert found["threshold_least [mm]"] == pytest.approx(0.08)
    assert found["threshold_most [mm]"] == pytest.approx(0.307692, abs=1e-6)
    natural = row(beside_published(run), "Fukubayashi 1980, with menisci")
    assert natural["threshold_least [mm]"] == pytest.approx(1.15), "at 0 degrees alone"


def test_the_peak_of_a_walk_is_compared_at_its_own_threshold() -> None:
    areas = np.array([[900.0, 1000.0], [950.0, 1200.0]]) * MM2
    run = KneeRun(within={"total": AreasWithin(np.array([1.0, 4.0]) * MM, areas)})
    found = row(beside_published(run), "JW 2015, peak of five walks")
    assert found["ours [mm^2]"] == pytest.approx(1200.0) and found["difference [mm^2]"] == pytest.approx(83.0)
    other = row(beside_published(replace(run, swept=True)), "JW 2015, peak of five walks")
    assert other["why"] == "it is the peak of a walk, this run sweeps an angle"
    missing = KneeRun(within={"total": AreasWithin(np.array([1.0]) * MM, areas[:, :1])})
    assert "4 mm, was not evaluated" in row(beside_published(missing), "JW 2015, peak of five walks")["why"]


def test_sentences_count_what_is_not_comparable() -> None:
    said = published_sentences(beside_published(pressed([200.0, 200.0, 200.0])))
    assert said[0] == f"{FILM}: 80 … 154 mm^2 published, 200.0 mm^2 here, 46.2 mm^2 above it"
    assert said[-1].startswith(
        f"{len(PUBLISHED_AREAS) - 3} of {len(PUBLISHED_AREAS)} published areas are not comparable"
    )


def test_a_side_that_a_run_does_not_have_is_said() -> None:
    one: PublishedArea = replace(PUBLISHED_AREAS[0], side="medial")
    assert row(beside_published(pressed([1.0, 1.0, 1.0]), [one]))["why"] == "this run has no medial side"
