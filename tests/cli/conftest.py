"""What holds for all tests of the command line."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from geocontact.cli import patience


@pytest.fixture(scope="session", autouse=True)
def unhurried() -> Iterator[None]:
    """No word about compiling: whether it is said depends on the machine and its load; test_patience.py asks for it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(patience, "SILENCE", 3600.0)
        yield
