"""Pages of the window: where one starts, and the form of an analysis with its runs and results beside it."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from hmac import compare_digest
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory

from fastapi import FastAPI, HTTPException, Request
from fastapi.responses import FileResponse, PlainTextResponse
from nicegui import app as site
from nicegui import ui
from nicegui.element import Element
from starlette.datastructures import UploadFile

from geocontact.analyses.catalogue import ENTRIES, entry_of
from geocontact.app import samples
from geocontact.app.elements import element, link, text
from geocontact.app.fields import Form
from geocontact.app.gap_guide import GapGuide
from geocontact.app.gate import RESULT, secret
from geocontact.app.runs import Queue, Run
from geocontact.app.workplace import Workplace
from geocontact.cli.command import summary

MOST_RECENT = 12
MOST_OF_A_NAME = 10_000
MOST_FILES = 20_000
"""Files of a folder, as its reader looks at."""
PIECE = 1 << 20
RECORD = "run.json"
GUIDE, GUIDED = "/gap-case", "a gap case, step by step"
HERE = Path(__file__).parent
SANDBOX = (
    "sandbox allow-scripts allow-downloads; default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: blob:; font-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'self'"
)
"""Pages of results run their own scripts, but belong to no origin and load nothing; in a tab they can lead away."""


class Shared:
    """What all pages share.

    Parameters
    ----------
    queue
        Runs of this window, those of earlier ones in its folder among them.
    """

    def __init__(self, queue: Queue) -> None:
        self.queue = queue
        self._uploads: dict[int, Path] = {}
        self._pages: dict[int, Path] = {}
        self.filled: dict[str, str] = {}
        """What was filled in on each page, by the key in its address."""
        self._keys = count(1)

    def upload_to(self, folder: Path) -> str:
        """Address that takes files into a folder, which is made when the first one arrives."""
        key = next(self._keys)
        self._uploads[key] = folder
        return f"/upload/{key}"

    def serve(self, page: Path) -> str:
        """Address of a page that the window wrote."""
        key = next(self._keys)
        self._pages[key] = page
        return f"/page/{key}"

    def keep(self, key: str, filled: str) -> str:
        """Keep what is filled in on a page, for when it is loaded anew; the key."""
        self.filled[key] = filled
        return key

    def page(self, key: int) -> Path:
        """The page at an address."""
        found = self._pages.get(key)
        if found is None or not found.is_file():
            raise HTTPException(404)
        return found

    async def take(self, key: int, name: str, request: Request) -> str:
        """Keep a file that was dropped, whole or not at all, in place of none that is there; its path."""
        (plain,) = _parts(name.replace("\\", "/").rpartition("/")[2].strip())
        with self._arriving(key) as part:
            with (part / plain).open("wb") as kept:
                async for piece in request.stream():
                    kept.write(piece)
            return self._moved(part / plain)

    async def take_folder(self, key: int, request: Request) -> str:
        """Keep the files of a folder below it as they were, all or none, in place of none that is there; its path."""
        with self._arriving(key) as part:
            async with request.form(max_files=MOST_FILES, max_fields=0) as form:
                for name, file in form.multi_items():
                    place = part.joinpath(*_parts(name))
                    place.parent.mkdir(parents=True, exist_ok=True)
                    with place.open("xb") as kept:
                        while isinstance(file, UploadFile) and (piece := await file.read(PIECE)):
                            kept.write(piece)
            found = [*part.iterdir()]
            if len(found) != 1 or not found[0].is_dir():
                raise HTTPException(422, "it is not one folder" if found else "it holds no files")
            return self._moved(found[0])

    @contextmanager
    def _arriving(self, key: int) -> Iterator[Path]:
        """A folder for what has not arrived yet, removed at the end."""
        if key not in self._uploads:
            raise HTTPException(404)
        self._uploads[key].mkdir(parents=True, exist_ok=True)
        try:
            with TemporaryDirectory(prefix=".", dir=self._uploads[key]) as part:
                yield Path(part)
        except OSError as error:
            raise HTTPException(507, str(error.strerror)) from error

    def _moved(self, arrived: Path) -> str:
        """Where it lies from now on: beside the folder that it arrived in, or in a numbered one.

        What has a number for a name lies in a numbered one too: what comes later would else be put into it.
        """
        folder, number = arrived.parent.parent, arrived.name.isdecimal()
        places = (folder / str(k) if k else folder for k in (0, *range(2, MOST_OF_A_NAME))[number:])
        place = next(each for each in places if not (each / arrived.name).exists())
        place.mkdir(exist_ok=True)
        return str(arrived.replace(place / arrived.name))

    def file(self, key: str, name: str) -> Path:
        """A file of a run's results; nothing outside of their folder."""
        run = next((each for each in self.queue.runs if compare_digest(each.key.encode(), key.encode())), None)
        if run is not None:
            found = (run.out / name).resolve()
            if found.is_relative_to(run.out.resolve()) and found.is_file():
                return found
        raise HTTPException(404)


def _parts(name: str) -> list[str]:
    """Parts of a relative path that stays below where it is put."""
    parts = name.split("/")
    signs = "\0\\:" if os.name == "nt" else "\0\\"
    if any(part in ("", ".", "..") or any(sign in part for sign in signs) for part in parts):
        raise HTTPException(404, f"no file here can be called {parts[-1]}")
    return parts


