"""Thresholds, noise and delay of a device's file act in the simulation, and what the controller gets wrong is said."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.shoulder.devices import device_named
from geocontact.analyses.shoulder.simulate.result import ShoulderSimulateResult
from geocontact.data.errors import InputError
from geocontact.shoulder_exoskeleton.support.controller_numbers import CONTROLLED, controller_numbers
from tests.analyses.shoulder.test_devices import HEAD, ROWS, profile
from tests.analyses.shoulder.test_simulate import TRIAL, simulated


def device(folder: Path, *lines: str) -> str:
    file = folder / "own.toml"
    file.write_text("[controller]\n" + "\n".join(lines) + "\n", encoding="utf-8")
    return str(file)


def led(folder: Path, *lines: str, **options: object) -> ShoulderSimulateResult:
    """The right arm under a profile, with these numbers of the controller."""
    own = {} if not lines else {"device": device(folder, *lines)}
    return simulated(profile=profile(folder, f"{HEAD}\n{ROWS}"), side="right", **own, **options)


def begins(found: ShoulderSimulateResult, phase: str) -> float:
    """First time at which the controller is in a phase [s]."""
    table = found.table("right")
    return float(table["time [s]"][table["detected phase"] == phase].iloc[0])


def tool_starts() -> float:
    tool = pd.read_csv(TRIAL / "tool.csv", comment="#")
    return float(tool["time [s]"][tool["current [A]"] > 2.5].iloc[0])


def test_a_delay_makes_the_controller_see_the_tool_so_much_later(tmp_path: Path) -> None:
    """The screw-in follows the current alone, so that its beginning is late by just the delay, to a frame of 0.01 s."""
    at_once = begins(led(tmp_path), "screw-in")
    late = led(tmp_path, 'delay = { value = 0.3, unit = "s", source = "derived" }')
    assert at_once == pytest.approx(tool_starts(), abs=0.02)
    assert begins(late, "screw-in") == pytest.approx(at_once + 0.3, abs=0.011)
    numbers = late.table("numbers").set_index("number")
    assert numbers.loc["controller delay", ["value", "unit", "source"]].tolist() == [0.3, "s", "derived"]
    assert numbers.loc["controller up", "source"] == "invented" and len(numbers) == 63 + len(CONTROLLED)


def test_a_threshold_of_rate_moves_the_lift(tmp_path: Path) -> None:
    slow, fast = (led(tmp_path, f'up = {{ value = {v}, unit = "deg/s" }}') for v in (3, 40))
    assert begins(fast, "lift") > begins(slow, "lift") + 0.03


def test_wrong_phases_and_chatter_are_said(tmp_path: Path) -> None:
    exact = led(tmp_path)
    line = next(each for each in exact.sentences if "another phase than the motion" in each)
    table = exact.table("right")
    assert f"{np.mean(table['detected phase'] != table['phase by onset']):.1%} of the time" in line
    assert not any("chatters" in each for each in exact.warnings)
    noisy = led(tmp_path, 'angle_noise = { value = 4, unit = "deg" }', seed=3)
    changes = int(
        (noisy.table("right")["detected phase"].shift().bfill() != noisy.table("right")["detected phase"]).sum()
    )
    assert any(f"the controller chatters: phases change {changes} times" in each for each in noisy.warnings)


def test_without_numbers_the_controller_is_as_it_was() -> None:
    own = controller_numbers(device_named("lucy"))
    assert set(own) == set(CONTROLLED) and own["delay"].value == 0.0 and own["low"].value == 0.40


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ('delay = { value = 30, unit = "s" }', "30 s cannot be delay of elevation and current; that is 0 to 2 s"),
        ('low = { value = 80, unit = "deg" }', "threshold low must be below high"),
        ('wobble = { value = 1, unit = "s" }', "wobble"),
    ],
)
def test_numbers_that_cannot_be_are_refused(tmp_path: Path, line: str, what: str) -> None:
    with pytest.raises(InputError) as error:
        device_named(device(tmp_path, line))
    assert what in str(error.value)
