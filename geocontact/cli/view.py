"""`geocontact view DIR`: open the page of a result."""

from __future__ import annotations

import webbrowser
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.frame.options import declared
from geocontact.cli.command import respelled, speller
from geocontact.data.errors import InputError

PAGE = "report.html"


def view(result: Path, *, window: Annotated[bool, Parameter(negative="")] = False) -> int:
    """Open the page of a result in the browser.

    Parameters
    ----------
    result
        Folder that an analysis wrote, or the page itself.
    window
        Open a 3-D window with a time slider instead; the analysis must have been run with --save-map.
    """
    if window:
        from geocontact.analyses.area.distance_file import read_series
        from geocontact.view.surfaces.window import show_window

        try:
            series = read_series(result)
        except InputError as error:
            raise respelled(error, speller(declared(AreaOptions))) from error
        show_window(series)
        return 0
    page = page_of(result).resolve()
    print(page)
    if not webbrowser.open(page.as_uri()):
        print("no browser could be started here; open the file named above")
    return 0


def page_of(result: Path) -> Path:
    """The one page that a path stands for."""
    if result.is_file() and result.suffix.lower() in (".html", ".htm"):
        return result
    if not result.is_dir():
        raise InputError(result, "", "is neither a folder of results nor a page", "name the --out of an analysis")
    if (result / PAGE).is_file():
        return result / PAGE
    inside = sorted(folder for folder in result.iterdir() if (folder / PAGE).is_file())
    if len(inside) == 1:
        return inside[0] / PAGE
    if inside:
        names = ", ".join(folder.name for folder in inside)
        raise InputError(result, "", f"holds {len(inside)} results: {names}", "name one of these folders")
    raise InputError(result, "", f"holds no {PAGE}", "name the --out of an analysis")
