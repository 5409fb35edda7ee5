"""A design with straps at shank and pelvis: the model is that of the calibration, with a peak for each strap."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from casadi import Function

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.sit_to_stand.design.designs import read
from geocontact.analyses.sit_to_stand.design.options import StandingDesignOptions
from geocontact.standing_up.assistance_design import NAMES
from geocontact.standing_up.assisted_model import EVERY_ASSISTED, SHARE, HabitSizes, assisted_model
from geocontact.standing_up.assisted_movement import measures_of
from geocontact.standing_up.chain import EVERY_PLANTED, Subject
from geocontact.standing_up.exoskeleton import STRAP_PLANTED, strapped
from geocontact.standing_up.help_search import design_numbers
from geocontact.standing_up.strap_sites import STRAP_SITES
from meshes.standing_study import SITES_PLANTED
from tests.cli.calls import MESHES
from tests.recording import opened
from tests.unchecked import unchecked

SESSION = MESHES / "standing_up_sites"
SITES = tuple(replace(site, damping=7.0 + k, turning_damping=0.2 + 0.1 * k) for k, site in enumerate(STRAP_SITES))


@pytest.mark.parametrize("sites", [SITES[:1], SITES, (SITES[0], SITES[2])], ids=["thigh", "all", "pelvis"])
def test_without_help_it_is_the_model_of_the_calibration(sites: tuple) -> None:
    """Balance and normal forces at anything; parameters stand in another order, those of absent sites do nothing."""
    subject = Subject(66.0, 1.7)
    helped, known = assisted_model(subject, sites=sites), strapped(subject, sites)
    p = np.r_[EVERY_PLANTED, STRAP_PLANTED, 0.0, 0.25, SITES_PLANTED][: len(helped.standing.parameters)]
    by_name = {each.name: value for each, value in zip(EVERY_ASSISTED, p, strict=False)}
    own = np.array([by_name[each.name] for each in known.parameters])
    rng = np.random.default_rng(4)
    q = np.r_[0.0, 0.082, 0.0, 0.3 * rng.normal(size=6)]
    u, a, torque = rng.normal(size=9) * np.r_[0.1, 0.1, np.ones(7)], 3.0 * rng.normal(size=9), rng.normal(size=4)
    found = []
    for model, given, inputs in (
        (helped.standing, p, np.r_[0.4, torque]),
        (known, own, np.r_[torque[:3], 0.0, 0.0, torque[3]]),
    ):
        e = model.equations
        at = Function("at", [e.q, e.u, e.a, e.w, e.p], [e.balance, model.straps])
        found.append([each.full().ravel() for each in at(q, u, a, inputs, given)])
    np.testing.assert_allclose(found[0][0], found[1][0], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(found[0][1], found[1][1], rtol=1e-9)
    assert measures_of(helped) == ("strap", "knee", "energy", "shear", *(site.name for site in sites[1:]))
    assert p[SHARE] == 0.0 and NAMES[-1] == "pelvis strap place"


@pytest.mark.parametrize("sites", [SITES[:1], SITES, (SITES[0], SITES[2])], ids=["thigh", "all", "pelvis"])
def test_numbers_have_the_straps_that_are_there(sites: tuple) -> None:
    """Every parameter of a present strap, none of an absent one, with the design's name before it."""
    model = assisted_model(Subject(), sites=sites)
    found = SimpleNamespace(p=np.zeros(len(model.standing.parameters)), motions=())
    movement = SimpleNamespace(found=found, sizes=HabitSizes(), asked=SimpleNamespace(order=24, places=9))
    with unchecked():
        rows = design_numbers(model, [SimpleNamespace(name="chosen", movement=movement, design=None)], ())  # type: ignore[list-item]
    named = {row.number for row in rows}
    for site in SITES:
        for name in site.names:
            assert (f"chosen {name}" in named) == (site in sites), name


@pytest.mark.parametrize(
    ("options", "words"), [({"vary": "share,shank_place"}, "'shank_place'"), ({"aim": "pelvis"}, "'pelvis'")]
)
def test_a_strap_that_is_not_there_cannot_be_chosen(options: dict[str, str], words: str) -> None:
    planted = Path(MESHES) / "standing_up_exoskeleton" / "truth.csv"
    with pytest.raises(gc.InputError, match=f"{words} is of a strap at the .*, and no trial of study.toml has one"):
        gc.sit_to_stand.design(MESHES / "standing_up_held_out" / "study.toml", parameters=planted, **options)


def test_weights_of_a_study_are_not_those_of_a_design(tmp_path: Path) -> None:
    """A warning, and everything else is read."""
    sample = MESHES / "standing_up_held_out"
    for file in sample.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    study = tmp_path / "study.toml"
    study.write_text(study.read_text().replace("[noise]", "[weights]\ntorques = 2e-6\n\n[noise]"))
    record = opened(Record("sit-to-stand design", {}))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        given = read(StandingDesignOptions(study, parameters=MESHES / "standing_up_exoskeleton" / "truth.csv"))
    assert given.trials.weights.torques == 2e-6 and len(given.p) == 13
    assert any("a design has its own" in line for line in record.warnings)


@pytest.mark.slow
def test_a_place_at_the_pelvis_is_chosen_for_the_strap_there(tmp_path: Path) -> None:
    """From one trial with mats at the pelvis: the peak there is no higher than without help."""
    study = tmp_path / "study.toml"
    parts = (SESSION / "study.toml").read_text().split("\n[[trials]]")
    study.write_text(
        "\n[[trials]]".join([*parts[:1], parts[1].replace('= "T1', f'= "{SESSION}/T1')]).replace(
            f'name = "{SESSION}/T1"', 'name = "T1"'
        )
    )
    given = {"parameters": SESSION / "truth.csv", "aim": "pelvis", "nodes": 8, "knee": 1.0}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.sit_to_stand.design(study, vary="share,pelvis_place", **given)
    best = found.best.movement.asked.at("pelvis")
    rows = found.table("designs").set_index("design")
    assert best <= rows.loc["without help", "pelvis [N]"] and 0.0 <= found.chosen["pelvis_place"] <= 0.22
    assert rows.loc["chosen", "pelvis_place [mm]"] == pytest.approx(1e3 * found.chosen["pelvis_place"])
