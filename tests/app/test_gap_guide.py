"""The guided gap case in a browser: numbers of its runs are those of the commands typed by hand."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from nicegui import Client
from nicegui.element import Element
from nicegui.elements.mixins.text_element import TextElement
from nicegui.events import GenericEventArguments, handle_event
from nicegui.page import page

from geocontact.analyses.frame.rerun import differing, results_of
from geocontact.analyses.gap.init.options import QUESTIONS
from geocontact.app.gap_columns import CHANNELS, ColumnTable
from geocontact.app.gap_files import answer_questions, columns_of, write_trials
from geocontact.app.gap_questions import QuestionTable
from geocontact.systems.elbow import ELBOW
from geocontact.systems.knee import KNEE
from tests.app.conftest import Window
from tests.app.test_window import run_words, until

if TYPE_CHECKING:
    from playwright.sync_api import Page

STRUT = """def run(time, inputs, numbers):
    return numbers["k"] * (inputs[0] - numbers["neutral"])
"""


def strut_trials(folder: Path, count: int = 4) -> list[Path]:
    """Angles [deg] and torques [N m] of a spring of 60 N m/rad and a damper of 4 N m s/rad; synthetic."""
    folder.mkdir(parents=True)
    time, noise = 0.02 * np.arange(100), np.random.default_rng(3)
    files = []
    for k in range(1, count + 1):
        angle = 0.3 * np.sin((2 + 0.4 * k) * time) + 0.1 * np.sin((5 + k) * time)
        torque = 60.0 * (angle - 0.05) + 4.0 * np.gradient(angle, time) + noise.normal(0.0, 0.2, len(time))
        files.append(folder / f"t{k}.csv")
        rows = np.column_stack([time, np.degrees(angle), torque, 0.0 * time])
        np.savetxt(files[-1], rows, delimiter=",", header="time [s],knee [deg],load,idle", comments="", fmt="%.9g")
    return files


def test_channels_of_the_models_are_theirs() -> None:
    assert {name: (each["input"], each["output"]) for name, each in CHANNELS.items()} == {
        base.name: (base.inputs, base.outputs) for base in (ELBOW, KNEE)
    }


def test_columns_are_read_and_written_in_a_process(tmp_path: Path) -> None:
    files = strut_trials(tmp_path / "raw", 2)
    assert columns_of(files) == ([("knee", "deg"), ("load", ""), ("idle", "")], [])
    (tmp_path / "raw" / "t3.csv").write_text("time [s],knee [deg]\n0,1\n1,2\n")
    assert columns_of([*files, tmp_path / "raw" / "t3.csv"])[1] == ["t3.csv: lacks idle, load, which t1.csv has"]
    rows = [{"column": "load", "channel": "torque", "unit": "N m"}]
    assert write_trials(files, rows, tmp_path / "out") == []
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == ["t1.csv", "t2.csv"]
    assert (tmp_path / "out" / "t1.csv").read_text("utf-8").startswith("time [s],torque [N m]\n")
    assert "has no unit" in write_trials(files, [{**rows[0], "unit": ""}], tmp_path / "out")[0]
    (tmp_path / "other").mkdir()
    again = tmp_path / "other" / "t1.csv"
    again.write_bytes(files[0].read_bytes())
    assert "two files have one name" in write_trials([*files, again], rows, tmp_path / "out")[0]
    assert (
        "there is no such folder" in columns_of([tmp_path / "gone.csv"])[1][0] or columns_of([tmp_path / "gone.csv"])[1]
    )
    assert answer_questions(tmp_path, {"evaluation": [], "numbers": {}, "noise": {}})  # no case there


def labelled(client: Client) -> dict[str, Element]:
    """Fields of a page without a browser, by their labels."""
    return {str(label): one for one in client.elements.values() if (label := one.props.get("aria-label"))}


def change(client: Client, label: str, value: object) -> None:
    """Fill a field in, as a browser sends it."""
    one = labelled(client)[label]
    for listener in one._event_listeners.values():
        if listener.type == "change" and listener.handler is not None:
            handle_event(listener.handler, GenericEventArguments(sender=one, client=client, args=value))


def test_a_unit_is_offered_where_the_file_states_none_that_is_known(tmp_path: Path) -> None:
    """A column in "degrees" is written in the unit that is chosen; one that is chosen for "" is not taken for "deg"."""
    client = Client(page(""), request=None)
    with client.content:
        table = ColumnTable([("knee", "deg"), ("speed", ""), ("hip", "degrees")], "")
    assert list(labelled(client)) == ["knee is", "speed is", "unit of speed", "hip is", "unit of hip"]
    for label, value in {"knee is": "input", "hip is": "input", "speed is": "output", "unit of hip": "deg"}.items():
        change(client, label, value)
    assert "deg/s" in labelled(client)["unit of speed"].props["innerHTML"]
    change(client, "unit of speed", "deg/s")
    assert table.rows() == [
        {"column": "knee", "channel": "knee", "unit": "deg", "stated": "deg"},
        {"column": "speed", "channel": "speed", "unit": "deg/s", "stated": ""},
        {"column": "hip", "channel": "hip", "unit": "deg", "stated": "degrees"},
    ]
    files = [tmp_path / f"t{k}.csv" for k in (1, 2)]
    for file, hip in zip(files, (" [degrees]", ""), strict=True):
        file.write_text(f"time [s],knee [deg],speed,hip{hip}\n0,1,2,3\n1,1,2,3\n")
    (tmp_path / "out").mkdir()
    assert write_trials(files[:1], table.rows(), tmp_path / "out") == []
    head = (tmp_path / "out" / "t1.csv").read_text("utf-8").partition("\n")[0]
    assert head == "time [s],knee [deg],speed [deg/s],hip [deg]"
    assert "t2.csv: column hip has no unit" in write_trials(files, table.rows(), tmp_path / "out")[0]


def test_questions_that_no_field_answers_are_shown() -> None:
    number = {"start": 50.0, "lower": "?", "upper": "?", "unit": ""}
    settings = {"calibration": ["t1"], "evaluation": ["t2"], "parameters": {"k": number}, "noise": {"M": 0.1}}
    client = Client(page(""), request=None)
    with client.content:
        table = QuestionTable({**settings, QUESTIONS: ["are M the outputs?"]}, ["M"])
    words = [one.text for one in client.elements.values() if isinstance(one, TextElement)]
    assert words[words.index("Open, and kept in case.toml as comments:") + 1] == "are M the outputs?"
    change(client, "lower of k", "10")
    change(client, "upper of k", "200")
    change(client, "unit of k", "N m/rad")
    assert table.answers() == {
        "evaluation": ["t2"],
        "numbers": {"k": {"start": 50.0, "lower": 10.0, "upper": 200.0, "unit": "N m/rad"}},
        "noise": {"M": 0.1},
    }
    none = Client(page(""), request=None)
    with none.content:
        QuestionTable({**settings, QUESTIONS: []}, ["M"])
    assert not any("kept in" in one.text for one in none.elements.values() if isinstance(one, TextElement))


def finished(tab: Page, count: int) -> str:
    """State of the last of `count` runs once it has ended."""
    states = "[...document.querySelectorAll('.run strong')].map(each => each.textContent)"
    until(tab, f"({states}).length === {count} && /: (done|refused|failed)/.test(({states}).at(-1))", 900.0)
    return str(tab.evaluate(f"({states}).at(-1)"))


def begin(tab: Page, files: list[Path], columns: dict[str, str], units: dict[str, str], numbers: str) -> str:
    """Trials are dropped, columns are chosen, and the model is called on them."""
    tab.locator('.field:has([name="trials"]) .pick input').set_input_files(files)
    until(tab, f"document.querySelector('[name=trials]').value.split('\\n').length === {len(files)}", 30.0)
    tab.get_by_role("button", name="look at their columns").click()
    for column, role in columns.items():
        tab.get_by_label(f"{column} is", exact=True).select_option(role)
    for column, unit in units.items():
        tab.get_by_label(f"unit of {column}", exact=True).select_option(unit)
    tab.locator('[name="numbers"]').fill(numbers)
    tab.wait_for_timeout(500)
    tab.get_by_role("button", name="simulate the trials").click()
    return finished(tab, 1)


@pytest.mark.slow
def test_a_simulator_of_ones_own_from_columns_to_the_diagnosis(window: Window, tmp_path: Path) -> None:
    """First run, case and diagnosis have the numbers of `gap init` and `gap diagnose` typed by hand."""
    files, simulator = strut_trials(tmp_path / "raw"), tmp_path / "strut_model.py"
    simulator.write_text(STRUT)
    tab = window.tab("gap-case")
    tab.locator('.field:has([name="simulator"]) .pick input').set_input_files(simulator)
    until(tab, "document.querySelector('[name=simulator]').value.endsWith('strut_model.py')", 30.0)
    tab.wait_for_timeout(500)
    state = begin(tab, files, {"knee": "input", "load": "output"}, {"load": "N m"}, "k=50\nneutral=0.05")
    assert ": done" in state, tab.locator(".side").inner_text()
    frame = tab.frame_locator(".pages iframe")
    assert "Measured beside simulated" in frame.locator("body").inner_text(timeout=60_000)
    case = window.folder / state.partition(":")[0]
    (tmp_path / "data").mkdir()
    for file in files:  # the same trials by hand
        rows = file.read_text("utf-8").splitlines()[1:]
        lines = ["time [s],knee [deg],load [N m]", *(row.rpartition(",")[0] for row in rows)]
        (tmp_path / "data" / file.name).write_text("\n".join(lines) + "\n")
    words = ["gap", "init", f"--simulator={simulator}", "--data=data", "--inputs=knee", "--outputs=load"]
    run_words([*words, "--number=k=50", "--number=neutral=0.05", "--out=begun"], tmp_path)
    assert (case / "first_run.csv").read_text("utf-8") == (tmp_path / "begun" / "first_run.csv").read_text("utf-8")
    tab.get_by_role("button", name="diagnose").click()
    until(tab, "document.querySelector('.why[role=status]')?.textContent.includes('is missing')", 30.0)
    for name, ends in {"k": ("50", "10", "200", "N m/rad"), "neutral": ("0.05", "-0.3", "0.3", "rad")}.items():
        for end, value in zip(("start", "lower", "upper", "unit"), ends, strict=True):
            tab.get_by_label(f"{end} of {name}", exact=True).fill(value)
    tab.get_by_label("noise of load, SI unit; estimated where empty").fill("0.2")
    for name, held in (("t1", True), ("t2", False), ("t3", False), ("t4", True)):
        tab.get_by_label(f"hold out {name}", exact=True).set_checked(held)
    tab.wait_for_timeout(500)
    tab.get_by_role("button", name="diagnose").click()
    assert ": done" in finished(tab, 2), tab.locator(".side").inner_text()
    found = tomllib.loads((case / "case.toml").read_text("utf-8"))
    assert (found["calibration"], found["evaluation"]) == (["t2", "t3"], ["t1", "t4"])
    text = (
        'format = 1\nsystem = "strut_model_adapter:SIMULATOR"\ncalibration = ["t2", "t3"]\nevaluation = ["t1", "t4"]\n'
        '[noise]\nload = 0.2\n[parameters.k]\nstart = 50\nlower = 10\nupper = 200\nunit = "N m/rad"\n'
        '[parameters.neutral]\nstart = 0.05\nlower = -0.3\nupper = 0.3\nunit = "rad"\n'
    )
    by_hand = tmp_path / case.name
    (tmp_path / "begun").rename(by_hand)
    (by_hand / "case.toml").write_text(text)
    (by_hand / "strut_model_adapter.py").rename(tmp_path / "strut_model_adapter.py")
    run_words(["gap", "diagnose", by_hand.name, "--out=answer"], tmp_path)
    diagnosed = case.with_name(f"{case.name}-diagnosis-1")
    before, after = results_of(tmp_path / "answer"), results_of(diagnosed)
    assert len(before) > 3 and before.keys() == after.keys()
    different = differing(before, after, tmp_path / "answer", diagnosed)
    assert different in ([], ["report.html"])  # which has the hash of case.toml, whose numbers are spelled otherwise
    assert json.loads((diagnosed / "diagnosis.json").read_text("utf-8"))
    tab.close()


@pytest.mark.slow
def test_a_model_of_the_package_on_its_own_simulated_recordings(window: Window, tmp_path: Path) -> None:
    """Recordings of `elbow simulate`: channels are chosen by name, the error is that of the true numbers."""
    run_words(["elbow", "simulate", "--seconds=4", "--rate=50", "--case", "--out=made"], tmp_path)
    made = tmp_path / "made" / "case"
    truth = tomllib.loads((made / "case.toml").read_text("utf-8"))
    numbers = truth["constants"] | {name: each["start"] for name, each in truth["parameters"].items()}
    files = []
    for file in sorted((made / "trials").glob("*.csv")):
        head, *rows = file.read_text("utf-8").splitlines()
        assert head == "time [s],beta [deg],force [N]"
        files.append(tmp_path / file.name)
        files[-1].write_text("\n".join(["time [s],angle,cuff", *rows]) + "\n")
    tab = window.tab("gap-case")
    tab.locator('[name="model"]').select_option("elbow")
    state = begin(
        tab,
        files,
        {"angle": "beta", "cuff": "force"},
        {"angle": "deg", "cuff": "N"},
        "\n".join(f"{name}={value!r}" for name, value in numbers.items()),
    )
    assert ": done" in state, tab.locator(".side").inner_text()
    case = window.folder / state.partition(":")[0]
    words = ["gap", "init", "--simulator=elbow", f"--data={made / 'trials'}", "--out=begun"]
    run_words([*words, *(f"--number={name}={value!r}" for name, value in numbers.items())], tmp_path)
    assert (case / "first_run.csv").read_text("utf-8") == (tmp_path / "begun" / "first_run.csv").read_text("utf-8")
    assert tab.get_by_label("start of k", exact=True).input_value() == str(float(numbers["k"]))
    tab.get_by_label("k is known exactly", exact=True).wait_for()
    tab.set_viewport_size({"width": 390, "height": 844})
    assert tab.evaluate("document.documentElement.scrollWidth") <= 390
    nameless = "[...document.querySelectorAll('input, select, textarea')].filter(e => !e.labels.length && !e.ariaLabel)"
    assert tab.evaluate(f"{nameless}.map(e => e.outerHTML)") == []
    tab.close()
