"""Pages in the browser that all tests share."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from geocontact.view.page.content import Page
from geocontact.view.page.write import write_page

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext
    from playwright.sync_api import Page as Tab

DESKTOP = {"viewport": {"width": 1280, "height": 800}}
PHONE = {"viewport": {"width": 390, "height": 844}, "is_mobile": True, "has_touch": True, "device_scale_factor": 2}
READY = 60_000  # ms; a busy machine without a graphics card


@dataclass
class Opened:
    """A page in the browser and everything it said and asked for."""

    tab: Tab
    requests: list[str] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)

    def picture(self) -> str:
        """What the canvas shows once it has been drawn."""
        return str(
            self.tab.evaluate(
                "new Promise(done => requestAnimationFrame(() => requestAnimationFrame("
                "() => done(document.getElementById('canvas').toDataURL()))))"
            )
        )

    def frame(self) -> int:
        return int(self.tab.evaluate("window.__geocontact.frame"))

    def until(self, condition: str, seconds: float = 20.0) -> None:
        """Wait for a condition; the page's policy forbids the evaluation that playwright's own waiting needs."""
        end = time.monotonic() + seconds
        while not self.tab.evaluate(condition):
            assert time.monotonic() < end, condition
            self.tab.wait_for_timeout(30)

    def text(self, selector: str) -> str:
        return str(self.tab.locator(selector).first.text_content())


Open = Callable[..., Opened]


def set_range(opened: Opened, selector: str, value: float) -> None:
    """Put a slider at a value and tell the page, as a reader's hand does."""
    opened.tab.locator(selector).evaluate("(e, v) => { e.value = v; e.dispatchEvent(new Event('input')); }", value)


def rows(opened: Opened) -> dict[str, str]:
    """Numbers under the cursor by their labels."""
    seen = "[...document.querySelectorAll('.readout:not([hidden]) tr')]"
    script = f"{seen}.map(r => [...r.children].map(c => c.textContent.trim()))"
    return {cells[0]: cells[1] for cells in opened.tab.evaluate(script) if len(cells) > 1}


@pytest.fixture
def opened(browser: Browser, tmp_path: Path) -> Iterator[Open]:
    """Writes a page (or takes the file of one), opens it from disk and waits until it is ready."""
    contexts: list[BrowserContext] = []

    def open_page(
        page: Page | Path, name: str = "page.html", device: dict[str, Any] = DESKTOP, before: str = "", **more: Any
    ) -> Opened:
        file = page if isinstance(page, Path) else tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(page, Page):
            write_page(page, file)
        context = browser.new_context(**device, **more)
        contexts.append(context)
        found = Opened(context.new_page())
        found.tab.on("request", lambda request: found.requests.append(request.url))
        found.tab.on("console", lambda message: found.complaints.append(f"{message.type}: {message.text}"))
        found.tab.on("pageerror", lambda error: found.complaints.append(f"error: {error}"))
        found.tab.on("dialog", lambda dialog: (found.complaints.append("dialog"), dialog.dismiss()))
        if before:
            found.tab.add_init_script(before)
        found.tab.goto(file.as_uri())
        if more.get("java_script_enabled", True):
            found.tab.wait_for_selector("html[data-ready]", timeout=READY)
        return found

    yield open_page
    for context in contexts:
        context.close()
