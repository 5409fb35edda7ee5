"""The page of a gap diagnosis in a browser: offline, without a complaint, its drawings shown."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.cli.gap_cases import damped_elbow
from tests.view.page.conftest import DESKTOP, PHONE, Open

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Page of a damped elbow, made where shapes are not checked at every call."""
    folder = tmp_path_factory.mktemp("gap page")
    words = ("gap", "diagnose", damped_elbow(folder / "case"), "--out", folder / "out")
    subprocess.run([sys.executable, "cli.py", *map(str, words)], cwd=ROOT, check=True, capture_output=True)
    return folder / "out" / "report.html"


@pytest.mark.slow
@pytest.mark.parametrize("device", [DESKTOP, PHONE], ids=["1280x800", "390x844"])
def test_opens_and_shows_its_drawings(report: Path, opened: Open, device: dict[str, Any]) -> None:
    here = opened(report, device=device)
    pictures = here.tab.locator("img")
    assert pictures.count() == 4
    for k in range(3):
        pictures.nth(k).scroll_into_view_if_needed()
        here.until(f"document.images[{k}].complete && document.images[{k}].naturalWidth > 100")
    assert here.complaints == []
    asked = [address for address in here.requests if not address.startswith("data:")]
    assert asked == [report.as_uri()]
    assert here.tab.evaluate("document.documentElement.scrollWidth <= window.innerWidth"), "no sideways scrolling"
    assert here.tab.locator("svg").count() > 2, "curves of the held-out trials"
