"""The opponent is an honest one: it finds what regression can find, and leaves alone what is not there."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from geocontact.gap_benchmark.table import lead, markdown
from tests.gap.benchmark.test_score import LABELS, ORACLE

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = """
import json, sys
import numpy as np
from geocontact.effects.catalogue import candidates
from geocontact.gap_benchmark.answers import confounding
from geocontact.gap_benchmark.synthetic import synthetic_case
from geocontact.gap_benchmark.residual_regression import residual_regression
from geocontact.gap.case.preparation import problem_of
from geocontact.systems.catalogue import system_of

def regressed(planted, *ways):
    problem = problem_of(planted.case, system_of(planted.case))
    return [residual_regression(problem, candidates(problem.system), aware=aware) for aware in ways]

def imitated(planted):
    system = system_of(planted.case)
    return confounding(system, planted.ideal, candidates(system), planted.label.floor)

def visible(planted):
    system = system_of(planted.case).as_measured()
    rest, columns = [], []
    for one in planted.ideal:
        base = system.simulate(one.trial, one.nominal)
        steps = {name: 1e-5 * value for name, value in one.nominal.items()}
        moved = [system.simulate(one.trial, {**one.nominal, n: one.nominal[n] + h}) for n, h in steps.items()]
        columns.append(one(np.stack([(m - base) / h for m, h in zip(moved, steps.values())], axis=-1)))
        rest.append(one(one.effect.T[..., None])[:, 0])
    basis = np.linalg.qr(np.concatenate(columns))[0]
    effect = np.concatenate(rest)
    return 0.5 * float(np.sum((effect - basis @ (basis.T @ effect)) ** 2))

damped = synthetic_case("elbow", "single", 3, effect="damping", nats=3000.0)
tremor = synthetic_case("elbow", "outside", 2, effect="tremor", nats=200.0)
json.dump({
    "damped": regressed(damped, False, True),
    "reduction": damped.label.reduction["force"],
    "calm": [regressed(synthetic_case("elbow", "none", seed), True)[0]["verdict"] for seed in (1, 2)],
    "imitation": {"damped": imitated(damped), "tremor": imitated(tremor)},
    "nats": [damped.label.nats["damping"], visible(damped)],
}, sys.stdout)
"""
"""In a process of its own, where shapes are not checked: that takes ten times as long."""


@pytest.fixture(scope="module")
def found() -> dict:
    """What the opponent and the search for imitations say of a few cases."""
    alone = os.environ | dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1")
    command = [sys.executable, "-c", PROGRAM]
    child = subprocess.run(command, cwd=ROOT, env=alone, capture_output=True, encoding="utf-8")
    assert child.returncode == 0, child.stderr
    return json.loads(child.stdout)


@pytest.mark.slow
@pytest.mark.parametrize("aware", [False, True])
def test_a_strong_effect_is_found(found: dict, aware: bool) -> None:
    answer = found["damped"][aware]
    assert answer["verdict"] == "explained" and answer["effects"] == ["damping"] == answer["ambiguity"][:1]
    assert sum(answer["probabilities"].values()) == pytest.approx(1.0)
    gap = answer["gap"]["force"]
    assert gap["ci95"][0] <= gap["reduction"] <= gap["ci95"][1]
    assert gap["reduction"] == pytest.approx(found["reduction"], abs=0.15)


def test_nothing_is_said_where_nothing_is(found: dict) -> None:
    assert found["calm"] == ["no_gap", "no_gap"]


def test_the_candidate_of_its_name_imitates_an_effect_and_nobody_a_tremor(found: dict) -> None:
    left, label = found["imitation"]["damped"]
    assert label.startswith("damping") and 0.0 < left < 0.1
    assert found["imitation"]["tremor"][0] > 0.9


def test_trials_without_noise_weigh_as_the_label_does(found: dict) -> None:
    """Half the squared norm of the planted effect, base parameters projected out to first order."""
    told, counted = found["nats"]
    assert counted == pytest.approx(told, rel=0.02)


def test_the_lead_is_counted_case_by_case() -> None:
    """Thirty visible cases of one effect; the opponent misses ten of them and finds none that we miss."""
    one = [name for name, label in LABELS.items() if label["kind"] in ("single", "shift", "fault")]
    theirs = {name: {**answer, "ambiguity": []} | ({"effects": []} if name in one[:10] else {})
              for name, answer in ORACLE.items()}  # fmt: skip
    found = lead(LABELS, ORACLE, theirs)
    assert (found.only_ours, found.only_theirs, found.count) == (10, 0, 30)
    assert found.points == pytest.approx(1 / 3) and found.low < 1 / 3 < found.high
    assert found.p_value == pytest.approx(2 * 0.5**10)


def test_the_table_ticks_what_reaches_its_bar() -> None:
    given = {"diagnosis": ORACLE, "regression": ORACLE, "regression_aware": ORACLE}
    lines = markdown(LABELS, given, [("more", "≤ 1", "✓ 0")])
    assert "| false alarms | ≤ 5 % | ✓ 0/20" in "\n".join(lines)
    assert sum("✗" in line for line in lines) == 3  # nobody is ahead of an oracle, whose intervals hold 100 %
    assert len({line.count("|") for line in lines}) == 1
