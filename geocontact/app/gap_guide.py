"""A gap case step by step: model, trials, columns, measured beside simulated, answers, diagnosis."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from nicegui import run as aside
from nicegui import ui
from nicegui.element import Element
from nicegui.elements.mixins.text_element import TextElement

from geocontact.app.elements import choice, element, text
from geocontact.app.fields import Form, shown
from geocontact.app.form_view import VALUE
from geocontact.app.gap_columns import ColumnTable
from geocontact.app.gap_files import answer_questions, columns_of, settings_of, write_trials
from geocontact.app.gap_questions import QuestionTable
from geocontact.app.runs import Queue, Run
from geocontact.app.workplace import LOOK, RunPanel

OWN = ""
MODELS = (
    (OWN, "my own simulator"),
    ("elbow", "elbow: exoskeleton on a misaligned axis"),
    ("knee", "knee: forces from areas"),
)
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
        self._columns: ColumnTable | None = None
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
            made = choice(MODELS, OWN, name="model").on("change", self._chosen_model, js_handler=VALUE)
            label.props["for"] = made.html_id
        words = "Python file with run(time, inputs, numbers), an .fmu, or a command with {params} {trial} {out}"
        self._simulator = self._typed("simulator", f"{words}. It is run.", "input")
        text("h2", "2. Trials")
        self._typed("trials", "A table (.csv, .sto, .mot) for each trial: four or more, of one kind.", "textarea")
        self._button("look at their columns", self._look_at_columns)
        self._said_columns = text("p", "", "bad", role="alert")
        text("h2", "3. Columns")
        self._place_columns = element("div", aria_live="polite")
        text("h2", "4. Measured beside simulated")
        words = "One a line: k=300, SI unit. Where nothing is said the simulator is asked."
        self._typed("numbers", f"Start values of the model's numbers. {words}", "textarea", picks=False)
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
        self._simulator.set_visibility(self._filled["model"] == OWN)
        if self._columns is not None:
            self._show_columns(self._columns.columns)

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
            self._columns = ColumnTable(columns, self._filled["model"])

    async def _simulate(self) -> None:
        """Write the trials and call the model on each."""
        if self._columns is None or not (rows := self._columns.rows()):
            self._said_first.text = "choose columns first"
            return
        data = self._files / "recordings"
        said = await aside.io_bound(write_trials, self._trials(), rows, data)
        self._said_first.text = "; ".join(said or [])
        if said:
            return
        own = self._filled["model"] == OWN
        form = Form("gap init", {"data": str(data), "number": self._filled["numbers"]})
        form.values["simulator"] = self._filled["simulator"].strip() if own else self._filled["model"]
        if own:
            form.values |= self._columns.sides()
        self._place_questions.clear()
        self._questions = None
        self._first = self._queued(form, self._out, self._modules())

    def _modules(self) -> str:
        """Folders of a simulator of the user's own and of its adapter."""
        file = self.queue.start / self._filled["simulator"].strip().partition(".py:")[0]
        if self._filled["model"] != OWN or not self._filled["simulator"].strip():
            return ""
        return os.pathsep.join(map(str, (self._files, file.parent)))

    def _queued(self, form: Form, out: Path, modules: str) -> Run:
        run = self.queue.add_apart(form.words, out, modules)
        prefix = f"PYTHONPATH={modules} " if modules and form.command != "gap init" else ""
        self._command.text = prefix + shown(run.words)
        self._panels[run.number] = RunPanel(run, self)
        return run

    async def _look(self) -> None:
        for run in [panel.run for panel in self._panels.values() if panel.refresh()]:
            for name, address in run.pages.items():
                self.show(name, address, beside=False)
            if run is self._first and run.state == "done":
                await self._ask(run.out)
            if run is self._first and run.message:
                self._said_first.text = run.message

    async def _ask(self, case: Path) -> None:
        """The questions that a begun case leaves."""
        self._keep_adapters(case)
        settings = await aside.io_bound(settings_of, case)
        if not settings or self._place_questions.is_deleted:
            return
        outputs = self._columns.outputs() if self._columns is not None else []
        with self._place_questions:
            self._questions = QuestionTable(settings, outputs)
            self._button("write the case", partial(self._write, case))
            self._button("diagnose", partial(self._diagnose, case, settings["system"]))
            self._said_case = text("p", "", "why", role="status")

    def _keep_adapters(self, case: Path) -> None:
        """Modules beside the simulator: Python does not look for any in the folder of a case."""
        for adapter in case.glob("*_adapter.py"):
            self._files.mkdir(parents=True, exist_ok=True)
            shutil.copy(adapter, self._files / adapter.name)

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

    async def _diagnose(self, case: Path, system: str) -> None:
        if await self._write(case):
            form = Form("gap diagnose", {"case": str(case), "run_simulator": system == "command"})
            self._queued(form, case.with_name(f"{case.name}-diagnosis-1"), self._modules())
