"""Device files with every documented number, and support profiles that a simulation is driven by."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.shoulder.devices import device_named
from geocontact.analyses.shoulder.recordings import current_at
from geocontact.analyses.shoulder.simulate.result import ShoulderSimulateResult
from geocontact.data.errors import InputError
from geocontact.shoulder_exoskeleton.device import QUANTITIES, cylinder_length, lever, lucy
from geocontact.shoulder_exoskeleton.support.phase_machine import LIFT, LOWER, SCREW, detected
from geocontact.shoulder_exoskeleton.work_phases import PHASES
from tests.analyses.shoulder.test_simulate import TRIAL, simulated

PAGE = Path(__file__).resolve().parents[3] / "docs" / "reference" / "input_files.md"


def documented() -> dict[str, str]:
    """Unit by number."""
    text = PAGE.read_text(encoding="utf-8")
    section = text[text.index("| numbers | unit | what |") : text.index("**Controller**")]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in section.splitlines() if "`" in line]
    return {name: unit for names, unit, _ in rows for name in re.findall(r"`(\w+)`", names)}


def test_a_file_with_every_documented_number_is_the_device_itself(tmp_path: Path) -> None:
    units, device = documented(), lucy()
    assert set(units) == set(QUANTITIES)
    lines = [
        f'{name} = {{ value = {number.value * QUANTITIES[name].written[1]!r}, unit = "{units[name]}" }}'
        for name, number in device.numbers.items()
    ]
    file = tmp_path / "same.toml"
    file.write_text("[numbers]\n" + "\n".join(lines) + "\n", encoding="utf-8")
    read = device_named(str(file))
    for name, number in device.numbers.items():
        assert read[name] == pytest.approx(number.value, rel=1e-12, abs=1e-15), name


HEAD = "profile,task,hand,lift,screw-in,lower"
ROWS = "mine,T1,dominant,0.6,1.0,0.3\nmine,T1,other,0.5,0.7,0.2\n"


def profile(folder: Path, text: str) -> Path:
    file = folder / "factors.csv"
    file.write_text(text, encoding="utf-8")
    return file


def even(folder: Path, factor: float) -> Path:
    """The same factor always, at rest too."""
    row = f"mine,T1,dominant,{factor},{factor},{factor},{factor}\n"
    return profile(folder, f"{HEAD},rest\n{row}{row.replace('dominant', 'other')}")


def states(found: ShoulderSimulateResult) -> np.ndarray:
    s = found.arms[0].simulation
    return np.column_stack([s.angles, s.rates, s.cylinder, s.outputs["in_cuff"]])


@pytest.mark.parametrize(("factor", "level"), [(1.0, 1.0), (0.0, 0.0), (0.5, 0.5)])
def test_one_factor_for_all_phases_is_a_level(tmp_path: Path, factor: float, level: float) -> None:
    led = simulated(profile=even(tmp_path, factor), side="right")
    np.testing.assert_allclose(states(led), states(simulated(level=level, side="right")), rtol=0.0, atol=1e-12)


def test_one_arm_needs_the_factors_of_its_own_hand_only(tmp_path: Path) -> None:
    own = profile(tmp_path, f"{HEAD}\nmine,T1,dominant,0.6,1.0,0.3\n")
    assert simulated(profile=own, side="right", time=(0.0, 4.0)).arms[0].factor is not None
    with pytest.raises(InputError, match="no factors of the other hand for T1"):
        simulated(profile=own)


def test_the_cylinder_follows_the_phases_of_the_device_s_own_arm(tmp_path: Path) -> None:
    """p' = (factor - p) / lag, exactly, with the phases that the result's own elevation gives."""
    found = simulated(profile=profile(tmp_path, f"{HEAD}\n{ROWS}"), dominant="left", level=0.8)
    for arm, factors in zip(found.arms, ((0.0, 0.5, 0.7, 0.2), (0.0, 0.6, 1.0, 0.3)), strict=True):
        s = arm.simulation
        time = s.motion.time
        seen = detected(time, s.elevation, current_at(TRIAL / "tool.csv", time))
        assert set(seen) >= {LIFT, SCREW, LOWER}
        table = found.table(arm.side)
        np.testing.assert_array_equal(table["detected phase"], np.array(PHASES)[seen])
        np.testing.assert_array_equal(table["factor [-]"], np.array(factors)[seen])
        decay, target = np.exp(-np.diff(time) / s.device["lag"]), 0.8 * s.device.peak_force * np.array(factors)[seen]
        following = target[:-1] + (s.cylinder[:-1] - target[:-1]) * decay
        np.testing.assert_allclose(s.cylinder[1:], following, atol=1e-3)
    assert any("support by phase: rest 0.00, lift 0.50, screw-in 0.70, lower 0.20" in line for line in found.sentences)
    out = found.write(tmp_path / "out")
    assert "detected phase, left" in (out / "report.html").read_text(encoding="utf-8")
    assert not (out / "plane").exists()


@pytest.mark.parametrize(
    ("text", "options", "what"),
    [
        (f"{HEAD}\n{ROWS}mine,T2,dominant,1,1,1\n", {}, "`task`: factors of 2 tasks; say which: T1, T2"),
        (f"{HEAD}\n{ROWS}", {"task": "T3"}, "no factors of 'T3'; there are T1"),
        (f"{HEAD}\n{ROWS}", {"profile_name": "his"}, "no profile 'his'; there are mine"),
        (f"{HEAD}\n{ROWS.replace('0.6', '1.6')}", {}, "row 1: factor '1.6' of lift is not 0 to 1"),
        (f"{HEAD}\n{ROWS.replace('other', 'left')}", {}, "row 2: hand 'left' is not known; write dominant or other"),
        (f"{HEAD}\n{ROWS}{ROWS}", {}, "row 3: mine, T1, dominant is there twice"),
        (f"{HEAD}\n{ROWS.splitlines()[0]}\n", {}, "no factors of the other hand for T1"),
        (f"{HEAD.replace('lower', 'down')}\n{ROWS}", {}, "no column lower"),
    ],
)
def test_a_profile_that_cannot_be_read_is_refused(
    tmp_path: Path, text: str, options: dict[str, str], what: str
) -> None:
    with pytest.raises(InputError) as error:
        simulated(profile=profile(tmp_path, text), **options)
    assert what in str(error.value) and "\n" not in str(error.value)


def test_a_profile_needs_the_tool(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="`tool`: is missing with `profile`"):
        gc.shoulder.simulate(TRIAL / "markers.trc", profile=profile(tmp_path, f"{HEAD}\n{ROWS}"))
    with pytest.raises(InputError, match="`task`"):
        simulated(task="T1")


def hinged(folder: Path, **places: float) -> Path:
    """A device with a cylinder of 32 mm between hinges [mm]."""
    lines = "".join(
        f'{name} = {{ value = {value}, unit = "mm", source = "paper" }}\n' for name, value in places.items()
    )
    file = folder / "hinged.toml"
    file.write_text(f'based_on = "lucy_new_cylinder"\n[hinges]\n{lines}', encoding="utf-8")
    return file


def test_hinges_give_the_lever_of_the_two_points(tmp_path: Path) -> None:
    """Torque over force by hand: the moment arm of the line through both hinges, the rod's turned with the arm."""
    rod, frame = np.array([-24.0, 8.0]), np.array([-30.0, -140.0])
    device = device_named(str(hinged(tmp_path, rod_y=rod[0], rod_z=rod[1], frame_y=frame[0], frame_z=frame[1])))
    for elevation in np.radians([-10.0, 20.0, 60.0, 110.0]):
        cos, sin = np.cos(elevation), np.sin(elevation)
        turned = np.array([[cos, sin], [-sin, cos]]) @ rod  # down (0, -1) goes to the front (-1, 0)
        away = turned - frame
        length = np.hypot(*away)
        push = away / length
        raising = turned[1] * push[0] - turned[0] * push[1]  # about -x
        own = (device["lever_a"], device["lever_b"], device["lever_phase"])
        assert 1e3 * lever(elevation, *own) == pytest.approx(raising, abs=1e-9)
        assert 1e3 * cylinder_length(elevation, *own) == pytest.approx(length, abs=1e-9)
    assert device.numbers["lever_a"].source == "paper"
    assert device["elevation_upper"] == lucy()["elevation_upper"]


