"""The tree's own merge sort, beside numpy's stable one."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.geometry.kernels import binary


@pytest.mark.parametrize("count", [1, 2, 3, 7, 64, 101])
def test_slots_are_sorted_and_equal_ones_stay(count: int) -> None:
    rng = np.random.default_rng(count)
    centre = np.round(rng.normal(size=(count + 9, 3)), 1)  # many are equal
    order = rng.permutation(count + 9)
    first, last = 4, 4 + count
    wanted = order.copy()
    wanted[first:last] = order[first:last][np.argsort(centre[order[first:last], 1], kind="stable")]
    plain = getattr(binary._sort, "py_func", binary._sort)
    plain(centre, 1, order, first, last)
    assert order.tolist() == wanted.tolist()
