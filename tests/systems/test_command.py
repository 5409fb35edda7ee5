"""A simulator that is not ours as a base model: its outputs, its effects, what it is told, how it fails."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from jaxtyping import Float

from geocontact.chain.system import FAR
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.simulator import SimulatorError
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.gap.diagnose import diagnose
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere

UNITS = {"angle": "rad", "torque": "N m"}
TIME = np.arange(0.0, 6.0, 0.02)
LATE = 0.06


@dataclass
class Spring:
    """torque = k (1 + h level) u (1 + 0.3 u²), u = angle - neutral, in place of a program."""

    inputs: tuple[str, ...] = ("angle",)
    outputs: tuple[str, ...] = ("torque",)
    units: Mapping[str, str] = field(default_factory=lambda: UNITS)
    told: list[set[str]] = field(default_factory=list)

    def run(
        self, time: Float[np.ndarray, " t"], inputs: Float[np.ndarray, "i t"], numbers: Mapping[str, float]
    ) -> Float[np.ndarray, "t c"]:
        self.told.append(set(numbers))
        if numbers["k"] > 150.0:
            raise SimulatorError("spring.py ended with code 1: too stiff")
        u = inputs[0] - numbers["neutral"]
        return (numbers["k"] * (1.0 + numbers["h"] * numbers["level"]) * u * (1.0 + 0.3 * u**2))[:, None]


def case(start: float = 50.0, late: float = LATE) -> GapCase:
    rng = np.random.default_rng(3)
    trials = []
    for k, name in enumerate(("t01", "t02", "t03", "t04")):
        angle = 0.3 * np.sin(2.0 * np.pi * (0.4 + 0.15 * k) * TIME + k)
        told = {"k": 60.0, "neutral": 0.05, "h": 0.1, "level": float(k % 2)}
        torque = np.interp(TIME - late, TIME, Spring().run(TIME, angle[None], told)[:, 0])
        values = np.column_stack([angle, torque + 0.2 * rng.standard_normal(len(TIME))])
        trials.append(Trial(name, Signals(TIME, values, ("angle", "torque"), ("rad", "N m")), {"level": float(k % 2)}))
    parameters = (
        Parameter("k", "N m/rad", start, 10.0, 200.0),
        Parameter("neutral", "rad", 0.0, -0.3, 0.3),
    )
    calibration, evaluation = tuple(trials[:2]), tuple(trials[2:])
    return GapCase("own", "command", calibration, evaluation, parameters, {"h": 0.1}, {"torque": 0.2},
                   simulator=Spring())  # fmt: skip


def test_it_is_told_parameters_constants_and_covariates_only() -> None:
    own = case()
    system = system_of(own)
    late = next(one for one in candidates(system) if one.name == "time_shift")
    late.apply(system).simulate(own.calibration[1], {**system.start, "time_shift.delay": 0.1})
    assert isinstance(own.simulator, Spring) and own.simulator.told[-1] == {"k", "neutral", "h", "level"}


def test_outputs_are_the_simulators() -> None:
    own = case()
    trial = own.calibration[1]
    expected = Spring().run(TIME, trial.column("angle")[None], {"k": 60.0, "neutral": 0.02, "h": 0.1, "level": 1.0})
    found = system_of(own).simulate(trial, {"k": 60.0, "neutral": 0.02})
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_effects_are_those_outside_of_it() -> None:
    names = {one.name for one in candidates(system_of(case()))}
    assert names == {
        "time_shift", "clock_slip", "filter_lag", "motion_offset", "play", "gravity_load",
        "sensor_gain", "sensor_offset",
        "sensor_drift", "saturation", "unit_error", "sign_flip",
    }  # fmt: skip


def test_a_search_may_try_what_it_fails_at() -> None:
    own = case()
    assert (system_of(own).simulate(own.calibration[0], {"k": 151.0, "neutral": 0.0}) == FAR).all()


def test_where_it_fails_at_the_start_its_words_are_told() -> None:
    with pytest.raises(InputError, match=r"fails on trial t01: NotConverged: spring\.py ended with code 1: too stiff"):
        system_of(case(start=160.0))


def test_a_case_without_a_simulator_is_refused() -> None:
    with pytest.raises(InputError, match="has no simulator"):
        system_of(replace(case(), simulator=None))


def verdict() -> tuple[str, tuple[str, ...]]:
    own = case()
    found = diagnose(own, system_of(own)).diagnosis
    return found.verdict, found.ambiguity


def test_a_delay_of_its_outputs_is_found(elsewhere: Elsewhere) -> None:
    said, possible = elsewhere(verdict)
    assert said == "explained" and possible[0] == "time_shift" and set(possible) <= {"time_shift", "filter_lag"}
