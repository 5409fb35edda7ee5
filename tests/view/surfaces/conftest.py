"""Where rendering does not work, what needs it is skipped with the reason; tests may make it fail on purpose."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from geocontact.view.surfaces import child

CRASH = "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)"


@pytest.fixture
def asked_anew() -> Iterator[None]:
    """The probe's answer is not kept from before, nor for later."""
    asked = child.off_screen_works
    asked.cache_clear()
    yield
    asked.cache_clear()


@pytest.fixture
def without_rendering(monkeypatch: pytest.MonkeyPatch, asked_anew: None) -> None:
    """The probe's process is killed, as it is without a graphics driver."""
    monkeypatch.setattr(child, "PROGRAM", CRASH)


@pytest.fixture
def rendering() -> None:
    """Only where pyvista renders."""
    answer = child.off_screen_works()
    if not answer.ok:
        pytest.skip(f"pyvista cannot render here: {answer.reason}")
