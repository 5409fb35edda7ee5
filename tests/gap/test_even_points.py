"""Where searches for the base model set out: Sobol's points, without what takes long to import."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from scipy.stats import qmc

from geocontact.gap.case.plain_fit import even_points
from geocontact.gap.levels import FEW


@pytest.mark.parametrize("dimensions", range(1, 25))
def test_the_points_are_those_of_an_independent_library(dimensions: int) -> None:
    np.testing.assert_array_equal(even_points(dimensions), qmc.Sobol(dimensions, seed=0).random(FEW))


def test_nothing_is_imported_for_them() -> None:
    asked = "from geocontact.gap.case.plain_fit import even_points; even_points(6); import sys; "
    said = subprocess.run(
        [sys.executable, "-c", asked + "print('scipy.stats' in sys.modules)"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert said.stdout.strip() == "False"


def test_without_parameters_there_are_no_points() -> None:
    assert even_points(0).size == 0
