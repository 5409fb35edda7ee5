"""Synthetic cases of strapped sites, made with the package's own model: what a site lacks is found, and found there."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from geocontact.chain.system import System
from geocontact.data.diagnosis import Diagnosis
from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.gap.diagnose import diagnose
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.systems.examples import SITES_CONSTANTS, recording, sites, sites_trial

SOME = ("pelvis", "thigh")
NOISE = 0.8  # N
PRESSED = 0.006  # m
PARAMETERS = tuple(p for p in sites().parameters if p.name.rpartition("_")[2] in SOME)


def sites_case(effect: str = "", values: Mapping[str, float] | None = None) -> GapCase:
    """Two sites, three calibration trials and two held out; stiffness and lever differ a little between trials."""
    rng = np.random.default_rng(11)
    names = tuple(f"t{i}" for i in range(5))
    still = [_pressed(sites_trial(name, 2.0 + 0.4 * i, 0.03, 3.0)) for i, name in enumerate(names)]
    empty = GapCase("case", "sit_to_stand", tuple(still[:3]), tuple(still[3:]), PARAMETERS, SITES_CONSTANTS)
    system = system_of(empty)
    model = next(one for one in candidates(system) if one.label == effect).apply(system) if effect else system
    done = tuple(_measured(model, trial, values or {}, rng) for trial in still)
    noise = {f"{site}_force": NOISE for site in SOME}
    return GapCase("case", "sit_to_stand", done[:3], done[3:], PARAMETERS, SITES_CONSTANTS, noise)


def _pressed(trial: Trial) -> Trial:
    """Strapped on tightly, so that the base hardly ever pulls."""
    tight = {name: trial.column(name) + PRESSED * name.endswith("normal") for name in trial.signals.channels}
    return recording(trial.name, trial.time, tight)


def _measured(model: System, trial: Trial, values: Mapping[str, float], rng: np.random.Generator) -> Trial:
    own = {p.name: p.start * (1.0 + 0.02 * rng.standard_normal()) for p in PARAMETERS}
    force = model.simulate(trial, {**own, **values})
    columns = {name: trial.column(name) for name in model.inputs}
    for name, clean in zip(model.outputs, force.T, strict=True):
        columns[name] = clean + NOISE * rng.standard_normal(len(trial))
    return recording(trial.name, trial.time, columns)


def found(effect: str = "", values: Mapping[str, float] | None = None) -> tuple[Diagnosis, list[str]]:
    """The diagnosis, and at which sites the effects are that it names."""
    case = sites_case(effect, values)
    findings = diagnose(case, system_of(case))
    return findings.diagnosis, [one.variant for one in findings.attribution.answer.chosen.candidates]


@pytest.mark.slow
def test_nothing_is_found_where_nothing_is_missing(elsewhere: Elsewhere) -> None:
    assert elsewhere(found)[0].verdict == "no_gap"


@pytest.mark.slow
def test_a_pad_that_opens_is_found_at_its_site(elsewhere: Elsewhere) -> None:
    opened = {"contact_loss.thigh.opening": 25.0, "contact_loss.thigh.rounding": 0.0}
    said, at = elsewhere(found, "contact_loss.thigh", opened)
    assert said.effects == ("contact_loss",)
    assert at == ["thigh"]
    assert said.parameters["contact_loss.thigh.opening"].value == pytest.approx(25.0, abs=4.0)
    assert said.where[0].channel == "thigh_force"
    assert said.gap["thigh_force"].reduction > 0.5


@pytest.mark.slow
@pytest.mark.long  # with every change: the two above
def test_what_all_sites_lack_is_found_at_all(elsewhere: Elsewhere) -> None:
    said, at = elsewhere(found, "damping", {"damping.b": 400.0, "damping.exponent": 1.0})
    assert said.effects == ("damping",)
    assert at == [""]
    assert said.parameters["damping.b"].value == pytest.approx(400.0, rel=0.15)
