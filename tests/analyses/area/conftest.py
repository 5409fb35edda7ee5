"""What several tests of the area analysis compare with."""

from __future__ import annotations

import pytest

from geocontact.analyses.area.result import AreaResult
from tests.analyses.area.calls import area
from tests.cli.calls import FEMUR, INSERT, gait


@pytest.fixture(scope="session")
def knee(tmp_path_factory: pytest.TempPathFactory) -> AreaResult:
    """Two frames of the coarse knee with the default options."""
    return area(FEMUR, INSERT, gait(tmp_path_factory.mktemp("knee")))
