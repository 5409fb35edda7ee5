"""Every file that a user names is opened by `io.text.file_preflight`; who opens one without it stands here with why."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2] / "geocontact"
OPENING = {"open", "read_text", "read_csv", "read_excel", "read_parquet", "read_schema", "ParquetFile", "c3d"}
OWN = "files of the package itself"
WRITTEN = "files that the same run wrote, or is writing"
APART = "a file that was looked at before, in a process of its own"
WITHOUT = {
    "io/text/file_preflight.py": "the preflight",
    "io/text/plain_table.py": "a workbook that was looked at before",
    "io/text/unpacked.py": "parts of an open archive",
    "io/mocap/c3d_analogs.py": APART,
    "io/mocap/c3d_events.py": APART,
    "io/mocap/c3d_markers.py": APART,
    "io/mocap/c3d_plates.py": APART,
    "io/mocap/segment_poses.py": APART,
    "io/mesh/step.py": APART,
    "analyses/area/distance_file.py": "arrays of an open file",
    "analyses/frame/folder.py": "digest of a file that was read",
    "analyses/frame/pages.py": WRITTEN,
    "analyses/frame/result.py": WRITTEN,
    "analyses/frame/source_digest.py": OWN,
    "analyses/frame/table_forms.py": WRITTEN,
    "analyses/gap/benchmark/case.py": "adds to a file that was read",
    "app/pages.py": "style and script of the package, and a file that is being dropped",
    "app/samples.py": OWN,
    "app/server.py": "a page that the server wrote, for the browser",
    "data/stub_names.py": OWN,
    "dynamics/code_cache.py": OWN,
    "dynamics/compiled.py": WRITTEN,
    "dynamics/rosenbrock.py": OWN,
    "geometry/kernels/compile.py": OWN,
    "io/opensim/muscle_paths.py": WRITTEN,
    "io/recordings/pose_draws.py": "arrays of an open file",
    "io/text/results.py": "a table of text that was read",
    "study/code_version.py": OWN,
    "study/collect.py": WRITTEN,
    "study/curves.py": WRITTEN,
    "study/limits.py": WRITTEN,
    "study/store.py": WRITTEN,
    "view/page/write.py": OWN,
    "view/surfaces/render.py": WRITTEN,
    "view/surfaces/still.py": WRITTEN,
    "view/surfaces/window.py": WRITTEN,
    "cli/view.py": "a page, for the browser",
}


def openings(source: str) -> Iterator[int]:
    """Lines that open a file: `open`, `x.open`, `x.read_text`, `x.read_bytes()`, `np.load`, `pd.read_csv` and so on."""
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Call):
            continue
        if isinstance(node.func, ast.Name) and node.func.id == "open":
            yield node.lineno
        elif isinstance(node.func, ast.Attribute):
            bare = node.func.attr == "read_bytes" and not node.args
            array = node.func.attr == "load" and ast.unparse(node.func.value) == "np"
            if bare or array or node.func.attr in OPENING:
                yield node.lineno


def test_files_are_opened_by_the_preflight() -> None:
    found = {
        file.relative_to(ROOT).as_posix() for file in ROOT.rglob("*.py") if list(openings(file.read_text("utf-8")))
    }
    assert found - set(WITHOUT) == set(), "use `open_file`, `open_text`, `read_bytes` or `read_json` of file_preflight"
    assert set(WITHOUT) - found == set(), "these open no file any more"


def test_an_opening_is_seen() -> None:
    source = "open(a)\nPath(a).open()\nb.read_text()\nc.read_bytes()\nnp.load(d)\npd.read_csv(e)\n"
    assert list(openings(source)) == [1, 2, 3, 4, 5, 6]
    assert not list(openings("open_file(a)\nread_bytes(b)\njson.load(c)\n"))
