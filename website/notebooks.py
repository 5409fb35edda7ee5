"""Run notebooks, each in a folder of its own beside the shipped samples, and keep what they show.

    python -m website.notebooks                 # all of the repository, with their outputs
    python -m website.notebooks mat knee        # these

Real data are left out: a notebook shows what everybody gets. Pages that are live while it runs are kept as pictures,
which needs chromium and playwright. The site (`python -m website --execute`) has them live.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from traitlets.config import Config

from website.kept_outputs import kept, plain
from website.stage import ROOT

NOTEBOOKS = ROOT / "notebooks"
SCREEN = (1280, 800)
PATIENCE = 3600
"""s for a cell; a minute of processor time is a quarter of an hour on a busy machine."""


def kernel(folder: str) -> Config:
    """A kernel that talks to this process alone, not over the network.

    Its sockets are in `folder`, named in full, since it runs in another one.
    """
    sockets = {"transport": "ipc", "ip": str(Path(folder).resolve() / "kernel")}
    return Config({} if os.name == "nt" else {"KernelManager": sockets})


def describe(cells: list[Any]) -> None:
    """Figures get words for those who do not see them: the beginning of the text above."""
    above = ""
    for cell in cells:
        if cell["cell_type"] == "markdown":
            above = re.split(r"(?<=[.:?])\s|\n", cell["source"].lstrip("# \n"))[0].replace("`", "").rstrip(".:")
        elif any("image/png" in output.get("data", ()) for output in cell["outputs"]):
            cell["metadata"].setdefault("mystnb", {})["image"] = {"alt": f"Figure: {above}"}


def executed(file: Path) -> tuple[Any, str]:
    """The notebook with its outputs, and the folder that it ran in, which is gone; a cell that fails ends it."""
    import nbformat
    from nbclient import NotebookClient

    book = nbformat.read(file, as_version=4)
    with TemporaryDirectory() as folder, TemporaryDirectory() as sockets:
        (Path(folder) / "meshes").symlink_to(ROOT / "meshes", target_is_directory=True)
        where = {"metadata": {"path": folder}}
        config = kernel(sockets)
        NotebookClient(book, timeout=PATIENCE, resources=where, config=config, record_timing=False).execute()
    return book, folder


def execute(sources: Path) -> None:
    """Fill in the outputs of the staged notebooks, pages live."""
    import nbformat

    for file in sorted((sources / "notebooks").glob("*.ipynb")):
        book, folder = executed(file)
        for output in (one for cell in book.cells for one in cell.get("outputs", ())):
            if output.get("name") == "stderr":
                output["text"] = plain(output["text"], folder)
        describe(book.cells)
        nbformat.write(book, file)


def keep(file: Path, photograph: Callable[[Path, str], bytes]) -> None:
    """Run one notebook of the repository and write it with what is kept of its outputs."""
    import nbformat

    def pictured(page: str) -> bytes:
        with TemporaryDirectory() as place:
            shown = Path(place) / "page.html"
            shown.write_text(page, encoding="utf-8")
            return photograph(shown, "light")

    book, folder = executed(file)
    kept(book, folder, pictured)
    describe(book.cells)
    nbformat.write(book, file)


def main(words: list[str]) -> int:
    """Exit code: 0 when all were run and written."""
    from benchmarks.page_pictures.shots import browser_page

    parser = argparse.ArgumentParser(
        prog="python -m website.notebooks", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    names = sorted(file.stem for file in NOTEBOOKS.glob("*.ipynb"))
    parser.add_argument("names", nargs="*", default=names, metavar="NAME", help=", ".join(names))
    given = parser.parse_args(words)
    if unknown := set(given.names) - set(names):
        parser.error(f"no notebook {', '.join(sorted(unknown))}; there are {', '.join(names)}")
    os.environ["GEOCONTACT_DATA"] = str(NOTEBOOKS / "none")
    for name in given.names:
        file = NOTEBOOKS / f"{name}.ipynb"
        with browser_page(SCREEN) as photograph:
            keep(file, photograph)
        sys.stdout.write(f"{name}: {file.stat().st_size / 1e3:.0f} kB\n")
        sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
