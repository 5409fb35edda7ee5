"""How much of what a model changes lies in the calibration trials."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from geocontact.chain.system import FAR
from geocontact.gap.selection.held_out_rules import calibration_share, changes
from geocontact.identify.optimise.least_squares import NO_VALUE

FLOOR, ROUGH = np.array([2.0, 0.5]), np.array([1.0, 0.3])
PROBLEM = cast(Any, SimpleNamespace(floor=FLOOR, calibration=SimpleNamespace(trials=[0, 1], rough=ROUGH)))


def of(*sizes: float, samples: int = 5) -> list[np.ndarray]:
    """As many trials, alike but for their size."""
    return [size * np.ones((samples, 2)) * FLOOR for size in sizes]


def unchecked(function: Any) -> Any:
    """The function without the check of its arguments, which are fakes here."""
    return getattr(function, "__wrapped__", function)


def share(*sizes: float) -> float:
    return float(unchecked(calibration_share)(PROBLEM, of(*sizes)))


def test_it_is_that_of_the_squares() -> None:
    assert share(1.0, 1.0, 1.0) == pytest.approx(2.0 / 3.0)
    assert share(1.0, 1.0, 4.0) == pytest.approx(2.0 / 18.0)


@pytest.mark.parametrize("nothing", [(0.0, 0.0, 0.0), (1e-3, 0.0, 0.0), (0.0, np.inf, 1.0)])
def test_of_samples_where_nothing_changes_or_no_number(nothing: tuple[float, ...]) -> None:
    assert share(*nothing) == pytest.approx(2.0 / 3.0)


def test_samples_without_a_value_change_nothing() -> None:
    base, one = of(0.0, 0.0, 0.0), of(1.0, 1.0, 1.0)
    one[2][:, 0] = NO_VALUE * ROUGH[0]
    one[1][:] = FAR
    fakes = (SimpleNamespace(judged=SimpleNamespace(model=SimpleNamespace(residuals=each))) for each in (base, one))
    found = unchecked(changes)(PROBLEM, *fakes)
    assert not found[2][:, 0].any() and (found[2][:, 1] == -FLOOR[1]).all() and (found[0] == -FLOOR).all()
    assert not found[1].any()
