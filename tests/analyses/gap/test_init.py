"""A case is begun from a simulator and recordings: what is found by a call, what is asked, and that it then runs."""

from __future__ import annotations

import importlib.util
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.gap.init.fmu import read_fmu
from tests.analyses.gap.strut_fmu import built, described
from tests.cli.calls import call, done

K, NEUTRAL, DAMPING = 120.0, 0.05, 4.0
PLAIN = """import numpy as np

def run(time, inputs, numbers, law):
    turned = inputs[0] - numbers["neutral"]
    return numbers["k"] * np.sin(turned) * np.cos(turned) + law(turned, law.rate)
"""
PROGRAM = """import csv, json, sys
params, trial, out = sys.argv[1:4]
numbers = json.load(open(params))
header, *rows = csv.reader(open(trial))
with open(out, "w") as file:
    file.write("time [s],torque [N m]\\n")
    for time, angle in rows:
        file.write(f"{time},{numbers['k'] * float(angle)!r}\\n")
"""


def recordings(folder: Path, count: int = 4, samples: int = 200) -> Path:
    """Synthetic trials of a strut with a damper of `DAMPING` [N m s/rad] that no simulator here has, in degrees."""
    folder.mkdir()
    time, noise = 0.02 * np.arange(samples), np.random.default_rng(3)
    for k in range(1, count + 1):
        angle = 0.3 * np.sin((2 + 0.4 * k) * time) + 0.1 * np.sin((5 + k) * time)
        turned = angle - NEUTRAL
        torque = K * np.sin(turned) * np.cos(turned) + DAMPING * np.gradient(angle, time)
        columns = {"time [s]": time, "angle [deg]": np.degrees(angle), "torque [N m]": torque}
        columns["torque [N m]"] = torque + noise.normal(0.0, 0.2, samples)
        pd.DataFrame(columns).to_csv(folder / f"t{k}.csv", index=False)
    return folder


def file_of(folder: Path, name: str, text: str) -> str:
    """A file with that text; its path as it is typed."""
    path = folder / name
    path.write_text(text)
    return str(path)


