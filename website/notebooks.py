"""Run the staged notebooks, each in a folder of its own beside the shipped samples, and keep what they show."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from website.stage import ROOT


def execute(sources: Path) -> None:
    """Fill in the outputs; a cell that fails ends it. Real data are left out: the site shows what everybody gets."""
    import nbformat
    from nbclient import NotebookClient

    for file in sorted((sources / "notebooks").glob("*.ipynb")):
        book = nbformat.read(file, as_version=4)
        with TemporaryDirectory() as folder:
            (Path(folder) / "meshes").symlink_to(ROOT / "meshes", target_is_directory=True)
            NotebookClient(book, timeout=900, resources={"metadata": {"path": folder}}).execute()
        nbformat.write(book, file)
