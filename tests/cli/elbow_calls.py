"""Calls of `geocontact elbow`, most of them without the pictures that take most of the time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any
from unittest import mock

from tests.cli.calls import Call, call


def elbow(command: str, folder: Path, *arguments: object, picture: bool = False) -> Call:
    """One command with `folder` for its results."""
    with nullcontext() if picture else unpictured():
        return call("elbow", command, *arguments, "--out", folder, folder=folder)


@contextmanager
def unpictured() -> Iterator[None]:
    """Figures are empty files."""

    def save(_: Any, file: Path) -> None:
        file.write_bytes(b"<svg/>")

    with mock.patch("geocontact.analyses.frame.pages.save", save):
        yield


def same_csv(one: Path, other: Path) -> list[str]:
    """Names of the .csv files of two folders, which are the same byte by byte."""
    files = sorted(file.name for file in one.glob("*.csv"))
    assert files == sorted(file.name for file in other.glob("*.csv"))
    for name in files:
        assert (one / name).read_bytes() == (other / name).read_bytes(), name
    return files
