"""Profiles of a group by a loop whose answers are known: who gets which, and in which proportion; the plan by hand."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np
import pytest

from geocontact.shoulder_exoskeleton.device import lucy_new_cylinder
from geocontact.shoulder_exoskeleton.support.arm_trial import ArmTrial, support_case, support_of
from geocontact.shoulder_exoskeleton.support.best_profile import SupportProfile, uniform_profile
from geocontact.shoulder_exoskeleton.support.closed_loop_profile import ClosedLoop
from geocontact.shoulder_exoskeleton.support.group_profiles import (
    GROUP,
    ONE_FACTOR,
    PAPER,
    NamedProfile,
    front_points,
    made_profiles,
    of_others,
    planned_outcomes,
    with_sensors,
)
from geocontact.shoulder_exoskeleton.support.outcome import TABLE_3, Factors
from geocontact.shoulder_exoskeleton.support.profile_limits import FactorKey, Limits
from geocontact.shoulder_exoskeleton.synthetic import PARTICIPANTS, TASKS, arms_of, condition, synthetic_trial
from tests.unchecked import unchecked

KEY = FactorKey("T1", "dominant", "lift")
DEVICE = lucy_new_cylinder()


@dataclass
class KnownLoop:
    """Settles on 0.5 for one factor and on 0.8 else, divided by the number of trials."""

    asked: list[tuple[int, Mapping[str, float] | None]] = field(default_factory=list)

    def settled(self, trials: Sequence[ArmTrial], make: object = None, scales: Mapping[str, float] | None = None):  # type: ignore[no-untyped-def]
        self.asked.append((len(trials), scales))
        value = (0.5 if make is uniform_profile else 0.8) / len(trials)
        runs = {each.name: SimpleNamespace(outcome=(each.name, value)) for each in trials}
        return SimpleNamespace(profile=SupportProfile({KEY: value}, value), runs=runs)

    def run(self, trial: ArmTrial, factors: Factors) -> SimpleNamespace:
        return SimpleNamespace(outcome=(trial.name, factors[KEY]))


@pytest.fixture
def stand_ins() -> Iterator[None]:
    """Types are not checked: what is known stands in for arms and their loop."""
    with unchecked():
        yield


def arm(person: str, moment: float) -> SimpleNamespace:
    return SimpleNamespace(name=f"{person} right", person=person, arm_moment=moment)


@pytest.mark.usefixtures("stand_ins")
def test_every_profile_is_made_of_its_arms() -> None:
    """Two persons of 10 and 5 N m: 0.4 for both, 0.8 alone, half of it for the lighter one and for who has no trial."""
    loop = KnownLoop()
    made = made_profiles([arm("P1", 10.0), arm("P2", 5.0)], loop, {"P9": 2.5})  # type: ignore[arg-type, list-item]
    factors = {each.name: (each.factors[KEY], each.of) for each in made.profiles}
    assert factors == {
        GROUP: (0.4, ("P1", "P2")),
        ONE_FACTOR: (0.25, ("P1", "P2")),
        PAPER: (TABLE_3[KEY], ("P1", "P2")),
        "P1 alone": (0.8, ("P1", "P2")),
        "P2 alone": (0.8, ("P1", "P2")),
        "by arm weight, P1": (0.4, ("P1",)),
        "by arm weight, P2": (0.2, ("P2",)),
        "by arm weight, P9": (0.1, ("P9",)),
    }
    assert made.scales == {"P1": 1.0, "P2": 0.5, "P9": 0.25} and made.moments["P9"] == 2.5
    assert loop.asked[-1] == (2, {"P1": 1.0, "P2": 0.5}), "persons without a trial take no part"
    assert made.simulated["P1 alone"] == {"P1 right": ("P1 right", 0.8)} and "by arm weight, P9" not in made.simulated
    same = made_profiles([arm("P1", 10.0)], loop, by_arm=False)  # type: ignore[arg-type, list-item]
    assert [each.name for each in same.profiles] == [GROUP, ONE_FACTOR, PAPER] and not same.scales


@pytest.mark.usefixtures("stand_ins")
@pytest.mark.parametrize(("one", "by_arm", "wanted"), [(False, True, 0.2), (False, False, 0.4), (True, True, 0.125)])
def test_others_make_a_profile_for_an_arm_of_half_the_weight(one: bool, by_arm: bool, wanted: float) -> None:
    others, own = [arm("P1", 10.0), arm("P2", 8.0)], [arm("P3", 5.0)]
    make = of_others(KnownLoop(), one=one, by_arm=by_arm)  # type: ignore[arg-type]
    assert make(others, own)[KEY] == pytest.approx(wanted)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def arms() -> list[ArmTrial]:
    """Both arms of P3 in T1."""
    return arms_of(synthetic_trial(PARTICIPANTS[2], TASKS[0], condition("S0")))


def test_a_plan_is_what_its_torque_leaves_by_hand(arms: list[ArmTrial]) -> None:
    cases = [support_case(each, support_of(DEVICE)) for each in arms]
    half = {key: 0.5 for case in cases for key in case.keys}
    found = planned_outcomes([NamedProfile("half", half, ("P3",)), NamedProfile("others", half, ("P1",))], cases)
    assert list(found["half"]) == [each.name for each in arms] and not found["others"]
    case = cases[0]
    left = np.abs(case.needed - case.per_factor @ np.full(3, 0.5)).mean() / np.abs(case.needed).mean()
    assert found["half"][case.name].reduction == pytest.approx(1.0 - left)


def test_a_front_rises_with_the_force_and_falls_with_the_reserve(arms: list[ArmTrial]) -> None:
    """Share of the limit as long as nothing else limits: twice the force takes twice as much."""
    cases = [support_case(each, support_of(DEVICE)) for each in arms]
    loop = ClosedLoop(DEVICE, support_of(DEVICE), Limits())
    found = front_points(cases, loop, (2.0, 4.0, 1e3), (0.0, 0.5))
    value = {(each.force, each.reserve): each.value for each in found}
    assert value[4.0, 0.0] == pytest.approx(2.0 * value[2.0, 0.0], rel=0.02)
    assert value[1e3, 0.0] > value[1e3, 0.5] > value[4.0, 0.5] > 0.0


def test_each_person_has_its_own_factors_with_sensors(arms: list[ArmTrial]) -> None:
    one = arms[:1]
    none, some = (
        with_sensors(one, DEVICE, {"P3": {FactorKey("T1", one[0].hand, "screw-in"): x}, "P1": {}})[one[0].name]
        for x in (0.0, 0.3)
    )
    assert some.reduction > none.reduction + 0.05 and none.reduction < 0.0, "the device's weight hangs on the arm"
