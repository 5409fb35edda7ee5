"""TOML files with paths of Windows in them."""

from __future__ import annotations

from pathlib import Path, PureWindowsPath

import pytest

from geocontact.data.errors import InputError
from geocontact.io.text.toml_text import toml_of


def read(tmp_path: Path, text: str) -> dict[str, object]:
    file = tmp_path / "study.toml"
    file.write_text(text, encoding="utf-8")
    return toml_of(file, 1000)


@pytest.mark.parametrize("written", [r"'C:\temp\new.stl'", r'"C:\\temp\\new.stl"', '"C:/temp/new.stl"'])
def test_paths_of_windows_are_read_as_they_are_meant(tmp_path: Path, written: str) -> None:
    found = read(tmp_path, f"[options]\nmoving = {written}\n")["options"]["moving"]  # type: ignore[index]
    assert PureWindowsPath(found).parts == ("C:\\", "temp", "new.stl")


@pytest.mark.parametrize(
    ("written", "what"),
    [
        (r'"C:\temp\new.stl"', r"study\.toml options\.moving: a backslash stands for a tab or another sign"),
        (r'"data\fixed.stl"', r"study\.toml options\.moving: a backslash stands for"),
        (r'"C:\data\fixed.stl"', r"Unescaped '\\' in a string \(at line 2"),
        (r'"C:\users\P1.stl"', r"Invalid hex value \(at line 2"),
    ],
)
def test_backslashes_that_mean_something_else_are_refused(tmp_path: Path, written: str, what: str) -> None:
    with pytest.raises(InputError, match=what + ".*; write paths with /, or in 'single quotes'$"):
        read(tmp_path, f"[options]\nmoving = {written}\n")


def test_lines_of_a_long_string_are_no_backslashes(tmp_path: Path) -> None:
    assert read(tmp_path, 'title = """one\n\ttwo"""\n') == {"title": "one\n\ttwo"}
