"""What holds for all tests of the command line."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import pytest

from geocontact.analyses.area import run as area_analysis
from geocontact.cli import show
from tests.cli.calls import Call, area, done, gait


@pytest.fixture(scope="session", autouse=True)
def unhurried() -> Iterator[None]:
    """Kernels are loaded once for all calls, and without a word, which depends on the machine and its load.

    test_process.py asks for the word.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(show, "SILENCE", 3600.0)
        patch.setattr(area_analysis, "warm_up", cache(area_analysis.warm_up))
        yield


@pytest.fixture(scope="session")
def knee(tmp_path_factory: pytest.TempPathFactory, unhurried: None) -> Call:
    """Two frames of the coarse knee with the default options."""
    folder = tmp_path_factory.mktemp("knee")
    return done(area(folder / "out", motion=gait(folder)))