def add_pages(queue: Queue, outside: FastAPI) -> None:
    """Declare all pages and addresses; those of results at the application around the pages, without their path."""
    shared = Shared(queue)
    for run in reversed(earlier_runs(queue.folder)):
        queue.remember(run)

    @site.post("/upload/{key}")
    async def _upload(key: int, name: str, request: Request) -> PlainTextResponse:
        return PlainTextResponse(await shared.take(key, name, request))

    @site.post("/upload/{key}/folder")
    async def _upload_folder(key: int, request: Request) -> PlainTextResponse:
        return PlainTextResponse(await shared.take_folder(key, request))

    @outside.get(RESULT + "{key}/{name:path}")
    def _result(key: str, name: str) -> FileResponse:
        return FileResponse(shared.file(key, name), headers={"content-security-policy": SANDBOX})

    @site.get("/page/{key}")
    def _page(key: int) -> FileResponse:
        return FileResponse(shared.page(key), headers={"content-security-policy": SANDBOX})

    @ui.page("/")
    def _start() -> None:
        _begin("geocontact")
        start_page(shared)

    @ui.page("/form/{slug}")
    def _form(slug: str, sample: int = 0, filled: str = "") -> None:
        command = slug.replace(".", " ")
        if command not in samples.SAMPLES:
            raise HTTPException(404)
        _begin(command)
        with element("main"):
            form_page(shared, command, bool(sample), shared.filled.get(filled, ""))

    @ui.page(GUIDE)
    def _guide() -> None:
        _begin(GUIDED)
        with element("main"):
            text("h1", GUIDED, tabindex="-1")
            out = free_folder(queue.folder, "gap case")
            files = Path(f"{out}-files")
            GapGuide(queue, out, shared.upload_to(files), files)


def start_page(shared: Shared) -> None:
    """What somebody has leads to the analysis for it."""
    known = {each.command: each for each in ENTRIES if each.command}
    queue = shared.queue
    with element("main") as main:
        text("h1", "I have …")
        for what, commands in samples.START.items():
            text("h2", what)
            if "gap init" in commands:
                with element("p"):
                    link(GUIDED, GUIDE)
            with element("div", "have"):
                for command in commands:
                    _card(shared, main, command, summary(known[command].load_options()))
        text("h2", "Recent results")
        _recent(queue)


def form_page(shared: Shared, command: str, sampled: bool, filled: str = "") -> None:
    """The form of an analysis, filled with its sample where that is asked for, or with what was kept of a page."""
    queue = shared.queue
    form = Form.of_kept(command, filled)
    if sampled and not filled:
        one = samples.sample(command, queue.folder)
        form = Form.of_words(one.words)
        for earlier in one.before:
            _run_before(queue, earlier)
    out = free_folder(queue.folder, command)
    text("h1", command, tabindex="-1")
    text("p", summary(entry_of(command).load_options()))
    files = Path(f"{out}-files")
    place = Workplace(queue, form, out, shared.upload_to(files), files, shared.serve, partial(shared.keep, secret()))
    if filled:
        place.take_up()


def free_folder(folder: Path, command: str) -> Path:
    """A folder for results that is not there yet: area-1."""
    name = command.replace(" ", "-")
    return next(out for k in count(1) if not (out := folder / f"{name}-{k}").exists())


def earlier_runs(folder: Path) -> list[Run]:
    """Results of earlier windows, the latest ones first; trials of a folder have theirs in a folder each."""
    records = [*folder.glob(f"*/{RECORD}")]
    records += [file for file in folder.glob(f"*/*/{RECORD}") if not (file.parent.parent / RECORD).exists()]
    found = sorted((file.parent for file in records), key=lambda out: (out / RECORD).stat().st_mtime, reverse=True)
    return [Run([], out, out.relative_to(folder).as_posix(), state="done", earlier=True) for out in found[:MOST_RECENT]]


def _begin(title: str) -> None:
    """Title, style and head of a page."""
    ui.page_title(_titled(title))
    ui.add_css(HERE / "style.css")
    for script in ("script.js", "folders.js"):
        ui.add_body_html(f"<script>{(HERE / script).read_text(encoding='utf-8')}</script>")
    with element("header", "top"):
        link("geocontact", "/")
        link("all analyses", "/")
        text("span", "runs on this machine only")


def _titled(name: str) -> str:
    return f"{name} – geocontact" if name != "geocontact" else name


def _card(shared: Shared, main: Element, command: str, words: str) -> None:
    with element("div", "card"):
        _to_form(shared, main, command, command, False)
        text("p", words)
        with element("div", "links"):
            _to_form(shared, main, command, "open the form", False, aria_label=f"open the form of {command}")
            _to_form(shared, main, command, "try the sample", True, aria_label=f"try the sample of {command}")


def _to_form(shared: Shared, main: Element, command: str, words: str, sampled: bool, **attributes: str) -> None:
    """A link to a form, which takes the place of what is on the page: loading all anew takes three times as long."""
    address = f"/form/{command.replace(' ', '.')}{'?sample=1' if sampled else ''}"

    def show() -> None:
        main.clear()
        with main:
            form_page(shared, command, sampled)
            ui.run_javascript(f"arrive(...{json.dumps([address, _titled(command)])})")

    made = link(words, address, **attributes)
    made.on("click", show, js_handler="(e) => { if (plain(e)) { e.preventDefault(); emit(); } }")


def _recent(queue: Queue) -> None:
    done = [page for run in reversed(queue.runs) for page in run.pages.items()][:MOST_RECENT]
    if not done:
        text("p", "None yet.")
    with element("ul"):
        for name, address in done:
            with element("li"):
                link(name, address, target="_blank")


def _run_before(queue: Queue, command: str) -> None:
    """Run the sample whose results another one reads, unless they are there or on their way."""
    out = samples.results_of(command, queue.folder)
    if (out / RECORD).is_file() or any(run.out == out and not run.over for run in queue.runs):
        return
    words = Form.of_words(samples.sample(command, queue.folder).words).words(out)
    queue.add(words, out, f"{command}, whose results the sample reads")
