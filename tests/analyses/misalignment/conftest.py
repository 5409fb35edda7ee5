"""Trials that several tests identify from."""

from __future__ import annotations

from pathlib import Path

import pytest

import geocontact as gc
from tests.analyses.misalignment.trials import STROKE, recorded


@pytest.fixture(scope="session")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three locked and three free trials."""
    return recorded(tmp_path_factory.mktemp("made"), stroke=STROKE, pressure=gc.mmHg(10, 60))