@pytest.fixture
def apart(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder to start in; what was imported from it is forgotten."""
    monkeypatch.chdir(tmp_path)
    before, path = set(sys.modules), list(sys.path)
    yield tmp_path
    sys.path[:] = path
    for name in set(sys.modules) - before:
        if str(tmp_path) in str(getattr(sys.modules[name], "__file__", "")):
            del sys.modules[name]


def test_what_it_asks_for_is_found_and_asked(apart: Path) -> None:
    result = gc.init_gap_case(simulator=file_of(apart, "strut.py", PLAIN), data=recordings(apart / "data"))
    assert [p.name for p in result.system.parameters] == ["neutral", "k"] and result.run.unknown == ("neutral", "k")
    assert any("start, lower, upper and unit of neutral, k" in each for each in result.questions)
    folder = result.write(apart / "case")
    with pytest.raises(gc.InputError, match=r"parameters.neutral.start: is '\?'"):
        gc.read_gap_case(folder)
    assert [one.name for one in result.case.evaluation] == ["t3", "t4"]
    assert "no curve is compared" in result.page(apart / "page.html").read_text()


@pytest.mark.slow
def test_a_completed_case_is_diagnosed_with_the_adapter(apart: Path) -> None:
    declared = f"\nimport geocontact as gc\nPARAMETERS = ({PARAMETERS})\n"
    simulator = file_of(apart, "strut.py", PLAIN + declared)
    done(call("gap", "init", "--simulator", simulator, "--data", recordings(apart / "data"), "--out", "case"))
    shutil.copy(apart / "case" / "strut_adapter.py", apart)
    said = gc.diagnose(apart / "case", bare=True).diagnosis
    assert said.effects == ("damping",)
    assert said.parameters["damping.b"].value == pytest.approx(DAMPING, rel=0.05)


PARAMETERS = 'gc.Parameter("k", "N m/rad", 100.0, 10.0, 400.0), gc.Parameter("neutral", "rad", 0.0, -0.3, 0.3),'


def test_errors_are_those_of_the_curves(apart: Path) -> None:
    """Root mean squares by hand, from what was written."""
    declared = f"\nimport geocontact as gc\nPARAMETERS = ({PARAMETERS})\n"
    data = recordings(apart / "data")
    result = gc.init_gap_case(simulator=file_of(apart, "strut.py", PLAIN + declared), data=data)
    assert not result.run.unknown
    for trial in ("t1", "t4"):
        own = pd.read_csv(data / f"{trial}.csv")
        angle = np.radians(own["angle [deg]"])
        off = own["torque [N m]"] - 100.0 * np.sin(angle) * np.cos(angle)
        assert result.errors[trial]["torque"] == pytest.approx(float(np.sqrt(np.mean(off**2))), rel=1e-9)
    table = result.table("first_run")
    rows = table[table["trial"] == "t1"]
    assert len(rows) == 200 and (rows["torque simulated [N m]"] - rows["torque measured [N m]"]).abs().max() < 60.0
    page = result.page(apart / "page.html").read_text()
    assert "misses the trials by up to" in page and "torque, t1" in page


def test_degrees_in_place_of_radians_are_asked_about(apart: Path) -> None:
    text = 'def run(time, inputs, numbers):\n    return numbers["k"] * inputs[0] * 57.29578\n'
    data = recordings(apart / "data")
    result = gc.init_gap_case(simulator=file_of(apart, "wrong.py", text), data=data, number={"k": 120.0})
    assert any("times (180/π) as large as measured" in each for each in result.questions)
    result = gc.init_gap_case(
        simulator=file_of(apart, "right.py", text.replace("57.29578", "1.0")), data=data, number={"k": 120.0}
    )
    assert not any("as large as measured" in each for each in result.questions)


@pytest.mark.parametrize(
    ("body", "dynamic"),
    [
        ('numbers["k"] * inputs[0]', False),
        ('numbers["k"] * inputs[0] ** 3', False),
        ('numbers["k"] * np.cumsum(inputs[0]) * 0.02', True),
        ('numbers["k"] * np.gradient(inputs[0], time)', True),
    ],
)
def test_memory_shows_in_a_call(apart: Path, body: str, dynamic: bool) -> None:
    text = f"import numpy as np\ndef run(time, inputs, numbers):\n    return {body}\n"
    result = gc.init_gap_case(simulator=file_of(apart, "own.py", text), data=recordings(apart / "data"))
    assert result.run.spreads is dynamic
    assert f"dynamic={dynamic}" in result.found.adapter[1]


def test_a_base_model_that_hides_its_memory_is_warned_of(apart: Path) -> None:
    text = """import numpy as np
import geocontact as gc

def run(time, inputs, numbers):
    return numbers["k"] * np.gradient(inputs[0], time)

DAMPER = gc.simulator_base("damper", {"angle": "rad"}, {"torque": "N m"}, run)
"""
    with pytest.warns(gc.InputWarning, match="dynamic=True"):
        result = gc.init_gap_case(simulator=file_of(apart, "damper.py", text), data=recordings(apart / "data"))
    assert result.found.system == "damper:DAMPER" and not result.found.adapter[0]


def test_an_input_that_does_nothing_is_named(apart: Path) -> None:
    text = 'def run(time, inputs, numbers):\n    return 0.0 * inputs[0] + numbers["k"]\n'
    result = gc.init_gap_case(simulator=file_of(apart, "flat.py", text), data=recordings(apart / "data"))
    assert any(each.startswith("angle changed no output") for each in result.questions)


def test_a_contact_that_is_open_for_half_a_trial_shows_its_memory(apart: Path) -> None:
    """A spring with a lag that is hit at one place of the trial only, not at its middle."""
    text = """import numpy as np

def run(time, inputs, numbers):
    held = np.where(np.arange(len(time)) < len(time) // 5, np.maximum(inputs[0] + 1.0, 0.0), 0.0)
    return numbers["k"] * np.convolve(held, [0.0, 0.5, 0.5])[: len(time)]
"""
    result = gc.init_gap_case(simulator=file_of(apart, "open.py", text), data=recordings(apart / "data"))
    assert result.run.spreads and not any("changed no output" in each for each in result.questions)


def test_a_program_is_called_for_each_trial(apart: Path) -> None:
    file_of(apart, "program.py", PROGRAM)
    command = f"{sys.executable} program.py {{params}} {{trial}} {{out}}"
    data = recordings(apart / "data", samples=40)
    result = gc.init_gap_case(simulator=command, data=data, number={"k": 120.0})
    angle = np.radians(pd.read_csv(data / "t2.csv")["angle [deg]"])
    np.testing.assert_allclose(result.run.simulated["t2"][:, 0], 120.0 * angle, rtol=1e-9)
    text = (result.write(apart / "case") / "case.toml").read_text()
    assert 'system = "command"' in text and 'inputs = ["angle"]' in text and 'outputs = ["torque"]' in text
    with pytest.raises(gc.InputError, match="KeyError: 'k'"):
        gc.init_gap_case(simulator=command, data=data)


REFUSED = {
    "nowhere.py": ("", "there is no file"),
    "empty.py": ("x = 1\n", "neither a base model nor a function run"),
    "broken.py": ("import nothing_of_this_name\n", "cannot be imported: ModuleNotFoundError"),
    "short.py": ("def run(time, inputs):\n    return inputs[0]\n", "takes 2 arguments"),
    "shape.py": ("def run(time, inputs, numbers):\n    return inputs[0][:-1]\n", r"gave an array \(199,\)"),
    "fails.py": ("def run(time, inputs, numbers):\n    return inputs[7]\n", "fails on trial t1: .*IndexError"),
    "exits.py": ("def run(time, inputs, numbers):\n    raise SystemExit(3)\n", "fails on trial t1: .*SystemExit: 3"),
    "ends.py": (
        (
            "import geocontact as gc\ndef build(*_):\n    raise SystemExit(3)\n"
            'BASE = gc.Base("ends", ("angle",), ("torque",), build)\n'
        ),
        "cannot be built: SystemExit: 3",
    ),
    "notes.txt": ("hello\n", "neither a .py nor an .fmu file"),
    "zip.fmu": ("hello\n", "is no FMU"),
    "odd.py": ("PARAMETERS = [1]\ndef run(time, inputs, numbers):\n    return inputs[0]\n", "no tuple of gc.Parameter"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_used_is_one_line(apart: Path, name: str) -> None:
    text, said = REFUSED[name]
    simulator = file_of(apart, name, text) if text else str(apart / name)
    with pytest.raises(gc.InputError, match=said) as caught:
        gc.init_gap_case(simulator=simulator, data=recordings(apart / "data"))
    assert "\n" not in str(caught.value)


def test_columns_are_named_or_asked_about(apart: Path) -> None:
    simulator = file_of(apart, "own.py", 'def run(time, inputs, numbers):\n    return numbers["k"] * inputs[0]\n')
    data = recordings(apart / "data")
    assert any("are torque the outputs" in each for each in gc.init_gap_case(simulator=simulator, data=data).questions)
    named = gc.init_gap_case(simulator=simulator, data=data, outputs="torque")
    assert not any("the outputs" in each for each in named.questions)
    with pytest.raises(gc.InputError, match="no column 'force'"):
        gc.init_gap_case(simulator=simulator, data=data, outputs="force")
    with pytest.raises(gc.InputError, match="among the outputs too"):
        gc.init_gap_case(simulator=simulator, data=data, inputs="torque")
    with pytest.raises(gc.InputError, match="takes no law"):
        gc.init_gap_case(simulator=simulator, data=data, acts_on="angle")


def test_too_few_trials_are_refused_and_few_asked_about(apart: Path) -> None:
    simulator = file_of(apart, "own.py", 'def run(time, inputs, numbers):\n    return numbers["k"] * inputs[0]\n')
    for count in (1, 2):
        with pytest.raises(gc.InputError, match=rf"holds {count} \.csv files"):
            gc.init_gap_case(simulator=simulator, data=recordings(apart / f"few{count}", count))
    result = gc.init_gap_case(simulator=simulator, data=recordings(apart / "three", 3))
    assert any(each.startswith("3 trials; can you record 4") for each in result.questions)
    result = gc.init_gap_case(simulator=simulator, data=recordings(apart / "seven", 7))
    assert [one.name for one in result.case.evaluation] == ["t3", "t6"]


def test_an_fmu_says_its_channels_and_numbers(apart: Path) -> None:
    variables = {one.name: one for one in read_fmu(described(apart / "strut.fmu"))}
    assert [variables[name].causality for name in ("angle", "torque", "k")] == ["input", "output", "parameter"]
    assert variables["k"].parameter == gc.Parameter("k", "N m/rad", 60.0, 10.0, 400.0)
    assert variables["tau"].parameter.fixed
    with pytest.raises(gc.InputError, match="angle is in deg, trials are given to simulators in SI, in rad"):
        gc.init_gap_case(simulator=str(described(apart / "deg.fmu", "deg")), data=recordings(apart / "data"))


@pytest.mark.skipif(importlib.util.find_spec("fmpy") is not None, reason="FMPy is installed")
def test_without_fmpy_the_remedy_is_said(apart: Path) -> None:
    with pytest.raises(gc.InputError, match="pip install fmpy"):
        gc.init_gap_case(simulator=str(described(apart / "strut.fmu")), data=recordings(apart / "data"))


@pytest.mark.oracle
def test_an_fmu_gives_what_its_equations_do(apart: Path) -> None:
    """The strut's branch solved exactly for an angle that is linear between samples, without an FMU."""
    pytest.importorskip("fmpy")
    if (compiler := shutil.which("gcc") or shutil.which("cc")) is None:
        pytest.skip("there is no C compiler")
    data = recordings(apart / "data")
    result = gc.init_gap_case(simulator=str(built(apart / "strut.fmu", compiler)), data=data)
    own = pd.read_csv(data / "t3.csv")
    time, angle, tau = own["time [s]"].to_numpy(), np.radians(own["angle [deg]"].to_numpy()), 0.5
    x = np.zeros(len(time))
    x[0] = angle[0]
    for i in range(1, len(time)):
        h = time[i] - time[i - 1]
        slope, fade = (angle[i] - angle[i - 1]) / h, np.exp(-h / tau)
        x[i] = angle[i] - slope * tau + (x[i - 1] - angle[i - 1] + slope * tau) * fade
    exact = 60.0 * angle + 20.0 * (angle - x)
    found = result.run.simulated["t3"][:, 0]
    assert np.abs(found - exact).max() < 0.005 * np.ptp(exact)
    assert result.system.dynamic and [p.name for p in result.system.parameters if not p.fixed] == ["k", "neutral"]
    late = np.abs(np.roll(exact, 1) - exact)[1:].max()
    assert np.abs(found - exact).max() < 0.1 * late  # a lag of one sample would show
