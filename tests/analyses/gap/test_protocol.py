"""The sheet for the laboratory: what it says is what was proposed, and its course is the experiment's."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from geocontact.analyses.gap.discriminability.protocol import protocol_table, protocol_text
from geocontact.data.diagnosis import NextExperiment
from geocontact.gap.experiment.menu import Experiment, menu
from geocontact.systems.catalogue import system_of
from tests.gap.cases import elbow_case


def found_with(kind: str | None, verdict: str = "explained") -> tuple[Any, Any, Experiment | None]:
    """A synthetic elbow, what was found of it, and the change of that name that is proposed."""
    case = elbow_case("damping", {"damping.b": 20.0, "damping.exponent": 1.0}, seed=1)
    system = system_of(case)
    one = None if kind is None else next(each for each in menu(system, case.calibration) if each.name == kind)
    told = None if one is None else f"record 3 trials: {one.words}"
    said = None if told is None else NextExperiment(("damping", "relaxation"), told, 12.5, 0.84)
    planned = None if one is None else SimpleNamespace(said=said, experiment=one)
    attribution = SimpleNamespace(answer=SimpleNamespace(verdict=verdict), clean=SimpleNamespace(system=system))
    return case, SimpleNamespace(found=attribution, planned=planned), one


@pytest.mark.parametrize("kind", ["faster", "slower", "step and hold", "smaller"])
def test_pace_length_and_range_are_those_of_the_experiment(kind: str) -> None:
    case, found, one = found_with(kind)
    assert one is not None
    text = protocol_text(case, found)
    trial, beta = one.trial, one.trial.column("beta")
    assert f"- {one.words}".replace("- ", "Record 3 trials: ") in text
    assert f"3 trials of {trial.time[-1] - trial.time[0]:.3g} s" in text and f"({len(trial)} samples each)" in text
    assert f"beta: {beta.min():.3g} to {beta.max():.3g} rad" in text
    speed = np.abs(np.gradient(beta, trial.time)).max()
    stated = float(text.split("fastest ")[1].split(" rad/s")[0])
    assert stated == pytest.approx(speed, rel=0.1)  # differences of neighbours smooth short steps
    assert "rules out the others in 84 of 100 repetitions" in text and "12.5 nats" in text
    assert "list 2 under calibration and 1 under evaluation" in text
    table = protocol_table(found)
    assert table is not None and list(table) == ["time [s]", "beta [rad]"]
    np.testing.assert_array_equal(table["beta [rad]"], beta)


def test_a_bench_test_is_at_rest_and_no_trial_of_the_case() -> None:
    case, found, _ = found_with("unloaded zero", "no_gap")
    text = protocol_text(case, found)
    assert "At rest throughout" in text and "no trials of the model" in text and "under calibration" not in text
    assert "cannot show damping and relaxation" in text


@pytest.mark.parametrize("verdict", ["no_gap", "explained"])
def test_nothing_to_propose_is_said(verdict: str) -> None:
    case, found, _ = found_with(None, verdict)
    text = protocol_text(case, found)
    assert "The list: faster, slower" in text and "What to do" not in text
    assert protocol_table(found) is None