def test_a_stroke_that_ends_stops_the_arm(tmp_path: Path) -> None:
    """The hinges are the stroke's end apart where the range ends now, and no elevation beyond has a cylinder."""
    places = {"rod_y": 0.0, "rod_z": -26.5, "frame_y": 0.0, "frame_z": -150.0}
    with pytest.warns(gc.InputWarning, match=r"the cylinder ends within the arm's range, which is -15 to 108 deg"):
        device = device_named(str(hinged(tmp_path, **places, extended=160.0)))
    own = (device["lever_a"], device["lever_b"], device["lever_phase"])
    assert 1e3 * cylinder_length(device["elevation_upper"], *own) == pytest.approx(160.0, abs=0.05)
    assert device["lever_phase"] == pytest.approx(0.0, abs=1e-12)
    assert device.numbers["elevation_upper"].note == "where the stroke of the cylinder ends"


@pytest.mark.parametrize(
    ("places", "extra", "words"),
    [
        ({"rod_y": 1.0}, "", "rod_z, frame_y, frame_z are missing"),
        ({"rod_y": 0.0, "rod_z": 0.2, "frame_y": 0.0, "frame_z": -150.0}, "", "lies on the active axis"),
        (
            {"rod_y": 0.0, "rod_z": -20.0, "frame_y": 0.0, "frame_z": -150.0, "extended": 100.0},
            "",
            "fits at no elevation",
        ),
        (
            {"rod_y": 0.0, "rod_z": -20.0, "frame_y": 0.0, "frame_z": -150.0},
            '[numbers]\nlever_a = { value = 20, unit = "mm" }\n',
            "lever_a: follows from [hinges] as well",
        ),
    ],
)
def test_hinges_that_cannot_be_are_refused(tmp_path: Path, places: dict[str, float], extra: str, words: str) -> None:
    file = hinged(tmp_path, **places)
    file.write_text(file.read_text(encoding="utf-8") + extra, encoding="utf-8")
    with pytest.raises(InputError, match=re.escape(words)):
        device_named(str(file))
