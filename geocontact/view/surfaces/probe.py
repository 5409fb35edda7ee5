"""Whether this machine renders in 3-D without a screen; asked in a child process, once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec

from geocontact.view.surfaces import child

PROGRAM = """
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(64, 64))
plotter.add_mesh(pyvista.Sphere())
assert plotter.screenshot(return_img=True).std() > 0, "the rendered picture is blank"
"""
INSTALL = "pip install 'geocontact[view]'"
REMEDY = f"{INSTALL}, and apt-get install libegl1 libgl1 (Debian, Ubuntu)"
PATIENCE = 20.0  # s; the first import after installing reads a few hundred megabytes


@dataclass(frozen=True)
class Probe:
    """Answer of a probe; `reason` says in a few words why not, and is empty when it works."""

    ok: bool
    reason: str = ""


@cache
def off_screen_works() -> Probe:
    """Render a small scene in a child process; the answer is kept for the life of this process.

    A crash of the child (segmentation fault without libegl1 and libgl1 on a bare Debian), an exception, a blank picture
    and no answer within `PATIENCE` all mean no.
    """
    if find_spec("pyvista") is None:
        return Probe(ok=False, reason="pyvista is not installed")
    trouble = child.outcome(child.start(PROGRAM), PATIENCE)
    return Probe(ok=not trouble, reason=trouble)
