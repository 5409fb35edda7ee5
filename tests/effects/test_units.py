"""Parameters have the units that they state: a recording in other units, parameters turned alike, the same model."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.systems.shoulder import ShoulderArm
from tests.effects.runs import EXAMPLES, FITTED, label, outputs, truth
from tests.systems.examples import recording

LOAD = {"N m": 1.7, "N": 1.7, "kg m^2": 1.7, "kg": 1.7, "Pa": 1.7}
ANGLE = {"rad": 0.6, "kg m^2": 1.0 / 0.6}


def factor(unit: str, of: Mapping[str, float]) -> float:
    """How much larger a number of this unit becomes, "N m s/rad" from what its parts become."""
    over, _, under = unit.partition("/")
    return power(over, of) / power(under.strip("()"), of)


def power(product: str, of: Mapping[str, float]) -> float:
    found = 1.0
    for name, size in of.items():
        if match := re.search(rf"(?<!\w){re.escape(name)}(\^\d)?(?![\w^])", product):
            found *= size ** int((match[1] or "^1")[1:])
            product = product.replace(match[0], "")
    return found


def turned(p: Parameter, of: Mapping[str, float]) -> Parameter:
    by = factor(p.unit, of)
    return replace(p, start=by * p.start, lower=by * p.lower, upper=by * p.upper)


def in_other_units(system: System, trials: tuple[Trial, ...], of: Mapping[str, float]) -> tuple[System, list[Trial]]:
    channels = (*system.inputs, *system.outputs)
    changed = [
        recording(t.name, t.time, {c: t.column(c) * factor(system.unit(c), of) for c in channels}, **t.covariates)
        for t in trials
    ]
    units = {"angle0": "rad", "hardening": "1/rad^2", "b": "N s/m", "I": "kg m^2", "c": "N m s/rad"}
    constants = {name: value * factor(units.get(name, "-"), of) for name, value in system.constants.items()}
    geometry = system.geometry
    if isinstance(geometry, ShoulderArm):
        sizes = np.array([[factor("rad", of)], [factor("N m", of)]])
        geometry = replace(geometry, table=geometry.table * sizes)
    parameters = tuple(turned(p, of) for p in system.parameters)
    other = replace(system, parameters=parameters, constants=constants, geometry=geometry)
    return other.scaled(changed), changed


def agrees(name: str, one: Candidate, of: Mapping[str, float]) -> None:
    system, trials = EXAMPLES[name]
    other, changed = in_other_units(system, trials, of)
    same = next(c for c in candidates(other) if c.label == one.label)
    values = {**system.start, **truth(one)}
    units = {p.name: p.unit for p in (*system.parameters, *one.parameters)}
    moved = {name: value * factor(units[name], of) for name, value in values.items()}
    got = outputs(same.apply(other), tuple(changed), moved)
    want = outputs(one.apply(system), trials, values) * [factor(system.unit(c), of) for c in system.outputs]
    there = np.isfinite(got) & np.isfinite(want)
    np.testing.assert_allclose(got[there], want[there], rtol=1e-6, atol=1e-6 * np.nanmax(np.abs(want)))


@pytest.mark.parametrize(("name", "one"), FITTED, ids=label)
def test_loads_in_another_unit(name: str, one: Candidate) -> None:
    agrees(name, one, LOAD)


@pytest.mark.parametrize(
    ("name", "one"), [f for f in FITTED if f[0] == "joint" and f[1].name != "gravity_load"], ids=label
)
def test_angles_in_another_unit(name: str, one: Candidate) -> None:
    """Not weights: the sine wants radians."""
    agrees(name, one, ANGLE)


def test_factors() -> None:
    assert factor("rad/(N m s)", LOAD) == pytest.approx(1 / 1.7)
    assert factor("N m s/rad", ANGLE) == pytest.approx(1 / 0.6)
    assert factor("1/rad^2", ANGLE) == pytest.approx(1 / 0.36)
    assert factor("kg m^2", LOAD) == 1.7
    assert factor("N/m^n", LOAD) == 1.7
    assert factor("m/rad", LOAD) == factor("-", LOAD) == 1.0
