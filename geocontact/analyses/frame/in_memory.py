"""Tables, arrays and meshes of a Python session where an analysis asks for a file.

They are written into a folder of their own, exactly (every digit of a number stays), read from there like any file, and
named in messages and in `run.json` by the argument and what it is. The folder goes with the result.
"""

from __future__ import annotations

import shutil
import tempfile
import weakref
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from os import fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geocontact.data.errors import InputError

if TYPE_CHECKING:  # whoever passes such a value has imported its library; nobody else needs it
    import numpy as np
    import pandas as pd

POSES = ("motion", "motion_fixed")
"""Options whose arrays are poses."""
MATRICES = ((16,), (12,), (4, 4), (3, 4))
"""Shapes of one frame in such an array."""
MATRICES_OR_TABLE = (
    "give 4 x 4 matrices (frames x 4 x 4, or 16 or 12 numbers in a row), or a DataFrame with the columns "
    "time [s], tx [mm], ty [mm], tz [mm], qw, qx, qy, qz"
)
METRES = "m"


@dataclass(frozen=True)
class Written:
    """What a value became: the ending of its file, what writes it, and what it is in words."""

    suffix: str
    write: Callable[[Path], object]
    words: str


@dataclass
class InMemory:
    """Files that stand for values of one call.

    Parameters
    ----------
    words
        What stands in messages and records in place of each file: "`motion` (DataFrame, 101 x 8)".
    """

    words: dict[str, str] = field(default_factory=dict)
    _folder: Path | None = None

    def replaced(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Arguments of a call, with the path of a file for every value that an analysis reads from a file.

        Parameters
        ----------
        values
            Arguments by name. Numbers of a geocontact surface are in metres, so that its unit has to be "m": that of
            its own (`unit_moving` of `moving`, `body_unit` of `body`) where there is one, else `unit`.

        Raises
        ------
        InputError
            A value of a kind that is read from files, which holds nothing that could be written.
        """
        found = {}
        for name, value in values.items():
            own = next((key for key in (f"unit_{name}", f"{name}_unit") if values.get(key) is not None), "unit")
            found[name] = self._one(name, value, own, values.get(own))
        return found

    def spelled(self, text: str) -> str:
        """A text in which the words stand for the files."""
        for file, words in self.words.items():
            text = text.replace(file, words)
        return text

    def plain(self, value: Any) -> Any:
        """An option's value as a record shows it."""
        if isinstance(value, (tuple, list)):
            return [self.plain(each) for each in value]
        return self.words.get(str(value), value) if isinstance(value, (str, Path)) else value

    def _one(self, name: str, value: Any, own: str, unit: object) -> Any:
        """A value, or the file it is written to; `own` is the argument that has its `unit`."""
        if isinstance(value, (tuple, list)):
            return type(value)(self._one(name, each, own, unit) for each in value)
        if name in POSES and isinstance(value, (int, float)):
            raise InputError("", f"`{name}`", "is a number", MATRICES_OR_TABLE)
        made = _written(name, value, own, unit)
        if made is None:
            return value
        if self._folder is None:
            self._folder = Path(tempfile.mkdtemp(prefix="geocontact-"))
            weakref.finalize(self, shutil.rmtree, self._folder, ignore_errors=True)
        count = sum(Path(file).stem.rstrip("0123456789") == name for file in self.words)
        file = self._folder / f"{name}{count + 1 if count else ''}{made.suffix}"
        made.write(file)
        self.words[fspath(file)] = f"`{name}` ({made.words})"
        return fspath(file)


def _written(name: str, value: Any, own: str, unit: object) -> Written | None:
    """How a value is written; None for one that is no table, array or mesh."""
    kinds = {(each.__module__.partition(".")[0], each.__name__) for each in type(value).__mro__}
    if ("pandas", "DataFrame") in kinds:
        return _frame(value)
    if ("numpy", "ndarray") in kinds:
        return _array(name, value)
    if ("geocontact", "Motion") in kinds:
        return _motion(value)
    if ("geocontact", "Surface") in kinds or ("geocontact", "Mesh") in kinds:
        if unit != METRES:
            raise InputError("", f"`{name}`", "is a surface of geocontact, whose numbers are metres", f'give {own}="m"')
        return _mesh(name, value.vertices, value.faces, type(value).__name__)
    if ("trimesh", "Trimesh") in kinds:
        return _mesh(name, value.vertices, value.faces, "Trimesh")
    if ("trimesh", "Scene") in kinds:
        whole = value.to_mesh()
        return _mesh(name, whole.vertices, whole.faces, "Scene")
    if ("pyvista", "DataSet") in kinds:
        cells = (value if ("pyvista", "PolyData") in kinds else value.extract_surface(algorithm=None)).triangulate()
        return _mesh(name, cells.points, cells.faces.reshape(-1, 4)[:, 1:], type(value).__name__)
    if ("open3d", "TriangleMesh") in kinds:
        return _mesh(name, value.vertices, value.triangles, "TriangleMesh")
    return None


def _frame(table: pd.DataFrame) -> Written:
    named = [name for name in table.index.names if name is not None]
    whole = table.reset_index(named) if named else table

    def write(file: Path) -> None:
        whole.to_csv(file, index=False, encoding="utf-8")

    return Written(".csv", write, f"DataFrame, {len(whole)} x {len(whole.columns)}")


def _array(name: str, array: np.ndarray) -> Written | None:
    """Rows of numbers, as a text file of poses or points has them; names of a structured array are its columns."""
    import numpy as np
    import pandas as pd

    if array.dtype.names is None and name in POSES:
        _require_matrices(name, array)
    if array.ndim == 0 or (array.ndim == 1 and array.dtype.names is None):
        return None  # values of an option, not a file
    if array.dtype.names is not None:
        return _frame(pd.DataFrame(array))
    if not np.issubdtype(array.dtype, np.number) or np.iscomplexobj(array):
        raise InputError("", f"`{name}`", f"is an array of {array.dtype}", "give numbers, or a DataFrame")
    rows = array.reshape(len(array), -1)
    return Written(".txt", lambda file: _rows(file, rows.tolist()), f"array, {' x '.join(map(str, array.shape))}")


def _require_matrices(name: str, array: np.ndarray) -> None:
    """InputError unless an array without names of columns holds the numbers of matrices, one frame in a row."""
    if array.size and array.shape[1:] in MATRICES:
        return
    shape = " x ".join(map(str, array.shape)) or "one number"
    raise InputError("", f"`{name}`", f"is an array of {shape}", MATRICES_OR_TABLE)


def _motion(motion: Any) -> Written:
    import numpy as np
    import pandas as pd

    columns = [*(f"t{axis} [{METRES}]" for axis in "xyz"), "qx", "qy", "qz", "qw"]
    values = np.hstack([motion.poses.translation, motion.poses.rotation.as_quat()])
    table = pd.DataFrame(values, columns=columns)
    table.insert(0, f"time [{motion.time_unit}]", motion.time)
    return Written(".csv", _frame(table).write, f"Motion, {len(motion)} frames")


def _mesh(name: str, vertices: Any, faces: Any, kind: str) -> Written:
    """Binary PLY of doubles, which holds every digit."""
    import numpy as np

    points, corners = np.asarray(vertices, "<f8"), np.asarray(faces, "<i4")
    if len(points) == 0 or corners.ndim != 2 or len(corners) == 0:
        raise InputError("", f"`{name}`", f"is a {kind} without triangles", "give a surface of triangles")
    cells = np.zeros(len(corners), dtype=[("count", "u1"), ("corner", "<i4", 3)])
    cells["count"], cells["corner"] = 3, corners
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(corners)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    data = header.encode("ascii") + points.tobytes() + cells.tobytes()
    return Written(".ply", lambda file: file.write_bytes(data), f"{kind}, {len(points)} points, {len(corners)} faces")


def _rows(file: Path, rows: Iterable[Iterable[float]]) -> None:
    file.write_text("".join(" ".join(map(repr, row)) + "\n" for row in rows), encoding="utf-8")
