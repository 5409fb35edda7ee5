"""Run the staged notebooks, each in a folder of its own beside the shipped samples, and keep what they show."""

from __future__ import annotations

import os
import re
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from traitlets.config import Config

from website.stage import ROOT

WARNING = re.compile(r"^\S*ipykernel_\d+\S*: (\w+: .*)\n(?:  .*\n)?", re.MULTILINE)
"""As Python tells it: the kernel's file and line, what is meant, the line of the cell."""


def plain(warnings: str, folder: str) -> str:
    """Warnings without the places where they were told, which are elsewhere each time."""
    return WARNING.sub(r"\1\n", warnings).replace(f"{folder}{os.sep}", "")


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


def execute(sources: Path) -> None:
    """Fill in the outputs; a cell that fails ends it. Real data are left out: the site shows what everybody gets."""
    import nbformat
    from nbclient import NotebookClient

    for file in sorted((sources / "notebooks").glob("*.ipynb")):
        book = nbformat.read(file, as_version=4)
        with TemporaryDirectory() as folder, TemporaryDirectory() as sockets:
            (Path(folder) / "meshes").symlink_to(ROOT / "meshes", target_is_directory=True)
            told = {"metadata": {"path": folder}}
            NotebookClient(book, timeout=900, resources=told, config=kernel(sockets)).execute()
            for output in (one for cell in book.cells for one in cell.get("outputs", ())):
                if output.get("name") == "stderr":
                    output["text"] = plain(output["text"], folder)
        describe(book.cells)
        nbformat.write(book, file)
