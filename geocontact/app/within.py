"""What is within the threshold of a filled form, at the first frame: areas and levels of vertices for the picture.

It runs in the process of `faces`, which keeps the last bodies with their distances: another threshold is quick.
"""

from __future__ import annotations

from base64 import b64encode
from dataclasses import replace
from hashlib import sha256
from importlib import import_module
from pathlib import Path
from typing import Any

from cyclopts import CycloptsError

from geocontact.analyses.catalogue import entry_of
from geocontact.analyses.frame.collector import collecting
from geocontact.analyses.frame.options import Options
from geocontact.analyses.frame.record import Record
from geocontact.app import calls
from geocontact.app.fields import Form
from geocontact.app.files import Known, known_file
from geocontact.cli.command import command_of
from geocontact.data.errors import InputError
from geocontact.view.page.write import page_html

REACH = 0.02
"""Distances are measured this far [m], so that thresholds to there need no others; farther where one is larger."""
AS_STORED = Path(__file__).with_name("as_stored.csv")
"""A motion of one frame that leaves the bodies where their files have them."""
MOTION, SIDE = "motion", "side"

_last: list[tuple[Options, str, tuple[Known | None, ...], Any, str]] = []
"""Options, folder and files of the bodies that are kept, these, and their page."""


def answer(asked: dict[str, Any]) -> dict[str, Any]:
    """Areas, their frame and bodies, the page of these, and levels of vertices for the last threshold: as `Found`.

    `asked` has the analysis (`command`), its form (`filled`), the unit that is chosen and the folder for the page.
    """
    form = Form.of_kept(asked["command"], asked["filled"])
    stored = not _moves(form)
    if stored:
        form.values[MOTION] = str(AS_STORED)
    try:
        options = calls.read(form.words("-"), form.command)
        thresholds = tuple(options.threshold)  # type: ignore[attr-defined]
        with command_of(entry_of(form.command)).respelling():
            wide = replace(options, threshold=(max(REACH, *thresholds),))  # type: ignore[call-arg]
            frame, page = _bodies(wide, asked["folder"])
            areas = frame.words(thresholds, asked["unit"])
    except (CycloptsError, InputError, OSError) as error:
        return {"said": f"not shown: {calls.complaint(error)}"}
    when = "as stored, since no motion is filled in" if stored else frame.when
    levels = [b64encode(each.tobytes()).decode("ascii") for each in frame.levels(thresholds[-1])]
    about = f"{when}: {frame.who}"
    return {
        "said": "\n".join(areas),
        "marked": {"within": levels},
        "about": about,
        "page": page,
        "thresholds": thresholds,
    }


def _moves(form: Form) -> bool:
    """Whether the form says how the bodies move, or has no field for it; the side of the body says what is medial."""
    motion = next((one for one in form.fields if one.name == MOTION), None)
    return motion is None or any(
        form.value(one) for one in form.fields if one.one.section == motion.one.section and one.name != SIDE
    )


def _bodies(options: Options, folder: str) -> tuple[Any, str]:
    """The bodies at the first frame and their page; those of before where options and files are as they were."""
    for kept, at, files, frame, page in _last:
        if kept == options and at == folder and all(each and known_file(each[0]) == each for each in files):
            return frame, page
    _last.clear()
    record = Record("", {})
    with collecting(record):
        frame = import_module(options.first_frame).first_frame(options)
    page = _written(page_html(frame.page()), Path(folder))
    read = dict.fromkeys([*(Path(str(each["file"])) for each in record.inputs), Path(page)])
    _last.append((options, folder, tuple(map(known_file, read)), frame, page))
    return frame, page


def _written(page: str, folder: Path) -> str:
    """Path of a page, which no other page has."""
    data = page.encode("utf-8", errors="replace")
    file = folder / f"threshold_{sha256(data).hexdigest()[:16]}.html"
    if not file.exists():
        folder.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)
    return str(file)
