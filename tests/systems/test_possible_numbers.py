"""Every number of every base model at -1, 0, NaN and infinity: refused by its name, or one that means something."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.systems import elastic_joint, sit_to_stand
from geocontact.systems import elbow as elbow_exoskeleton
from geocontact.systems import foot as prosthetic_foot
from geocontact.systems import knee as knee_implant
from geocontact.systems import shoulder as shoulder_exoskeleton
from tests.systems.examples import elbow, foot, joint, knee, shoulder, sites, spheres, support

TRIED = (-1.0, 0.0, math.nan, math.inf)
ANY, NOTHING = (-1.0, 0.0), (0.0,)
"""A place or lever on either side; what may be absent: damping, friction, a mass, springs of a zone."""
MODELS: dict[str, tuple[Callable[[], System], Callable[..., System], dict[str, pd.DataFrame]]] = {
    "elbow": (elbow, elbow_exoskeleton.build, {}),
    "foot": (foot, prosthetic_foot.build, {"spheres": spheres()}),
    "shoulder": (shoulder, shoulder_exoskeleton.build, {"support": support()}),
    "knee": (knee, knee_implant.build, {}),
    "sit_to_stand": (sites, sit_to_stand.build, {}),
    "joint": (joint, elastic_joint.build, {}),
}
MEANS: dict[str, dict[str, tuple[float, ...]]] = {
    "elbow": dict.fromkeys(("x", "y", "z"), ANY),
    "foot": dict.fromkeys(("mu_s", "mu_k", *(f"{kind}_z{k}" for kind in "kb" for k in (1, 2, 3))), NOTHING),
    "shoulder": {**dict.fromkeys(("o_x", "o_y", "l_c"), ANY), **dict.fromkeys(("m", "c", "b_t"), NOTHING)},
    "knee": {},
    "sit_to_stand": {"b": NOTHING, **dict.fromkeys(("rho_pelvis", "rho_thigh", "rho_shank"), ANY)},
    "joint": dict.fromkeys(("growth", "angle0", "hardening"), ANY),
}


def at(system: System, name: str, value: float) -> Callable[[Callable[..., System], dict[str, pd.DataFrame]], System]:
    """The model built with one number at a value, without bounds that would refuse it."""

    def built(build: Callable[..., System], tables: dict[str, pd.DataFrame]) -> System:
        parameters = [
            Parameter(p.name, p.unit, value, value, value, fixed=True) if p.name == name else p
            for p in system.parameters
        ]
        constants = {**system.constants, **({name: value} if name in system.constants else {})}
        return build(tuple(parameters), constants, tables)

    return built


def tried() -> Iterator[tuple[str, str, float]]:
    for model, (example, _, _) in MODELS.items():
        system = example()
        for name in (*(p.name for p in system.parameters), *system.constants):
            for value in TRIED:
                yield model, name, value


@pytest.mark.parametrize(("model", "name", "value"), [*tried()])
def test_a_number_that_cannot_be_is_refused_by_its_name(model: str, name: str, value: float) -> None:
    example, build, tables = MODELS[model]
    built = at(example(), name, value)
    if value in MEANS[model].get(name, ()):
        assert built(build, tables).name
        return
    with pytest.raises(ValueError, match=rf"\b{name}\b"):
        built(build, tables)


@pytest.mark.parametrize("value", TRIED)
def test_a_sphere_without_a_positive_radius_is_refused_by_its_row(value: float) -> None:
    table = spheres()
    table.loc[3, "radius [m]"] = value
    example, build, _ = MODELS["foot"]
    system = example()
    with pytest.raises(ValueError, match=r"row 4 of the table spheres has .*correct it"):
        build(system.parameters, system.constants, {"spheres": table})


@pytest.mark.parametrize("column", ["px [m]", "py [m]"])
def test_a_sphere_may_be_on_either_side_but_somewhere(column: str) -> None:
    example, build, _ = MODELS["foot"]
    system = example()
    for value in TRIED:
        table = spheres()
        table.loc[0, column] = value
        if np.isfinite(value):
            assert build(system.parameters, system.constants, {"spheres": table}).extent > 0.0
        else:
            with pytest.raises(ValueError, match="row 1 of the table spheres has a number that is not finite"):
                build(system.parameters, system.constants, {"spheres": table})


def test_a_fitted_number_may_be_sought_from_zero_on() -> None:
    """Bounds are where a search may go; only where it starts is to be possible."""
    system = elbow()
    parameters = tuple(replace(p, lower=0.0) if p.name == "k" else p for p in system.parameters)
    assert elbow_exoskeleton.build(parameters, system.constants, {}).parameters[0].lower == 0.0
