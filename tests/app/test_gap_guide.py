"""The guided gap case in a browser: numbers of its runs are those of the commands typed by hand."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
import tomllib
from pathlib import Path
from types import SimpleNamespace
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
from geocontact.app.fields import Form
from geocontact.app.gap_columns import ColumnTable
from geocontact.app.gap_files import answer_questions, columns_of, own_modules, refused_name, write_trials
from geocontact.app.gap_guide import GapGuide, _finding, models
from geocontact.app.gap_questions import QuestionTable
from geocontact.app.runs import Queue, Run
from geocontact.systems.catalogue import SYSTEMS
from geocontact.systems.sit_to_stand import SIT_TO_STAND
from tests.analyses.gap.shipped_cases import MODELS, written
from tests.analyses.gap.strut_fmu import built
from tests.analyses.gap.test_init import recordings
from tests.app.conftest import Window
from tests.app.test_window import run_words, until
from tests.browsers import awaited

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


def test_channels_of_a_model_stand_with_their_units() -> None:
    """A column with the name of a channel is that channel; of others nothing is chosen."""
    client = Client(page(""), request=None)
    with client.content:
        table = ColumnTable([("thigh_normal", "mm"), ("thigh_force", "N"), ("other", "N")], SIT_TO_STAND)
    assert table.outputs() == {"thigh_force": "N"} and table.channels() == ["thigh_normal", "thigh_force"]
    words = labelled(client)["other is"].props["innerHTML"]
    assert "input thigh_normal [m]" in words and "output shank_force [N]" in words
    assert set(models()) == {base.name for base in SYSTEMS}


def test_the_window_starts_without_the_models() -> None:
    """Nor what compiles them; only this page needs them, to list them."""
    program = "import geocontact.app.pages, sys; print('numba' in sys.modules or 'geocontact.systems' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


def test_columns_are_read_and_written_in_a_process(tmp_path: Path) -> None:
    files = strut_trials(tmp_path / "raw", 2)
    assert columns_of(files) == ([("knee", "deg"), ("load", ""), ("idle", "")], [])
    (tmp_path / "raw" / "t3.csv").write_text("time [s],knee [deg]\n0,1\n1,2\n")
    assert columns_of([*files, tmp_path / "raw" / "t3.csv"])[1] == ["t3.csv: lacks idle, load, which t1.csv has"]
    (tmp_path / "raw" / "t3.csv").write_text("time [s],knee [rad],load [N],idle\n0,1,1,1\n1,2,1,1\n")
    assert columns_of([*files, tmp_path / "raw" / "t3.csv"])[1] == [
        "t3.csv: knee is in rad, in t1.csv it is in deg",
        "t3.csv: load is in N, in t1.csv it has no unit",
    ]
    rows = [{"column": "load", "channel": "torque", "unit": "N m"}]
    (tmp_path / "out").mkdir()
    assert write_trials(files, rows, tmp_path / "out") == []
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == ["t1.csv", "t2.csv"]
    assert (tmp_path / "out" / "t1.csv").read_text("utf-8").startswith("time [s],torque [N m]\n")
    assert "has no unit" in write_trials(files, [{**rows[0], "unit": ""}], tmp_path / "out")[0]
    (tmp_path / "other").mkdir()
    again = tmp_path / "other" / "t1.csv"
    again.write_bytes(files[0].read_bytes())
    assert "two files have one name" in write_trials([*files, again], rows, tmp_path / "out")[0]
    assert columns_of([tmp_path / "gone.csv"]) == (
        [],
        [f"{tmp_path / 'gone.csv'}: there is no such file; check the path"],
    )
    wrong = answer_questions(tmp_path, {"evaluation": [], "numbers": {}, "noise": {}})
    assert wrong.startswith(f"{tmp_path / 'case.toml'}: "), wrong


def test_a_question_may_be_longer_than_an_argument() -> None:
    """2,000 names of 100 characters; Linux takes arguments of 131,072 bytes."""
    files = [Path(f"{k:0100d}.csv") for k in range(2000)]
    assert columns_of(files)[0] == [] and columns_of(files)[1] == columns_of(files[:1])[1]


class Pressed:
    """A guide without its page, whose trials and simulator are filled in; what it queues."""

    def __init__(self, folder: Path, trials: list[Path], simulator: Path) -> None:
        self.guide = GapGuide.__new__(GapGuide)
        self.runs: list[Run] = []
        filled = {"model": "", "simulator": str(simulator), "trials": "\n".join(map(str, trials)), "numbers": ""}
        label = SimpleNamespace(text="", clear=lambda: None)
        self.rows = [{"column": "load", "channel": "load", "unit": "N m"}]
        columns = SimpleNamespace(rows=lambda: self.rows, sides=dict, outputs=lambda: {"load": "N m"})
        vars(self.guide).update(
            queue=SimpleNamespace(start=folder),
            _files=folder / "files",
            _out=folder / "case",
            _filled=filled,
            _columns=columns,
            _base=None,
            _needs=None,
            _first=None,
            _said_first=label,
            _place_questions=label,
            _queued=self._queued,
        )

    def _queued(self, form: Form, out: Path, modules: tuple[Path, ...] = ()) -> Run:
        self.runs.append(Run(form.words(out), out, "", modules))
        return self.runs[-1]

    def press(self) -> str:
        """What it says when the trials are to be simulated."""
        awaited(self.guide._simulate())
        return str(self.guide._said_first.text)


def test_each_press_has_recordings_of_its_own(tmp_path: Path) -> None:
    """The first run still waits when other columns are chosen, and another page begins with the same folder."""
    files, simulator = strut_trials(tmp_path / "files" / "recordings", 2), tmp_path / "strut_model.py"
    before = [file.read_bytes() for file in files]
    first, other = (Pressed(tmp_path, files, simulator) for _ in range(2))
    assert (first.press(), first.press(), other.press()) == ("", "", "")
    runs = [*first.runs, *other.runs]
    data = [next(word for word in run.words if word.startswith("--data=")).partition("=")[2] for run in runs]
    assert len(set(data)) == 3 and all(sorted(map(str, Path(each).glob("*.csv"))) for each in data)
    assert [run.modules for run in runs] == [(), (), ()]  # what `gap init` runs it finds by itself
    assert [file.read_bytes() for file in files] == before
    there = sorted((tmp_path / "files").iterdir())
    first.rows[0]["column"] = "gone"
    assert "no column 'gone'" in first.press() and sorted((tmp_path / "files").iterdir()) == there


def test_what_is_gone_between_two_steps_is_said_in_one_line(tmp_path: Path) -> None:
    """A simulator that was deleted, and one that ended Python before the case was written."""
    simulator, case = tmp_path / "strut_model.py", tmp_path / "case"
    guide = Pressed(tmp_path, [], simulator).guide
    said = SimpleNamespace(text="")
    vars(guide).update(_place_questions=SimpleNamespace(is_deleted=False), _simulated=simulator, _said_case=said)
    awaited(guide._ask(case))
    assert guide._said_first.text.startswith(f"{case / 'case.toml'}: there is no such file")
    case.mkdir()
    (case / "case.toml").write_text('format = 1\nsystem = "strut_model_adapter:SIMULATOR"\n')
    awaited(guide._ask(case))
    assert guide._said_first.text.startswith("strut_model.py cannot be read")
    awaited(guide._diagnose(case, "strut_model_adapter:SIMULATOR", (tmp_path,)))
    assert said.text == guide._said_first.text
    gone = write_trials([tmp_path / "t1.csv"], [{"column": "x", "channel": "x", "unit": "m"}], tmp_path / "no folder")
    assert len(gone) == 1 and "t1.csv" in gone[0]
    run = Run([], case, "", state="failed", code=-11)
    assert run.message == "it ended with code -11 and no message"


def test_numbers_that_come_after_the_page_was_left_are_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its elements are gone by then."""
    guide = GapGuide.__new__(GapGuide)
    client = Client(page(""), request=None)
    with client.content:
        place = Element("div")
    columns = SimpleNamespace(channels=lambda: ["flexion"])
    vars(guide).update(queue=None, _asked=None, _filled={"model": "knee", "trials": ""}, _columns=columns)
    vars(guide).update(_needs=models()["knee"][1], _typed_starts={}, _starts=None, _place_starts=place)
    said = SimpleNamespace(text="")
    guide._said_first = said

    def left(*_: object) -> tuple[dict[str, str], str]:
        client.delete()
        return {"R": "m"}, "wrong"

    monkeypatch.setattr("geocontact.app.gap_guide.numbers_of", left)
    awaited(guide._ask_numbers())
    assert guide._starts is None and said.text == ""


