"""What holds for all tests of the command line."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from geocontact.cli import show


@pytest.fixture(scope="session", autouse=True)
def unhurried() -> Iterator[None]:
    """Kernels are loaded without a word, which depends on the machine; test_process.py asks for the word."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(show, "SILENCE", 3600.0)
        yield
