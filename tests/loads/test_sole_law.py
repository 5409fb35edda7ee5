"""The force law of a sole from numbers for all spheres, for zones and for single spheres."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.errors import InputError
from geocontact.loads.sole_law import changed_law, law_of_sole

ZONE = ("heel", "toe", "heel")
ALL = {"k": 5e4, "n": 1.5, "b": 100.0, "delta_full": 1e-3, "mu_s": 0.8, "mu_k": 0.6, "v_th": 0.1}


def test_numbers_for_all_spheres() -> None:
    law, assumed = law_of_sole(ZONE, ALL)
    np.testing.assert_array_equal(law.stiffness, [5e4] * 3)
    np.testing.assert_array_equal(law.damping, [100.0] * 3)
    np.testing.assert_array_equal([law.static, law.kinetic], [[0.8] * 3, [0.6] * 3])
    assert (law.exponent, law.full_depth, law.threshold_speed) == (1.5, 1e-3, 0.1)
    assert assumed == {}


def test_a_zone_goes_before_all_and_a_column_stands_for_itself() -> None:
    given = {key: value for key, value in ALL.items() if key != "b"}
    law, assumed = law_of_sole(ZONE, given, {"toe": {"k": 9e4, "mu_s": 0.5}}, {"b": np.array([1.0, 2.0, 3.0])})
    np.testing.assert_array_equal(law.stiffness, [5e4, 9e4, 5e4])
    np.testing.assert_array_equal(law.damping, [1.0, 2.0, 3.0])
    np.testing.assert_array_equal(law.static, [0.8, 0.5, 0.8])
    np.testing.assert_array_equal(law.kinetic, [0.6, 0.6, 0.6])
    assert assumed == {}


def test_what_nobody_gave_is_assumed() -> None:
    law, assumed = law_of_sole(ZONE, {})
    assert assumed == {"k": 8e4, "n": 1.2, "b": 200.0, "delta_full": 2e-3, "mu_s": 0.9, "mu_k": 0.7, "v_th": 0.25}
    assert assumed["k"] * 3e-3 ** assumed["n"] == pytest.approx(75.0, abs=0.2), "N at a depth of 3 mm"
    np.testing.assert_array_equal(law.stiffness, [8e4] * 3)
    law, assumed = law_of_sole(ZONE, {"n": 1.0}, {"heel": {"k": 1e4}, "toe": {"k": 2e4, "b": 5.0}})
    assert set(assumed) == {"b", "delta_full", "mu_s", "mu_k", "v_th"}, "every zone has its own k"
    np.testing.assert_array_equal(law.damping, [200.0, 5.0, 200.0])


def test_what_has_no_effect_is_not_assumed() -> None:
    assert set(law_of_sole(ZONE, {"b": 0.0})[1]) == {"k", "n", "mu_s", "mu_k", "v_th"}
    assert set(law_of_sole(ZONE, {"mu_s": 0.0, "mu_k": 0.0})[1]) == {"k", "n", "b", "delta_full"}
    assert set(law_of_sole(ZONE, {"mu_s": 0.0, "mu_k": 0.1})[1]) == {"k", "n", "b", "delta_full", "v_th"}


def test_mistakes() -> None:
    with pytest.raises(InputError, match=r"zone\.arch: no sphere is in that zone; zones are: heel, toe"):
        law_of_sole(ZONE, {}, {"arch": {"k": 1.0}})
    column = {"k": np.full(3, 1e4)}
    for given, zones in (({"k": 1e4}, {}), ({}, {"toe": {"k": 1e4}})):
        with pytest.raises(ValueError, match="k has no effect together with the column k"):
            law_of_sole(ZONE, given, zones, column)
    with pytest.raises(ValueError, match="n is not a number of the law, or none that single spheres can have"):
        law_of_sole(ZONE, {}, {"toe": {"n": 1.0}})
    with pytest.raises(ValueError, match="mu is not a number"):
        law_of_sole(ZONE, {"mu": 1.0})
    with pytest.raises(ValueError, match="must be positive"):
        law_of_sole(ZONE, {"n": 0.0})


def test_a_changed_law_keeps_the_rest() -> None:
    """A zone goes before all spheres, and what is not named stays, sphere by sphere."""
    law, _ = law_of_sole(ZONE, {key: value for key, value in ALL.items() if key != "b"}, columns={"b": np.arange(3.0)})
    new = changed_law(law, ZONE, {"k": 7e4, "n": 1.1}, {"toe": {"k": 9e4, "mu_k": 0.2}})
    np.testing.assert_array_equal(new.stiffness, [7e4, 9e4, 7e4])
    np.testing.assert_array_equal(new.damping, law.damping)
    np.testing.assert_array_equal([new.static, new.kinetic], [[0.8] * 3, [0.6, 0.2, 0.6]])
    assert (new.exponent, new.full_depth, new.threshold_speed) == (1.1, 1e-3, 0.1)
    with pytest.raises(InputError, match=r"zone.arch: no sphere is in that zone; zones are: heel, toe"):
        changed_law(law, ZONE, {}, {"arch": {"k": 1.0}})
    with pytest.raises(ValueError, match="v_th is not a number"):
        changed_law(law, ZONE, {}, {"toe": {"v_th": 1.0}})
    with pytest.raises(ValueError, match="must be positive"):
        changed_law(law, ZONE, {"k": -1.0})
