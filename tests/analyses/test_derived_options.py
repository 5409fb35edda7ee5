"""Options of an analysis that is another one with some of its options fixed or required."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass, field
from pathlib import Path
from typing import Any

import pytest

from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.options import Options, declared


@dataclass(frozen=True)
class General(Options):
    """In general.

    Parameters
    ----------
    file
        What is read.
    deep
        Whether it is deep.
    depth
        How deep.
    names
        Of files.
    """

    file: str
    _: KW_ONLY
    deep: bool = False
    depth: float | None = None
    names: tuple[str, ...] | None = None


@dataclass(frozen=True, kw_only=True)
class Deep(General):
    """Always deep.

    Parameters
    ----------
    depth
        How deep it is.
    """

    deep: bool = field(default=True, init=False)
    depth: float = field()


def nothing(*_: Any) -> Any:
    """Neither reads nor computes."""


def test_what_is_not_said_again_is_said_of_the_general_one() -> None:
    words = {one.name: one.words for one in declared(Deep)}
    assert words == {
        "file": "What is read.",
        "deep": "Whether it is deep.",
        "depth": "How deep it is.",
        "names": "Of files.",
    }


def test_what_is_fixed_is_no_argument_and_what_is_required_has_no_default() -> None:
    parameters = Job("deep", Deep, nothing, nothing).__signature__.parameters
    assert list(parameters) == ["file", "depth", "names"]
    assert parameters["depth"].default is parameters["depth"].empty
    assert Deep("a", depth=2).deep and Deep("a", depth=2).depth == 2.0
    with pytest.raises(TypeError, match="depth"):
        Deep("a")  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="deep"):
        Deep("a", depth=1.0, deep=False)  # type: ignore[call-arg]


def test_a_path_is_text_where_text_is_asked_for() -> None:
    given: Any = (Path("a/b.csv"), Path("c.csv"))
    assert General(given[0], names=given) == General("a/b.csv", names=("a/b.csv", "c.csv"))
