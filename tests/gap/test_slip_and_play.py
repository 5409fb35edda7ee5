"""A clock that slips half-way, and play, are named at their size; synthetic data of an elastic joint."""

from __future__ import annotations

from collections.abc import Callable
from unittest.mock import patch

import numpy as np
import pytest

from geocontact.analyses.gap.thinning import thinned_and_said
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.gap.diagnose import diagnose
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere

Column = np.ndarray
Torque = Callable[[Column, Column], Column]


def joint_case(torque: Torque, rate: float = 50.0, lasts: float = 3.0) -> GapCase:
    """An elastic joint whose torque has 0.1 N m of noise, which is stated; `torque` of time and angle.

    Trials last three seconds, or `lasts`, of `rate` samples a second.
    """
    rng, time, trials = np.random.default_rng(5), np.arange(round(lasts * rate)) / rate, []
    for k in range(5):
        rate = 0.8 + 0.25 * k
        angle = 0.25 * np.sin(2.0 * np.pi * rate * time + k) + 0.1 * np.sin(2.0 * np.pi * 0.37 * rate * time)
        read = torque(time, angle) + 0.1 * rng.standard_normal(len(time))
        trials.append(
            Trial(f"t{k}", Signals(time, np.column_stack([angle, read]), ("angle", "torque"), ("rad", "N m")), {})
        )
    parameters = (Parameter("k", "N m/rad", 20.0, 5.0, 80.0), Parameter("angle0", "rad", 0.0, -0.3, 0.3))
    joint = "geocontact.systems.elastic_joint:JOINT"
    return GapCase("case", joint, tuple(trials[:3]), tuple(trials[3:]), parameters, noise={"torque": 0.1})


def late(time: Column, angle: Column) -> Column:
    """The torque comes 90 ms late from half-time on, as where frames were lost."""
    return 31.0 * (np.where(time < 0.5 * time[-1], angle, np.interp(time - 0.09, time, angle)) - 0.05)


def play(_: Column, angle: Column) -> Column:
    """The spring follows the angle with a play of 0.08 rad, whatever its rate."""
    follows = [angle[0]]
    for each in angle[1:]:
        follows.append(min(max(follows[-1], each - 0.04), each + 0.04))
    return 31.0 * (np.array(follows) - 0.05)


def drift(time: Column, angle: Column) -> Column:
    """A spring, and a sensor that drifts by 3 N m over the trial."""
    return 31.0 * (angle - 0.05) + 3.0 * time / time[-1]


def spring(_: Column, angle: Column) -> Column:
    """What the base model has."""
    return 31.0 * (angle - 0.05)


def wander(time: Column, angle: Column) -> Column:
    """A spring, and 1.2 N m that every trial has alike at the same share of its time: no row of the vocabulary."""
    share = time / time[-1]
    bumps = np.exp(-0.5 * ((share - 0.3) / 0.05) ** 2) - np.exp(-0.5 * ((share - 0.7) / 0.05) ** 2)
    return 31.0 * (angle - 0.05) + 1.2 * bumps


def answered(torque: Torque) -> dict[str, object]:
    case = joint_case(torque)
    return diagnose(case, system_of(case)).diagnosis.as_dict()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("torque", "effect", "parameter", "size", "near"),
    [
        (late, "clock_slip", "clock_slip.once.delay", 0.09, 0.005),
        (play, "play", "play.angle.width", 0.08, 0.004),
    ],
)
def test_they_are_named_at_their_size(
    elsewhere: Elsewhere, torque: Torque, effect: str, parameter: str, size: float, near: float
) -> None:
    """A slip was "nothing is missing", play was damping with filter lag."""
    d = elsewhere(answered, torque)
    assert (d["verdict"], d["effects"]) == ("explained", [effect]), d["remarks"]
    assert d["parameters"][parameter]["value"] == pytest.approx(size, abs=near)
    assert d["budget"]["torque"]["effects"]["share"] > 0.95
    (first, *_) = d["detected"]
    assert first["effect"] == effect and first["share"] > 0.95 and first["channel"] == "torque"


def answered_from_means(torque: Torque, rate: float) -> tuple[dict[str, object], tuple[str, ...]]:
    """Of a quick recording, as the command has it; and what is said of its thinning."""
    case = joint_case(torque, rate)
    case, said = thinned_and_said(case, system_of(case))
    return diagnose(case, system_of(case)).diagnosis.as_dict(), said


@pytest.mark.slow
@pytest.mark.parametrize(
    ("torque", "rate", "blocks", "effect", "parameter", "size", "near"),
    [
        (late, 600.0, 2, "clock_slip", "clock_slip.once.delay", 0.09, 0.005),
        (play, 1000.0, 16, "play", "play.angle.width", 0.08, 0.004),
    ],
)
def test_they_are_named_from_a_quick_recording(
    elsewhere: Elsewhere,
    torque: Torque,
    rate: float,
    blocks: int,
    effect: str,
    parameter: str,
    size: float,
    near: float,
) -> None:
    """Blocks are as short as the jump of a slip and the corners of a play want them."""
    d, said = elsewhere(answered_from_means, torque, rate)
    assert f"over blocks of {blocks} (" in said[0]
    assert (d["verdict"], d["effects"]) == ("explained", [effect]), d["remarks"]
    assert d["parameters"][parameter]["value"] == pytest.approx(size, abs=near)


def answered_from_pieces(torque: Torque) -> tuple[dict[str, object], tuple[str, ...], list[int]]:
    """Of trials of 20,000 samples of which a seventieth is used; what is said of that, and samples of inputs."""
    case = joint_case(torque, lasts=400.0)
    with patch("geocontact.analyses.gap.thinning.ROWS", 2400):
        case, said = thinned_and_said(case, system_of(case))
    trials = (*case.calibration, *case.evaluation)
    return diagnose(case, system_of(case)).diagnosis.as_dict(), said, [len(one) for one in trials]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("torque", "effect", "parameter", "size"),
    [
        (late, "clock_slip", "clock_slip.once.delay", 0.09),
        (play, "play", "play.angle.width", 0.08),
        (drift, "sensor_drift", "sensor_drift.torque.rate", 3.0 / 399.98),
        (spring, "", "k", 31.0),
    ],
)
def test_long_trials_are_answered_like_short_ones(
    elsewhere: Elsewhere, torque: Torque, effect: str, parameter: str, size: float
) -> None:
    """What lies half-way, what remembers and what grows over the trial are seen in pieces of it."""
    d, said, samples = elsewhere(answered_from_pieces, torque)
    verdict = "explained" if effect else "no_gap"
    assert (d["verdict"], d["effects"]) == (verdict, [effect] if effect else []), d["remarks"]
    low, high = d["parameters"][parameter]["ci95"]
    assert low <= size <= high and high - low < 0.2 * size
    assert "2400 are used, in stretches of 60" in said[-2]
    lead = 2.56 if len(said) == 3 else 1.28  # of means of two samples, of samples: 64 of either
    assert f"samples of the inputs {sum(samples)} are used, those from {lead} s before each stretch on; " in said[-1]
    assert max(samples) < 2500


@pytest.mark.slow
def test_a_load_that_repeats_and_has_no_name_is_unknown(elsewhere: Elsewhere) -> None:
    d = elsewhere(answered, wander)
    assert d["verdict"] in ("unknown", "partly_explained"), d["effects"]
    assert d["budget"]["torque"]["unexplained"]["share"] > 0.5
    assert any("is neither noise nor variation" in each for each in d["remarks"]), d["remarks"]
