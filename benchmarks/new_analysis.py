"""What a new analysis touches: a small one, lengths of the edges of a mesh, is added to a copy of a checkout.

    python -m benchmarks.new_analysis FOLDER        # a copy of this checkout with the analysis in it

`benchmarks.house` counts its files, `tests/benchmarks/test_new_analysis.py` runs it by every door. Its name alone
stands in a file where the lines that are added have no word but its names and those of the list that they stand in.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from benchmarks.machine import ROOT

HOME = "geocontact/analyses/edges"
CATALOGUE = "geocontact/analyses/catalogue.py"
STUB = "geocontact/__init__.pyi"
COPIED = ("geocontact", "benchmarks/same_outputs", "benchmarks/page_pictures", "website", "meshes/sphere_r20.stl")
ALONE = ("pyproject.toml", "cli.py", "benchmarks/__init__.py", "benchmarks/machine.py", "meshes/leg_files.py")
NAMES = {"edges", "EdgeOptions", "edge_lengths"}
OF_THE_LIST = {"Entry", "result", "from", "import", "geocontact", "analyses"}

NEW = {
    f"{HOME}/__init__.py": '''"""Lengths of the edges of a mesh."""
''',
    f"{HOME}/options.py": '''"""What lengths of edges may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import ClassVar

from geocontact.analyses.frame.marks import MeshUnit
from geocontact.analyses.frame.options import Options


@dataclass(frozen=True)
class EdgeOptions(Options):
    """Lengths of the edges of a mesh.

    Parameters
    ----------
    mesh
        Mesh file (.stl, .ply, .obj, .vtp).
    unit
        Unit of its numbers.
    """

    writes: ClassVar[str] = """
    Writes edges.csv, edges.png, edges.svg, report.html and run.json into OUT.
    """

    mesh: Path
    _: KW_ONLY
    unit: MeshUnit
''',
    f"{HOME}/show.py": '''"""Lengths of edges, drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def edges_figure(lengths: Float[np.ndarray, " n"]) -> Figure:
    """Lengths [m] in order of their size [mm]."""
    from matplotlib.figure import Figure

    figure = Figure()
    figure.subplots().plot(1e3 * np.sort(lengths))
    return figure
''',
    f"{HOME}/result.py": '''"""Lengths of the edges of a mesh: `geocontact edges`, `gc.edge_lengths`.

>>> import geocontact as gc
>>> gc.edge_lengths("meshes/sphere_r20.stl", unit="mm")
4320 edges, 2 mm on average
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.edges.options import EdgeOptions
from geocontact.analyses.edges.show import edges_figure
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.result import Result
from geocontact.analyses.frame.collector import add_input, say
from geocontact.data.mesh import Mesh
from geocontact.io.mesh.meshes import read_mesh

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class EdgeResult(Result):
    """Lengths [m]."""

    lengths: Float[np.ndarray, " n"]

    def tables(self) -> dict[str, pd.DataFrame]:
        """`edges` [mm]."""
        return {"edges": pd.DataFrame({"length [mm]": 1e3 * self.lengths})}

    def figures(self) -> dict[str, Figure]:
        """Lengths in order of their size."""
        return {"edges": edges_figure(self.lengths)}


def read(o: EdgeOptions) -> Mesh:
    """The mesh."""
    mesh = read_mesh(o.mesh, o.unit)
    add_input("mesh", o.mesh, sha256=mesh.sha256, unit=o.unit)
    return mesh


def run(mesh: Mesh, o: EdgeOptions) -> EdgeResult:
    """Every edge once."""
    pairs = mesh.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    ends = mesh.vertices[np.unique(np.sort(pairs, axis=1), axis=0)]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    say(f"{len(lengths)} edges, {1e3 * np.mean(lengths):.2g} mm on average")
    return EdgeResult(lengths=lengths)


edge_lengths = Job("edges", EdgeOptions, read, run)
''',
    "tests/analyses/test_edges.py": '''"""Lengths of edges, by hand."""

