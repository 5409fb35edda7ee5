"""Models refitted under weights, and what a search must survive."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.effects.catalogue import candidates
from geocontact.gap.case import refit as refit_module
from geocontact.gap.case.noise_sources import rough_noise
from geocontact.gap.case.plain_fit import Plain, base_starts
from geocontact.gap.case.refit import Measured, derivatives, free, magnitude, moved_at_once, refit
from geocontact.identify.optimise.bounded_gauss_newton import STEP
from geocontact.systems.catalogue import system_of
from tests.gap.cases import NOISE, TRUE, elbow_case, lost
from tests.systems.examples import example


def measured() -> tuple:
    case = elbow_case(seed=3)
    system = system_of(case)
    data = Measured.of(system, case.calibration, rough_noise(system, case))
    return system, data, [Plain(there, np.array([NOISE])) for there in data.present]


def test_base_parameters_are_found_from_any_start() -> None:
    system, data, whiten = measured()
    best = refit(system, data, whiten, base_starts(system), 40)
    for name, value in TRUE.items():
        assert best.values[name] == pytest.approx(value, rel=0.1)
    for p in free(system):
        assert p.lower <= best.values[p.name] <= p.upper


def test_a_known_fit_is_not_simulated_again_where_a_search_sets_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """Under another weight it ends where it would without; trials after those that are fitted do not count."""
    system, data, whiten = measured()
    first = refit(system, data, whiten, [TRUE])
    longer = replace(first, residuals=[*first.residuals, np.full((4, 1), np.nan)])
    louder = [Plain(there, np.array([3.0 * NOISE])) for there in data.present]
    alone = refit(system, data, louder, [first.values])
    seen: list[dict[str, float]] = []
    simulated = Measured.residuals

    def residuals(own: Measured, model: System, values: dict[str, float]) -> list[np.ndarray]:
        seen.append(dict(values))
        return simulated(own, model, values)

    monkeypatch.setattr(Measured, "residuals", residuals)
    again = refit(system, data, louder, [first.values], known=[longer])
    assert first.values not in seen
    assert again.cost == pytest.approx(alone.cost, rel=1e-9)
    assert len(again.residuals) == len(data.trials)
    elsewhere = refit(system, data, louder, [{**first.values, "k": 1.1 * first.values["k"]}], known=[longer])
    assert len(seen) > 1
    assert elsewhere.values == pytest.approx(alone.values, rel=1e-3)


def test_derivatives_are_central_differences() -> None:
    system, data, _ = measured()
    exact = derivatives(system, data, TRUE)
    for k, p in enumerate(free(system)):
        step = 1e-4 * abs(TRUE[p.name])
        up, down = ({**TRUE, p.name: TRUE[p.name] + s * step} for s in (1.0, -1.0))
        for own, a, b in zip(exact, data.residuals(system, up), data.residuals(system, down), strict=True):
            np.testing.assert_allclose(own[..., k], (b - a) / (2.0 * step), rtol=1e-2, atol=1e-3 / step * 1e-3)


@pytest.fixture
def only_differences(monkeypatch: pytest.MonkeyPatch) -> None:
    """As of a model whose geometry knows no derivatives."""
    monkeypatch.setattr(refit_module, "tangents", lambda *_: {})


@pytest.mark.usefixtures("only_differences")
def test_a_motion_that_leaves_its_way_tells_nothing_of_a_parameter() -> None:
    system, data, _ = measured()
    base = data.residuals(system, TRUE)
    exact = derivatives(system, data, TRUE, base)
    lost_way = [base[0] + 1e13, *base[1:]]
    found = derivatives(system, data, TRUE, lost_way)
    assert (found[0] == 0.0).all()
    np.testing.assert_array_equal(found[1], exact[1])


def test_samples_that_were_not_measured_count_for_nothing() -> None:
    case = elbow_case(seed=3, change=lost)
    system = system_of(case)
    data = Measured.of(system, case.calibration, np.array([NOISE]))
    missing = ~data.present[0][:, 0]
    assert missing.any()
    assert (data.residuals(system, TRUE)[0][missing] == 0.0).all()


SITES, SITES_TRIALS = example("sit_to_stand")


@pytest.mark.usefixtures("only_differences")
@pytest.mark.parametrize("one", [one for one in candidates(SITES) if one.parameters], ids=lambda one: one.label)
def test_moving_parameters_at_once_gives_what_each_alone_gives(one: Candidate) -> None:
    system = one.apply(SITES)
    measured, values = Measured.of(system, SITES_TRIALS, np.ones(3)), system.start
    found, base = derivatives(system, measured, values), measured.residuals(system, values)
    for k, p in enumerate(free(system)):
        step = STEP * magnitude(p)
        step = -step if values[p.name] + step > p.upper else step
        moved = measured.residuals(system, {**values, p.name: values[p.name] + step})
        for slopes, before, after in zip(found, base, moved, strict=True):
            np.testing.assert_array_equal(slopes[..., k], (before - after) / step, err_msg=p.name)
    groups = moved_at_once(system, free(system))
    assert sorted(k for group in groups for k in group) == list(range(len(free(system))))
    assert len(groups) == len(free(system)) if one.name == "crosstalk" else len(groups) <= 4
