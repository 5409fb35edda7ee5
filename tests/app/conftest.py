"""One window for all tests, entered by one browser."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.view.page.conftest import DESKTOP

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Page

ENTRY = "from geocontact.cli.main import main; main()"


@dataclass
class Window:
    """The window, and what its browser asked for and complained of."""

    context: BrowserContext
    home: str
    folder: Path
    start: Path
    used: str
    requests: list[str] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)

    def tab(self, path: str = "", results: bool = True) -> Page:
        """A page of it, ready to be used; without `results` their frames stay empty, which costs a browser less."""
        tab = self.context.new_page()
        if not results:
            tab.route("**/result/**", lambda route: route.fulfill(body="", content_type="text/html"))
        tab.on("request", lambda request: self.requests.append(request.url))
        tab.on("pageerror", lambda error: self.complaints.append(str(error)))
        tab.goto(f"{self.home}/{path}")
        tab.wait_for_selector("h1")
        return tab


@pytest.fixture(scope="session")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, Path, Path]]:
    """Address and folder of a window that is served, and where it was started."""
    folder, start = tmp_path_factory.mktemp("window"), tmp_path_factory.mktemp("start")
    command = [sys.executable, "-c", ENTRY, "app", "--no-browser", "--out", str(folder)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=start) as process:
        assert process.stdout is not None and process.stderr is not None
        yield process.stdout.readline().strip(), folder, start
        process.terminate()
        complaints = process.stderr.read()
    assert "Traceback" not in complaints, complaints


@pytest.fixture(scope="session")
def window(browser: Browser, served: tuple[str, Path, Path]) -> Iterator[Window]:
    """Entered."""
    address, folder, start = served
    context = browser.new_context(**DESKTOP)
    context.grant_permissions(["clipboard-read", "clipboard-write"])
    found = Window(context, address.partition("/?")[0], folder, start, address)
    tab = context.new_page()
    tab.on("request", lambda request: found.requests.append(request.url))
    tab.goto(address)
    tab.wait_for_selector("h1")
    found.home = tab.url.rstrip("/")
    tab.close()
    yield found
    context.close()
    assert found.complaints == []
