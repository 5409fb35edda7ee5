"""A simulator in Python that says that it is dynamic."""

from __future__ import annotations

import pytest

from geocontact.systems.simulator import simulator_base


@pytest.mark.parametrize("dynamic", [False, True])
def test_a_simulator_says_whether_it_is_dynamic(dynamic: bool) -> None:
    base = simulator_base("strut", {"angle": "rad"}, {"torque": "N m"}, lambda _, u, __: 2.0 * u[0], dynamic=dynamic)
    assert base.build((), {}, {}).dynamic is dynamic
