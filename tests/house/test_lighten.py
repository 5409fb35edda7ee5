"""What `make demo` removes from its environment: tests of packages and what serves to build against them, no more."""

from __future__ import annotations

import importlib.util
from pathlib import Path, PurePosixPath

import pytest

ROOT = Path(__file__).resolve().parents[2]
SPEC = importlib.util.spec_from_file_location("lighten", ROOT / ".ci" / "lighten.py")
assert SPEC is not None
assert SPEC.loader is not None
lighten = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(lighten)

REMOVED = ("pandas/tests/io/test_csv.py", "scipy/linalg/tests/data/a.npz", "lib64/libembree4.a", "include/Eigen/Core")
STAYS = (
    "pandas/testing.py",
    "tests.py",
    "tests/__init__.py",
    "numpy/testing/__init__.py",
    "igl/pyigl.so",
    "../../bin/f2py",
)


@pytest.mark.parametrize("name", REMOVED)
def test_it_goes(name: str) -> None:
    assert lighten.unread(PurePosixPath(name))


@pytest.mark.parametrize("name", STAYS)
def test_it_stays(name: str) -> None:
    """A package may be called `tests`, and what lies outside of the packages is not theirs alone."""
    assert not lighten.unread(PurePosixPath(name))


def test_only_listed_files_go_and_empty_folders_with_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    site, info = tmp_path / "site", tmp_path / "site" / "one-1.0.dist-info"
    for name in ("one/__init__.py", "one/tests/deep/test_a.py", "one/tests/own.txt", "one/sub/tests/test_b.py"):
        (site / name).parent.mkdir(parents=True, exist_ok=True)
        (site / name).write_text("x\n", encoding="utf-8")
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: one\nVersion: 1.0\n", encoding="utf-8")
    listed = ("one/__init__.py", "one/tests/deep/test_a.py", "one/sub/tests/test_b.py", "one-1.0.dist-info/METADATA")
    (info / "RECORD").write_text("".join(f"{name},,\n" for name in listed), encoding="utf-8")
    monkeypatch.setattr(lighten.sys, "prefix", str(tmp_path))
    monkeypatch.setattr(lighten, "distributions", lambda: lighten.Distribution.discover(path=[str(site)]))
    lighten.main()
    left = {file.relative_to(site).as_posix() for file in site.rglob("*") if info not in (file, *file.parents)}
    assert left == {"one", "one/__init__.py", "one/tests", "one/tests/own.txt"}
