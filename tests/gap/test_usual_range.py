"""The range that nearly all values of a recording are in."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.gap.case.noise_sources import usual_range


def test_one_in_a_hundred_lies_beyond_either_end() -> None:
    values = np.arange(101.0)
    assert usual_range(values) == pytest.approx((1.0, 99.0))
    assert usual_range(np.append(values, [np.nan, np.nan])) == pytest.approx((1.0, 99.0))