def test_only_the_run_that_was_asked_for_last_is_said_and_asked_about(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Trials are simulated anew before the first run ends, which fails, or while its case is read."""
    guide = GapGuide.__new__(GapGuide)
    case = {"system": "knee", "calibration": ["t1"], "evaluation": ["t2"], QUESTIONS: []}
    older, newer = (SimpleNamespace(pages={}, message="", state="done", out=tmp_path) for _ in range(2))
    said = SimpleNamespace(text="")
    panel = SimpleNamespace(run=older, refresh=lambda: True)
    vars(guide).update(_panels={1: panel}, _first=newer, _diagnosed=None, _said_first=said, _ask_numbers=nothing)
    older.message, older.state = "it failed", "failed"
    awaited(guide._look())
    assert said.text == ""
    older.message, older.state = "", "done"
    client = Client(page(""), request=None)
    with client.content:
        place = Element("div")
    vars(guide).update(_first=older, _place_questions=place, _outputs={}, _files=tmp_path)

    def pressed(_: Path) -> tuple[dict[str, object], str]:
        guide._first = newer
        return case, ""

    monkeypatch.setattr("geocontact.app.gap_guide.settings_of", pressed)
    awaited(guide._look())
    assert list(place) == []
    monkeypatch.setattr("geocontact.app.gap_guide.settings_of", lambda _: (case, ""))
    panel.run = newer
    awaited(guide._look())
    assert "diagnose" in [each.text for each in client.elements.values() if isinstance(each, TextElement)]


def test_a_simulator_with_the_name_of_another_module_is_refused(tmp_path: Path) -> None:
    """`gap init` would run the file, and the diagnosis the module."""
    for name in ("profile", "numpy"):
        pressed = Pressed(tmp_path, strut_trials(tmp_path / name, 1), tmp_path / f"{name}.py")
        assert pressed.press().endswith("has this name; rename the file") and not pressed.runs
    assert refused_name(tmp_path / "strut_model.py") == ""


async def nothing() -> None:
    """In the place of what a test does not look at."""


def test_all_pages_of_a_run_are_shown() -> None:
    guide = GapGuide.__new__(GapGuide)
    shown: list[tuple[str, str, bool]] = []
    run = SimpleNamespace(pages={"a": "1", "b": "2"}, message="")
    panel = SimpleNamespace(run=run, refresh=lambda: True)
    vars(guide).update(
        _panels={1: panel},
        _first=None,
        _diagnosed=None,
        _ask_numbers=nothing,
        show=lambda *page, beside: shown.append((*page, beside)),
    )
    awaited(guide._look())
    assert shown == [("a", "1", False), ("b", "2", True)]


def test_a_diagnosis_imports_the_simulator_that_was_simulated(tmp_path: Path) -> None:
    """A corrected file was dropped, an older one and older adapters lie around; modules with names of Python's and of
    installed ones are not run."""
    case, kept, latest = tmp_path / "case", tmp_path / "files", tmp_path / "files" / "2"
    (case / "trials").mkdir(parents=True)
    latest.mkdir(parents=True)
    adapter = "from strut_model import WHICH\nraise RuntimeError(f'adapter of {ADAPTER}, simulator {WHICH}')\n"
    for folder, name in ((kept, "old"), (latest, "latest"), (case, "case")):
        (folder / "strut_model_adapter.py").write_text(f"ADAPTER = {name!r}\n{adapter}")
        (folder / "strut_model.py").write_text(f"WHICH = {name!r}\n")
        for module in ("numpy", "signal", "cyclopts", "sitecustomize"):
            (folder / f"{module}.py").write_text(f"open({str(tmp_path / 'was run')!r}, 'w')\n")
    strut_trials(case / "made", 2)
    for file in (case / "made").glob("*.csv"):
        assert not write_trials([file], [{"column": "load", "channel": "load", "unit": "N m"}], case / "trials")
    (case / "case.toml").write_text(
        'format = 1\nsystem = "strut_model_adapter:SIMULATOR"\ncalibration = ["t1"]\nevaluation = ["t2"]\n'
        '[parameters.k]\nstart = 50\nlower = 10\nupper = 200\nunit = "N m/rad"\n'
    )
    modules = own_modules(case, latest / "strut_model.py", kept)
    assert modules[1:] == (latest,) and [each.name for each in modules[0].iterdir()] == ["strut_model_adapter.py"]
    queue = Queue(tmp_path)
    try:
        words = ["gap", "diagnose", str(case), f"--out={tmp_path / 'out'}"]
        run = queue.remember(Run(words, tmp_path / "out", "out", modules=modules))
        until_over(run)
    finally:
        queue.close()
    assert "adapter of case, simulator latest" in run.message, run.said
    assert not (tmp_path / "was run").exists()
    typed = _finding(modules, latest / "strut_model.py")
    program = f'"{sys.executable}" -P -c "from geocontact.cli.main import main; main()"'
    line = f"{typed}{program} gap diagnose {case} --out={tmp_path / 'out'}"
    own = {"PYTHONPATH": ""} | {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(line, shell=True, cwd=tmp_path, env=own, capture_output=True, text=True)
    assert "adapter of case, simulator latest" in done.stderr and not (tmp_path / "was run").exists()


def test_an_fmu_lies_beside_its_adapter_and_nothing_else_does(tmp_path: Path) -> None:
    case = tmp_path / "case"
    case.mkdir()
    for file in (case / "strut_adapter.py", tmp_path / "strut.fmu", tmp_path / "numpy.py"):
        file.write_text("x")
    (alone,) = own_modules(case, tmp_path / "strut.fmu", tmp_path / "files")
    assert sorted(each.name for each in alone.iterdir()) == ["strut.fmu", "strut_adapter.py"]
    assert own_modules(tmp_path / "no case", tmp_path / "model.py", tmp_path / "files") == (tmp_path,)


def until_over(run: Run) -> None:
    """Wait for the end of a run."""
    end = time.monotonic() + 240.0
    while not run.over:
        assert time.monotonic() < end, run.said
        time.sleep(0.02)


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
        table = ColumnTable([("knee", "deg"), ("speed", ""), ("hip", "degrees")], None)
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
        table = QuestionTable({**settings, QUESTIONS: ["are M the outputs?"]}, {"M": "N m"})
    words = [one.text for one in client.elements.values() if isinstance(one, TextElement)]
    assert "noise of M [N m]" in words
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
        QuestionTable({**settings, QUESTIONS: []}, {"M": "N m"})
    assert not any("kept in" in one.text for one in none.elements.values() if isinstance(one, TextElement))


def finished(tab: Page, count: int) -> str:
    """State of the last of `count` runs once it has ended."""
    states = "[...document.querySelectorAll('.run strong')].map(each => each.textContent)"
    until(tab, f"({states}).length === {count} && /: (done|refused|failed)/.test(({states}).at(-1))", 900.0)
    return str(tab.evaluate(f"({states}).at(-1)"))


def assert_same_answer(*files: Path) -> None:
    """Two files diagnosis.json say the same, but for how long it took."""
    one, other = (json.loads(file.read_text("utf-8")) for file in files)
    assert one.pop("seconds") > 0.0 and other.pop("seconds") > 0.0
    assert len(one) > 10 and one == other


def look_at(tab: Page, files: list[Path]) -> None:
    """Trials are dropped, and their columns are shown."""
    tab.locator('.field:has([name="trials"]) .pick input').set_input_files(files)
    until(tab, f"document.querySelector('[name=trials]').value.split('\\n').length === {len(files)}", 30.0)
    tab.get_by_role("button", name="look at their columns").click()


def begin(tab: Page, files: list[Path], columns: dict[str, str], units: dict[str, str], numbers: str) -> str:
    """Columns of trials are chosen, and the model is called on them."""
    look_at(tab, files)
    for column, role in columns.items():
        tab.get_by_label(f"{column} is", exact=True).select_option(role)
    for column, unit in units.items():
        tab.get_by_label(f"unit of {column}", exact=True).select_option(unit)
    if numbers:
        tab.locator('[name="numbers"]').fill(numbers)
    return simulated(tab)


def simulated(tab: Page) -> str:
    """State of the first run."""
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


@pytest.mark.oracle
@pytest.mark.slow
def test_an_fmu_from_columns_to_the_diagnosis(window: Window, tmp_path: Path) -> None:
    """Numbers are those of the FMU's own description; the answer is that of `gap diagnose` beside its adapter."""
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    fmu = built(tmp_path / "strut.fmu", compiler)
    files = []
    for file in sorted(recordings(tmp_path / "raw", samples=40).glob("*.csv")):
        files.append(tmp_path / file.name)
        files[-1].write_bytes(file.read_bytes())
    tab = window.tab("gap-case")
    tab.locator('.field:has([name="simulator"]) .pick input').set_input_files(fmu)
    until(tab, "document.querySelector('[name=simulator]').value.endsWith('strut.fmu')", 30.0)
    state = begin(tab, files, {"angle": "input", "torque": "output"}, {}, "")
    assert ": done" in state, tab.locator(".side").inner_text()
    tab.get_by_role("button", name="diagnose").click(timeout=60_000)
    assert ": done" in finished(tab, 2), tab.locator(".side").inner_text()
    case = window.folder / state.partition(":")[0]
    shutil.copytree(case, tmp_path / case.name)
    shutil.copy(case / "strut_adapter.py", tmp_path)
    run_words(["gap", "diagnose", case.name, "--bare", "--out=answer"], tmp_path)
    diagnosed = case.with_name(f"{case.name}-diagnosis-1") / "diagnosis.json"
    assert_same_answer(diagnosed, tmp_path / "answer" / "diagnosis.json")
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
    look_at(tab, files)
    for column, channel, unit in (("angle", "beta", "deg"), ("cuff", "force", "N")):
        tab.get_by_label(f"{column} is", exact=True).select_option(channel)
        tab.get_by_label(f"unit of {column}", exact=True).select_option(unit)
    for name, value in numbers.items():
        tab.get_by_label(f"start value of {name}", exact=True).fill(repr(value))
    state = simulated(tab)
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


def picture(tab: Page, name: str) -> None:
    """Screenshots at two widths, where a folder for them is named."""
    if folder := os.environ.get("GEOCONTACT_PICTURES"):
        for width in (1280, 390):
            tab.set_viewport_size({"width": width, "height": 900})
            tab.screenshot(path=f"{folder}/{name}-{width}.png", full_page=True)


@pytest.mark.slow
@pytest.mark.parametrize("name", MODELS)
def test_what_a_model_needs_is_asked_until_the_case_is_that_written_by_hand(
    window: Window, tmp_path: Path, name: str
) -> None:
    """Tables, numbers and those of single trials; for one model also the numbers of the diagnosis."""
    hand = tmp_path / "hand"
    case = written(name, hand)
    trials = (*case.calibration, *case.evaluation)
    tab = window.tab("gap-case")
    tab.locator('[name="model"]').select_option(name)
    for table in case.tables:
        tab.locator(f'.field:has([name="{table}"]) .pick input').set_input_files(hand / f"{table}.csv")
        until(tab, f"document.querySelector('[name={table}]').value.endsWith('{table}.csv')", 30.0)
    look_at(tab, sorted((hand / "trials").glob("*.csv")))
    starts = case.constants | {each.name: each.start for each in case.parameters}
    starts |= {f"{one.name}.{key}": value for one in trials for key, value in one.covariates.items()}
    for number, value in starts.items():
        tab.get_by_label(f"start value of {number}", exact=True).fill(repr(value), timeout=120_000)
    assert tab.locator('[aria-label^="start value of"]').count() == len(starts)
    state = simulated(tab)
    assert ": done" in state, tab.locator(".side").inner_text()
    shown = tab.frame_locator(".pages iframe").locator("body").inner_text(timeout=60_000)
    outputs = next(base.outputs for base in SYSTEMS if base.name == name)
    assert all(f"{each}, t1" in shown for each in case.calibration[0].signals.channels if each in outputs)
    for number in case.constants:
        tab.get_by_label(f"{number} is known exactly", exact=True).check(timeout=60_000)
    for each in case.parameters:
        tab.get_by_label(f"lower of {each.name}", exact=True).fill(repr(each.lower))
        tab.get_by_label(f"upper of {each.name}", exact=True).fill(repr(each.upper))
        assert tab.get_by_label(f"unit of {each.name}", exact=True).input_value() == each.unit
    tab.wait_for_timeout(500)
    tab.get_by_role("button", name="write the case").click()
    until(tab, "document.querySelector('.why[role=status]')?.textContent.includes('written: ')", 120.0)
    picture(tab, name)
    made = window.folder / state.partition(":")[0]
    both = [tomllib.loads((each / "case.toml").read_text("utf-8")) for each in (made, hand)]
    assert both[0] == both[1]
    if name == "sit_to_stand":
        tab.get_by_role("button", name="diagnose").click()
        assert ": done" in finished(tab, 2), tab.locator(".side").inner_text()
        picture(tab, "diagnosed")
        hand.rename(tmp_path / made.name)
        run_words(["gap", "diagnose", made.name, "--bare", "--out=answer"], tmp_path)
        diagnosed = made.with_name(f"{made.name}-diagnosis-1") / "diagnosis.json"
        assert_same_answer(diagnosed, tmp_path / "answer" / "diagnosis.json")
    tab.close()
