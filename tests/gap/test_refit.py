"""Models refitted under weights, and what a search must survive."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.gap.problem import Plain, base_starts, rough_noise
from geocontact.gap.refit import Measured, derivatives, free, refit
from geocontact.systems.catalogue import system_of
from tests.gap.cases import NOISE, TRUE, elbow_case, lost


def measured() -> tuple:
    case = elbow_case(seed=3)
    system = system_of(case)
    data = Measured.of(system, case.calibration, rough_noise(system, case))
    return system, data, [Plain(there, np.array([NOISE])) for there in data.present]


def test_base_parameters_are_found_from_any_start() -> None:
    system, data, weigh = measured()
    best = refit(system, data, weigh, base_starts(system), 40)
    for name, value in TRUE.items():
        assert best.values[name] == pytest.approx(value, rel=0.1)
    for p in free(system):
        assert p.lower <= best.values[p.name] <= p.upper


def test_derivatives_are_central_differences() -> None:
    system, data, _ = measured()
    exact = derivatives(system, data, TRUE)
    for k, p in enumerate(free(system)):
        step = 1e-4 * abs(TRUE[p.name])
        up, down = ({**TRUE, p.name: TRUE[p.name] + s * step} for s in (1.0, -1.0))
        for own, a, b in zip(exact, data.residuals(system, up), data.residuals(system, down), strict=True):
            np.testing.assert_allclose(own[..., k], (b - a) / (2.0 * step), rtol=1e-2, atol=1e-3 / step * 1e-3)


def test_samples_that_were_not_measured_count_for_nothing() -> None:
    case = elbow_case(seed=3, change=lost)
    system = system_of(case)
    data = Measured.of(system, case.calibration, np.array([NOISE]))
    missing = ~data.present[0][:, 0]
    assert missing.any()
    assert (data.residuals(system, TRUE)[0][missing] == 0.0).all()
