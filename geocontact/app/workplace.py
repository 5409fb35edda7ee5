"""Form, call, runs and results of an analysis on one page."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Protocol, runtime_checkable

from nicegui import background_tasks, ui
from nicegui.element import Element
from nicegui.elements.mixins.text_element import TextElement

from geocontact.app import calls
from geocontact.app.elements import element, link, text
from geocontact.app.fields import Form, shown
from geocontact.app.file_view import FileView
from geocontact.app.form_view import VALUE, FormView
from geocontact.app.runs import Queue, Run
from geocontact.app.study import study_of, written_study
from geocontact.cli.folders import OUT
from geocontact.cli.main import refusal
from geocontact.data.errors import InputError

GO_TO_PAGES = (
    "if (!document.activeElement.matches('input, select, textarea'))document.querySelector('.pages').scrollIntoView();"
)
"""Pages lie below a long form; whoever is typing in it stays there."""
LOOK = 0.3
"""s between two looks at the runs and at what was typed."""
CHANGES = 3.0
"""s between two looks at whether files that are shown were changed by others."""


class Workplace:
    """The form of an analysis, what it stands for, its runs and the pages of its results.

    Parameters
    ----------
    queue
        Takes the runs.
    form
        Filled with a sample or empty.
    out
        Folder for the results.
    upload
        Address that takes files.
    files
        Folder that they are kept in, with pages of surfaces.
    serve
        Address of a page that was written there.
    keep
        Takes what was filled in; its key for the address, which has no paths of files and a largest size.
    """

    def __init__(
        self,
        queue: Queue,
        form: Form,
        out: Path,
        upload: str,
        files: Path,
        serve: Callable[[Path], str],
        keep: Callable[[str], str],
    ) -> None:
        self.queue, self.form, self.out = queue, form, out
        self.words: list[str] = []
        self._named = form.command.split()
        self._dirty = True
        self._kept, self._keep = form.kept(), keep
        self._panels: dict[int, RunPanel] = {}
        with element("div", "work"):
            with element("div", "fields"):
                self.view = FormView(form, upload, self._changed)
                self.files = FileView(self.view, queue.start, files, serve, upload)
            with element("div", "side"):
                self._beside()
        self.pages = element("div", "pages")
        self.command.text = shown(self.form.words(self.out))
        ui.timer(LOOK, self._look, immediate=False)  # the page is there before its words are checked
        ui.timer(CHANGES, self._look_at_changes, immediate=False)

    def run(self) -> None:
        """A run of what is filled in, unless that is refused as it stands; its results lie in a folder of their own.

        Runs that have not ended yet may write what it reads: then it waits for them before it is judged.
        """
        _, wrong = calls.checked(self.form.words(self.out), self.form.command, self.out)
        if wrong and all(run.over for run in self.queue.runs):
            self.missing.text = self.view.refresh(wrong, only_touched=False)
            self.view.go_to(wrong)
            return
        run = self.queue.add_apart(self.form.words, self.out)
        self.words = run.words
        if run.out != self.out:
            self.out = run.out
            self.folder.props["defaultValue"] = str(self.out)
            ui.run_javascript(f"document.getElementById('{self.folder.html_id}').value = {json.dumps(str(self.out))}")
        self._panels[run.number] = RunPanel(run, self)
        self._dirty = True
        self._look()

    def take_up(self) -> None:
        """Show the runs of this analysis that have ended, as before the page was loaded anew, and look at the files."""
        of_this = [run for run in self.queue.runs if run.words[: len(self._named)] == self._named]
        for run in of_this:
            self._panels[run.number] = RunPanel(run, self)
        self.words = of_this[-1].words if of_this else []
        self.files.look_at_all()

    def show(self, name: str, address: str, beside: bool) -> None:
        """The page of a result in a frame of its own, in place of those that are shown, or beside the first one."""
        if not beside:
            self.pages.clear()
        elif len(self.pages.default_slot.children) > 1:
            self.pages.default_slot.children[-1].delete()
        with self.pages, element("section"):
            text("h2", name)
            element("iframe", src=address, title=f"results in {name}", sandbox="allow-scripts allow-downloads")
        ui.run_javascript(GO_TO_PAGES)

    def make_study(self) -> None:
        """Write the study that the form begins beside those that are there, and say how it is run."""
        try:
            described = study_of(calls.expanded(self.form, self.out), self.queue.start)
        except (InputError, OSError) as error:
            self.study.text = refusal(error)
            return
        file = written_study(self.queue.folder / f"{self.out.name}-study.toml", described)
        self.study.text = f"{described}\n# {shown(['cohort', str(file), OUT, str(file.parent / file.stem)])}"

    def _beside(self) -> None:
        """What stands beside the form."""
        with element("div", "field"):
            label = text("label", "folder for the results")
            with element("div", "in"):
                self.folder = element("input", type="text", defaultValue=str(self.out), spellcheck="false")
                self.folder.on("change", lambda e: self._set_out(str(e.args)), js_handler=VALUE)
                self.folder.on("input", lambda e: self._set_out(str(e.args)), js_handler=VALUE, throttle=LOOK)
            label.props["for"] = self.folder.html_id
        with element("div", "links"):
            text("button", "Run", "main", type="button").on("click", self.run)
        self.missing = text("p", "", "why", role="status")
        text("h2", "Command line")
        self.command = text("pre", "", tabindex="0", aria_label="command line")
        self._copy("copy the command line", self.command)
        text("h2", "Python")
        self.python = text("pre", "", tabindex="0", aria_label="Python lines")
        self._copy("copy the Python lines", self.python)
        text("h2", "Runs")
        self.runs = element("div", "runs", aria_live="polite")
        text("button", "make a study of this", type="button").on("click", self.make_study)
        self.study = text("pre", "", tabindex="0", aria_label="study")

    def _copy(self, words: str, source: Element) -> None:
        script = f"() => navigator.clipboard.writeText(document.getElementById('{source.html_id}').textContent)"
        text("button", words, type="button").on("click", js_handler=script)

    def _changed(self) -> None:
        self._dirty = True

    def _set_out(self, value: str) -> None:
        if value.strip():
            self.out = self.queue.folder / value.strip()
        self._dirty = True

    def _look(self) -> None:
        """Follow the runs, and say what the form stands for after a change."""
        for run in self.queue.runs:
            if run.number not in self._panels and not run.over:
                self._panels[run.number] = RunPanel(run, self)
        ended = [panel.run for panel in self._panels.values() if panel.refresh()]
        self._dirty = self._dirty or bool(ended)
        if self._dirty:
            self._dirty = False
            self._say()
            background_tasks.create(self.files.look(), name="files of a form")
        for run in ended:
            if run.message and run.words == self.words:
                self.missing.text = self.view.refresh(run.message, only_touched=False)
                self.view.go_to(run.message)
            elif run.pages and run.words == self.words:
                self.show(*next(iter(run.pages.items())), beside=False)

    def _look_at_changes(self) -> None:
        """What is said of files that were changed is said anew."""
        self._dirty = self._dirty or self.files.changed()

    def _say(self) -> None:
        """Show the call, and a mistake at the field that it names."""
        words = self.form.words(self.out)
        self.command.text = shown(words)
        lines, wrong = calls.checked(words, self.form.command, self.out)
        self.python.text = lines or ("…" if wrong else "the command line only")
        self.missing.text = self.view.refresh(wrong)
        if (kept := self.form.kept()) != self._kept:
            self._kept = kept
            ui.run_javascript(f"keep({json.dumps(self._keep(kept))})")


@runtime_checkable
class RunPlace(Protocol):
    """A page that shows runs: the element for them, their queue, and where the page of a result is shown."""

    queue: Queue
    runs: Element

    def show(self, name: str, address: str, beside: bool) -> None:
        """The page of a result by its name and address."""


class RunPanel:
    """A run on the page: how far it is, its warnings, what it printed, and what can be done with it.

    Parameters
    ----------
    run, place
        What is shown, and the page that it belongs to.
    """

    def __init__(self, run: Run, place: RunPlace) -> None:
        self.run, self._place = run, place
        self._seen: tuple[object, ...] = ()
        with place.runs, element("div", "run") as self._panel:
            self._head = text("strong", "")
            self._bar = element("progress", max=1, aria_label=f"progress of {run.title}")
            self._lines = element("ul")
            with element("div", "links"):
                self._cancel = text("button", "cancel", type="button", aria_label=f"cancel {run.title}")
                self._cancel.on("click", self._end)
        self._links: list[TextElement] = []

    def refresh(self) -> bool:
        """Show what is new; whether the run has ended since the last look."""
        run = self.run
        left = run.seconds_left()
        seen = (run.state, run.stage, run.share, len(run.warnings), len(run.printed), run.code, left and round(left))
        if seen == self._seen:
            return False
        ended = run.over and self._seen[:1] != seen[:1]
        self._seen = seen
        self._head.text = ": ".join(part for part in (run.title, _state(run, left)) if part)
        self._bar.set_visibility(run.state == "running")
        self._bar.props.set_optional("value", run.share)
        self._lines.clear()
        with self._lines:
            for line in (*(f"warning: {each}" for each in run.warnings), *run.printed):
                text("li", line)
            for line in run.complaints:
                text("li", line, "bad")
        if ended:
            self._ended()
        return ended

    def _ended(self) -> None:
        """Offer its pages in place of what ended it."""
        self._cancel.delete()
        pages = self.run.pages
        for name, address in pages.items():
            with self._panel, element("div", "links"):
                if len(pages) > 1:
                    text("span", name.rpartition("/")[2])
                for words, beside in (("show", False), ("show beside", True)):
                    button = text("button", words, type="button", aria_label=words.replace("show", f"show {name}"))
                    button.on("click", partial(self._place.show, name, address, beside))
                link("in a tab of its own", address, target="_blank")

    async def _end(self) -> None:
        from nicegui import run as aside

        await aside.io_bound(self._place.queue.cancel, self.run)


def _state(run: Run, left: float | None) -> str:
    """State, stage and time left in words."""
    parts = [run.state, run.stage if run.state == "running" else ""]
    if run.state == "running" and run.share is not None:
        parts.append(f"{100 * run.share:.0f} %")
    if left is not None:
        parts.append(f"{_duration(left)} left")
    if run.over and run.ended > run.began > 0.0:
        parts.append(_duration(run.ended - run.began))
    return ", ".join(part for part in parts if part)


def _duration(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 100.0 else f"{seconds / 60.0:.0f} min"
