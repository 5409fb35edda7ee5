"""`geocontact view`: open the page of a result, or make and open that of a surface."""

from __future__ import annotations

import webbrowser
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.frame.options import declared
from geocontact.cli.command import respelled, speller
from geocontact.cli.show import Terminal
from geocontact.data.errors import InputError

PAGE = "report.html"


def view(
    result: Path,
    *,
    window: Annotated[bool, Parameter(negative="")] = False,
    unit: Literal["m", "cm", "mm", "in"] | None = None,
    out: Path | None = None,
    landmarks: Path | None = None,
) -> int:
    """Open the page of a result in the browser, or the page of a surface on which landmarks are picked.

    Parameters
    ----------
    result
        Folder that an analysis wrote, or the page itself; or a mesh (.stl .ply .obj .off .vtp .step), with --unit.
    window
        Open a 3-D window with a time slider instead; the analysis must have been run with --save-map.
    unit
        Unit of the mesh; never guessed.
    out
        Page to write for a mesh: NAME_surface.html in this folder by default.
    landmarks
        Landmarks that stand on the mesh, to be corrected: a file that such a page saved, or id, x [mm], y [mm], z [mm].
    """
    from geocontact.analyses.frame.surface_page import is_surface  # with numpy: not for --help

    if is_surface(result):
        page = _of_surface(result, window, unit, out, landmarks)
    elif result.exists() and (unit is not None or out is not None or landmarks is not None):
        name = "--unit" if unit is not None else "--out" if out is not None else "--landmarks"
        raise InputError("", name, f"is for a mesh, and {result} is none", "leave it out")
    elif window:
        from geocontact.analyses.area.distance_file import read_series
        from geocontact.view.surfaces.window import show_window

        try:
            series = read_series(result)
        except InputError as error:
            raise respelled(error, speller(declared(AreaOptions))) from error
        show_window(series)
        return 0
    else:
        page = page_of(result)
    page = page.resolve()
    print(page)
    if not webbrowser.open(page.as_uri()):
        print("no browser could be started here; open the file named above")
    return 0


def _of_surface(mesh: Path, window: bool, unit: str | None, out: Path | None, landmarks: Path | None) -> Path:
    """The page of a mesh, written."""
    from geocontact.analyses.frame.collector import collecting
    from geocontact.analyses.frame.record import Record
    from geocontact.analyses.frame.surface_page import write_surface_page

    if window:
        raise InputError("", "--window", "shows results, not a mesh", "leave it out")
    if unit is None:
        raise InputError("", "--unit", f"is missing: {mesh} carries no unit", "pass --unit mm, cm, m or in")
    spell = speller(declared(AreaOptions))
    try:
        with collecting(Record("view", {}, listener=Terminal(), spell=spell)):
            return write_surface_page(mesh, unit, out, landmarks)
    except InputError as error:
        raise respelled(error, spell) from error


def page_of(result: Path) -> Path:
    """The one page that a path stands for."""
    if result.is_file() and result.suffix.lower() in (".html", ".htm"):
        return result
    if not result.is_dir():
        what = "is neither a folder of results nor a page" if result.exists() else "there is no such file or folder"
        raise InputError(result, "", what, "name the --out of an analysis, or a mesh with its --unit")
    if (result / PAGE).is_file():
        return result / PAGE
    inside = sorted(folder for folder in result.iterdir() if (folder / PAGE).is_file())
    if len(inside) == 1:
        return inside[0] / PAGE
    if inside:
        names = ", ".join(folder.name for folder in inside)
        raise InputError(result, "", f"holds {len(inside)} results: {names}", "name one of these folders")
    raise InputError(result, "", f"holds no {PAGE}", "name the --out of an analysis")
