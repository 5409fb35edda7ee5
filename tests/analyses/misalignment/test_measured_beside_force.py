"""A measured moment of the cuff sets the scale that no force can; the arm's measured angle sets the shape."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import geocontact as gc
from tests.analyses.misalignment.measured_arm import TRUE, record
from tests.analyses.misalignment.trials import quietly

pytestmark = pytest.mark.slow


def fit(files: tuple[Path, ...], **options: Any) -> Any:
    return quietly(gc.misalignment.identify, *files, bootstrap=0, **options)


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """With moment and angle, nothing known."""
    return fit(record(tmp_path_factory.mktemp("both")))


def test_the_moment_sets_the_scale(both: Any) -> None:
    assert not both.summary["scale_free"] and both.fit_outcome == "fits"
    for name, true in TRUE.items():
        one = both.summary["intervals"][name]
        low, high = one["profile_likelihood"]
        per = 1.0 if name == "k" else 1e3
        assert low < true * per < high, name
        assert high - low < 0.1 * abs(true) * per, name
    assert not any("one factor" in line for line in both.warnings)
    assert any("measured moment" in line for line in both.sentences)
