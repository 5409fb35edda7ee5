"""What `gap gather` asks of the trials that it joins. All recordings here are synthetic."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.gap.case import require_shares
from geocontact.analyses.gap.gather.checks import lag_of, late, turned_round
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.trial import Trial
from tests.cli.calls import written

SETTINGS = """format = 1
system = "geocontact.systems.elastic_joint:JOINT"
calibration = ["t01", "t02"]
evaluation = ["t03"]
[parameters.k]
start = 50.0
lower = 10.0
upper = 200.0
unit = "N m/rad"
"""
TIME = 0.02 * np.arange(501)


def angle(k: int, time: np.ndarray = TIME) -> np.ndarray:
    """rad; not periodic within the recording."""
    return np.asarray(0.3 * np.sin((1.0 + 0.3 * k) * time) + 0.1 * np.sin((2.7 + 0.4 * k) * time))


def trial(k: int, times: float = 60.0, lag: float = 0.0, offset: float = 0.0) -> Trial:
    torque = times * angle(k, TIME - lag) + offset + np.random.default_rng(k).normal(0.0, 0.3, len(TIME))
    signals = Signals(TIME, np.column_stack([angle(k), torque]), ("angle", "torque"), ("rad", "N m"))
    return Trial(f"t0{k}", signals)


def settings(folder: Path, trials: list[Trial], outputs: tuple[str, ...] = ("t01", "t02", "t03")) -> Path:
    """gather.toml beside the tables of the trials."""
    text = SETTINGS
    for each, measured in zip(trials, outputs, strict=True):
        pd.DataFrame({"time [s]": TIME, "angle [rad]": each.column("angle")}).to_csv(
            folder / f"{each.name}.csv", index=False
        )
        pd.DataFrame({"time [s]": TIME, "torque [N m]": each.column("torque")}).to_csv(
            folder / f"{each.name}_torque.csv", index=False
        )
        text += f'[from.{each.name}]\ninputs = "{each.name}.csv"\noutputs = "{measured}_torque.csv"\n'
    return written(folder / "gather.toml", text)


def test_a_copy_that_is_held_out_is_refused(tmp_path: Path) -> None:
    file = settings(tmp_path, [trial(1), trial(2), trial(3)], ("t01", "t02", "t01"))
    what = f"{file} [from.t03]: torque is the same as in [from.t01], sample by sample; name the files of"
    with pytest.raises(gc.InputError, match=re.escape(what)):
        gc.gather(file)


def test_honest_trials_pass_without_a_word(tmp_path: Path, recwarn: pytest.WarningsRecorder) -> None:
    """Inputs may be the same: a machine repeats them."""
    first = trial(1)
    repeated = Trial("t02", trial(1, times=58.0).signals)
    result = gc.gather(settings(tmp_path, [first, repeated, trial(3)]))
    assert result.warnings == () and not recwarn.list


def test_a_sign_and_a_clock_are_warned_of(tmp_path: Path) -> None:
    turned, behind = trial(2, times=-60.0, offset=-25.0), trial(3, lag=1.0, offset=25.0)
    with pytest.warns(gc.InputWarning) as warned:
        gc.gather(settings(tmp_path, [trial(1, offset=25.0), turned, behind]))
    lines = [str(each.message) for each in warned]
    assert any("trial t03: torque moves 1 s later than the inputs; is it the same clock?" in line for line in lines)
    assert len(lines) == 2 and any("torque: " in line and "t02" in line and "opposite" in line for line in lines)


@pytest.mark.parametrize("lag", [-1.0, 0.6, 1.3])
def test_a_lag_is_measured(lag: float) -> None:
    """To the step of the search, 50 ms."""
    assert lag_of(trial(2, lag=lag), "torque", ["torque"]) == pytest.approx(lag, abs=0.05)


@pytest.mark.parametrize("lag", [0.0, 0.1, -0.2])
def test_lags_of_sensors_and_straps_are_none(lag: float) -> None:
    assert lag_of(trial(2, lag=lag), "torque", ["torque"]) is None


def test_noise_has_no_lag() -> None:
    noise = trial(1, times=0.0)
    assert lag_of(noise, "torque", ["torque"]) is None and late([noise], ["torque"]) == []


def test_one_of_three_is_named_whose_sign_is_turned() -> None:
    some = [trial(1), trial(2, times=-60.0), trial(3)]
    (line,) = turned_round(some, ["torque"])
    assert line.startswith("torque: in t02 its sign is opposite to that in the other trials")
    assert turned_round([trial(1), trial(2), trial(3, times=45.0)], ["torque"]) == []
    (line,) = turned_round([trial(1, times=0.01, offset=20.0), trial(2, times=0.01, offset=-20.0)], ["torque"])
    assert line.startswith("torque: its signs in t01 and t02 are opposite")


@pytest.mark.parametrize(
    ("level", "words"),
    [(50.0, "50 is no share between 0 and 1; is 0.5 (50 %) meant?"), (-0.5, "-0.5 is no share"), (5000.0, "write 0.5")],
)
def test_a_level_in_per_cent_is_asked_about(level: float, words: str) -> None:
    def case(value: float, system: str = "shoulder") -> GapCase:
        return GapCase("case", system, (Trial("t01", trial(1).signals, {"level": value}),), (), (), {}, {}, {})

    with pytest.raises(gc.InputError, match=re.escape(words)):
        require_shares(case(level), Path("case.toml"))
    require_shares(case(0.5), Path("case.toml"))
    require_shares(case(level, "own:MODEL"), Path("case.toml"))
