"""A gap case step by step: model, trials, columns, measured beside simulated, answers, diagnosis."""

from __future__ import annotations

import os
import shlex
import shutil
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nicegui import run as aside
from nicegui import ui
from nicegui.element import Element
from nicegui.elements.mixins.text_element import TextElement

from geocontact.app.elements import choice, element, text
from geocontact.app.fields import Form, shown
from geocontact.app.form_view import VALUE
from geocontact.app.gap_columns import ColumnTable
from geocontact.app.gap_files import (
    answer_questions,
    columns_of,
    new_folder,
    numbers_of,
    own_modules,
    refused_name,
    settings_of,
    unreadable,
    write_trials,
)
from geocontact.app.gap_questions import QuestionTable, StartTable
from geocontact.app.runs import Queue, Run
from geocontact.app.workplace import LOOK, RunPanel

if TYPE_CHECKING:
    from geocontact.systems.base import Base, CaseNeeds

OWN = ""
CASE = "case.toml"


class GapGuide:
    """The page.

    Parameters
    ----------
    queue
        Takes the runs.
    out
        Folder for the case; that of its diagnosis lies beside it.
    upload, files
        Address that takes files, and the folder that they are kept in.
    """

    def __init__(self, queue: Queue, out: Path, upload: str, files: Path) -> None:
        self.queue, self._out, self._upload, self._files = queue, out, upload, files
        self._filled: dict[str, str] = {"model": OWN, "simulator": "", "trials": "", "numbers": ""}
        self._panels: dict[int, RunPanel] = {}
        self._first: Run | None = None
        self._diagnosed: Run | None = None
        self._simulated, self._outputs = Path(), dict[str, str]()
        self._base: Base | None = None
        self._needs: CaseNeeds | None = None
        self._columns: ColumnTable | None = None
        self._asked: object = None
        self._typed_starts: dict[str, str] = {}
        self._starts = StartTable({}, self._typed_starts)
        self._questions: QuestionTable | None = None
        with element("div", "work"):
            with element("div", "fields"):
                self._steps()
            with element("div", "side"):
                text("h2", "Command line")
                self._command = text("pre", "", tabindex="0", aria_label="command line")
                text("h2", "Runs")
                self.runs = element("div", "runs", aria_live="polite")
        self.pages = element("div", "pages")
        ui.timer(LOOK, self._look)

    def show(self, name: str, address: str, beside: bool) -> None:
        """The page of a result, in place of another one or beside it."""
        if not beside:
            self.pages.clear()
        with self.pages, element("section"):
            text("h2", name)
            element("iframe", src=address, title=f"results in {name}", sandbox="allow-scripts allow-downloads")

    def _steps(self) -> None:
        text("h2", "1. Model")
        with element("div", "field"):
            label = text("label", "model")
            shipped = [(name, f"{name}: {needs.words}") for name, (_, needs) in models().items()]
            made = choice([(OWN, "my own simulator"), *shipped], OWN, name="model")
            made.on("change", self._chosen_model, js_handler=VALUE)
            label.props["for"] = made.html_id
        words = "Python file with run(time, inputs, numbers), an .fmu, or a command with {params} {trial} {out}"
        self._simulator = self._typed("simulator", f"{words}. It is run.", "input")
        self._place_tables = element("div")
        text("h2", "2. Trials")
        self._typed("trials", "A table (.csv, .sto, .mot) for each trial: four or more, of one kind.", "textarea")
        self._button("look at their columns", self._look_at_columns)
        self._said_columns = text("p", "", "bad", role="alert")
        text("h2", "3. Columns")
        self._place_columns = element("div", aria_live="polite")
        text("h2", "4. Measured beside simulated")
        words = "One a line: k=300, SI unit. Where nothing is said the simulator is asked."
        self._numbers = self._typed("numbers", f"Start values of the model's numbers. {words}", "textarea", picks=False)
        self._place_starts = element("div", aria_live="polite")
        self._button("simulate the trials", self._simulate)
        self._said_first = text("p", "", "bad", role="alert")
        text("h2", "5. Answers")
        self._place_questions = element("div", aria_live="polite")

    def _typed(self, name: str, words: str, tag: str, picks: bool = True) -> Element:
        """A field that is typed into or that files are dropped on."""
        with element("div", "field") as row:
            label = text("label", name)
            with element("div", "in"):
                made = element(tag, name=name, spellcheck="false")
                label.props["for"] = made.html_id
                if picks:
                    with element("span", "pick"):
                        text("span", "choose or drop …")
                        told: dict[str, Any] = {"data_to": self._upload, "data_target": made.html_id}
                        pick = element("input", type="file", aria_label=f"choose a file for {name}", **told)
                        pick.props.set_bool("multiple", tag == "textarea")
            text("p", words, "help")
        for event in ("change", "input"):
            made.on(event, lambda e: self._filled.update({name: str(e.args)}), js_handler=VALUE)
        return row

    def _button(self, words: str, act: Callable[[], Any]) -> TextElement:
        return text("button", words, "main", type="button").on("click", act)

    def _chosen_model(self, event: Any) -> None:
        self._filled["model"] = str(event.args)
        self._base, self._needs = models().get(self._filled["model"], (None, None))
        for own in (self._simulator, self._numbers):
            own.set_visibility(self._base is None)
        self._place_tables.clear()
        with self._place_tables:
            for name, columns in self._needed_tables().items():
                self._filled[name] = ""
                self._typed(name, f"A table (.csv) with the columns {', '.join(columns)}.", "input")
        if self._columns is not None:
            self._show_columns(self._columns.columns)

    def _needed_tables(self) -> Mapping[str, tuple[str, ...]]:
        return self._needs.tables if self._needs is not None else {}

    def _tables(self) -> dict[str, str]:
        """Files of the tables that were named."""
        named = ((name, self._filled[name].strip()) for name in self._needed_tables())
        return {name: str(self.queue.start / file) for name, file in named if file}

    async def _ask_numbers(self) -> None:
        """Fields for the numbers that a model of the package needs: they depend on channels, tables and trials."""
        needs = self._needs
        channels = self._columns.channels() if self._columns is not None and needs is not None else []
        trials = [each.stem for each in self._trials()]
        asked = (self._filled["model"], channels, self._tables(), trials)
        if asked == self._asked:
            return
        self._asked = asked
        units: dict[str, str] = {}
        wrong = ""
        if needs is not None and channels and len(self._tables()) == len(needs.tables):
            units, wrong = await aside.io_bound(numbers_of, *asked[:3]) or ({}, "")
            units = units | {f"{trial}.{name}": "-" for trial in trials for name in needs.per_trial if units}
        if self._place_starts.is_deleted:
            return
        self._said_first.text = wrong
        self._place_starts.clear()
        with self._place_starts:
            if needs is not None and not units:
                text("p", "Start values are asked for once tables and columns are chosen.", "help")
            self._starts = StartTable(units, self._typed_starts)

    def _trials(self) -> list[Path]:
        lines = (line.strip() for line in self._filled["trials"].splitlines())
        return [self.queue.start / line for line in lines if line]

    async def _look_at_columns(self) -> None:
        self._said_columns.text = "" if self._trials() else "name the files of the trials first"
        if not self._trials():
            return
        columns, said = await aside.io_bound(columns_of, self._trials()) or ([], [])
        self._said_columns.text = "; ".join(said)
        self._show_columns(columns)

    def _show_columns(self, columns: list[tuple[str, str]]) -> None:
        self._place_columns.clear()
        with self._place_columns:
            self._columns = ColumnTable(columns, self._base)

    async def _simulate(self) -> None:
        """Write the trials and call the model on each."""
        if self._columns is None or not (rows := self._columns.rows()):
            self._said_first.text = "choose columns first"
            return
        own = self._base is None
        simulator = self._filled["simulator"].strip() if own else self._filled["model"]
        file = _file_of(simulator, self.queue.start)
        if own and (wrong := refused_name(file)):
            self._said_first.text = wrong
            return
        data = new_folder(self._files / "recordings")
        numbers = self._filled["numbers"] if own else self._starts.lines()
        form = Form("gap init", {"data": str(data), "number": numbers, "simulator": simulator})
        form.values |= self._columns.sides() if own else {}
        form.values["table"] = "\n".join(f"{name}={file}" for name, file in self._tables().items())
        outputs = self._columns.outputs()
        said = await aside.io_bound(write_trials, self._trials(), rows, data)
        self._said_first.text = "; ".join(said or [])
        if said:
            shutil.rmtree(data, ignore_errors=True)
            return
        self._place_questions.clear()
        self._questions = None
        self._simulated, self._outputs, self._diagnosed = file, outputs, None
        self._first = self._queued(form, self._out)

    def _queued(self, form: Form, out: Path, modules: tuple[Path, ...] = ()) -> Run:
        run = self.queue.add_apart(form.words, out, modules)
        self._command.text = _finding(modules, self._simulated) + shown(run.words)
        self._panels[run.number] = RunPanel(run, self)
        return run

    async def _look(self) -> None:
        for run in [panel.run for panel in self._panels.values() if panel.refresh()]:
            for k, (name, address) in enumerate(run.pages.items()):
                self.show(name, address, beside=k > 0)
            if run is self._first:
                self._said_first.text = run.message or self._said_first.text
                if run.state == "done":
                    await self._ask(run.out)
            elif run is self._diagnosed:
                self._said_case.text = run.message or self._said_case.text
        await self._ask_numbers()

    async def _ask(self, case: Path) -> None:
        """The questions that a begun case leaves."""
        asked = self._first
        settings, wrong = await aside.io_bound(settings_of, case) or ({}, "")
        if self._place_questions.is_deleted or self._first is not asked:
            return
        modules: tuple[Path, ...] = ()
        imported = ":" in settings.get("system", "")  # a simulator of the user's own that Python imports
        if imported and not (wrong := unreadable(self._simulated)):
            modules = await aside.io_bound(own_modules, case, self._simulated, self._files) or ()
        if self._first is not asked:  # the trials are simulated anew meanwhile
            return
        if wrong or not settings:
            self._said_first.text = wrong
            return
        with self._place_questions:
            self._questions = QuestionTable(settings, self._outputs)
            self._button("write the case", partial(self._write, case))
            self._button("diagnose", partial(self._diagnose, case, settings["system"], modules))
            self._said_case = text("p", "", "why", role="status")

    async def _write(self, case: Path) -> bool:
        """Write the answers into the case; whether it can be read with them."""
        if self._questions is None:
            return False
        try:
            answers = self._questions.answers()
        except ValueError as error:
            self._said_case.text = str(error)
            return False
        wrong = await aside.io_bound(answer_questions, case, answers)
        self._said_case.text = wrong or f"written: {case / CASE}"
        return not wrong

    async def _diagnose(self, case: Path, system: str, modules: tuple[Path, ...]) -> None:
        if modules and (wrong := unreadable(self._simulated)):
            self._said_case.text = wrong
        elif await self._write(case):
            form = Form("gap diagnose", {"case": str(case), "run_simulator": system == "command"})
            self._diagnosed = self._queued(form, case.with_name(f"{case.name}-diagnosis-1"), modules)


def models() -> dict[str, tuple[Base, CaseNeeds]]:
    """Models of the package that declare what they need, by name."""
    from geocontact.systems.catalogue import SYSTEMS  # which takes a second, and no other page needs

    return {each.name: (each, each.needs) for each in SYSTEMS if each.needs is not None}


def _file_of(simulator: str, start: Path) -> Path:
    """File that a simulator is typed as, "mine.py" or "mine.py:NAME"; none has the path of a command."""
    path, _, name = simulator.partition(".py:")
    return start / (f"{path}.py" if name else simulator)


def _finding(modules: tuple[Path, ...], simulator: Path) -> str:
    """What a terminal needs before a command line, so that Python finds `modules`.

    PYTHONPATH, which comes before all other folders, gets that of an adapter only, where nothing else lies; the current
    folder is looked at last.
    """
    windows = os.name == "nt"
    words = ""
    for folder in reversed(modules):
        if folder == simulator.parent:
            words += f'cd /d "{folder}" && ' if windows else f"cd {shlex.quote(str(folder))} && "
        else:
            words += f'set "PYTHONPATH={folder}" && ' if windows else f"PYTHONPATH={shlex.quote(str(folder))} "
    return words