from __future__ import annotations

from math import pi

import pytest

import geocontact as gc


def test_edges_of_a_sphere_are_as_long_as_its_faces_say() -> None:
    """2880 almost equilateral triangles share its area."""
    found = gc.edge_lengths("meshes/sphere_r20.stl", unit="mm")
    side = (4.0 * pi * 0.02**2 / 2880 * 4.0 / 3.0**0.5) ** 0.5
    assert len(found.lengths) == 4320 and found.lengths.mean() == pytest.approx(side, rel=0.1)
''',
}
"""Files of its own."""

ADDED = {
    CATALOGUE: ('    Entry("fit", ', '    Entry("edges", "edges", "EdgeOptions", "result:edge_lengths"),\n'),
    "benchmarks/same_outputs/runs.txt": ("fit_cylinder: ", "edges: edges inputs/meshes/sphere_r20.stl --unit mm\n"),
    "docs/reference/written_files.md": ("- `cop`", "- `edges`\n  - `edges.csv`: `length [mm]`\n"),
    "README.md": (
        "| Find joint centres",
        "| edges | `edges` | `gc.edge_lengths` | [meshes](docs/how-to/my_implant.md) |\n",
    ),
}
"""Line of a file of all analyses, before the one that begins so."""


@dataclass(frozen=True)
class Touched:
    """Files of a new analysis: those written by hand, those of them with nothing but its name, those of a script."""

    by_hand: tuple[str, ...]
    name_alone: tuple[str, ...]
    by_script: tuple[str, ...]


def touched(root: Path = ROOT) -> Touched | None:
    """Files that the small analysis needs in a checkout; None for one that has no single list of analyses."""
    catalogue = root / CATALOGUE
    if not catalogue.is_file() or "ENTRIES" not in catalogue.read_text(encoding="utf-8"):
        return None
    lines = {name: line for name, (_, line) in ADDED.items()}
    alone = [name for name, text in (NEW | lines).items() if name_alone(text)]
    return Touched((*NEW, *ADDED), tuple(alone), (STUB,))


def name_alone(text: str) -> bool:
    """Whether lines hold nothing but the analysis's names, and words of the list that they stand in."""
    return set(re.findall(r"\w+", text)) <= NAMES | OF_THE_LIST


def added(folder: Path, root: Path = ROOT, without: str = "") -> None:
    """Fill a folder with a copy of what analyses need of a checkout, and the small one, one of its files left out."""
    ignored = shutil.ignore_patterns("__pycache__")
    for name in COPIED:
        copy = shutil.copytree if (root / name).is_dir() else shutil.copyfile
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        copy(root / name, folder / name, **({"ignore": ignored} if copy is shutil.copytree else {}))
    for name in (*ALONE, *ADDED):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(root / name, folder / name)
    for name, text in NEW.items():
        if name != without:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text, encoding="utf-8")
    for name, (before, line) in ADDED.items():
        if name != without:
            insert(folder / name, before, line)
    if without != STUB:
        subprocess.run([sys.executable, "-m", "website.stubs"], cwd=folder, env=environment(folder), check=True)


def insert(file: Path, before: str, line: str) -> None:
    """Add a line to a file, before the first one that begins so; ValueError where there is none."""
    text = file.read_text(encoding="utf-8")
    at = text.index(f"\n{before}") + 1
    file.write_text(text[:at] + line + text[at:], encoding="utf-8")


def environment(folder: Path) -> Mapping[str, str]:
    """Environment of a child process that takes the package from a folder."""
    return os.environ | {"PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}


def main() -> int:
    """Exit code 0; prints what is touched."""
    folder = Path(sys.argv[1])
    added(folder)
    found = touched()
    if found is not None:
        sys.stdout.write(
            "\n".join([*found.by_hand, *(f"{name} (written by a script)" for name in found.by_script), ""])
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
