"""Pages in a headless browser: the first screen and the whole of each."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

DEVICES = {
    "1280": {"viewport": {"width": 1280, "height": 800}},
    "390": {"viewport": {"width": 390, "height": 844}, "is_mobile": True, "has_touch": True, "device_scale_factor": 2},
}
SOFTWARE = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
"""Draws 3-D without a graphics card."""
READY = 60_000  # ms


def shoot(folder: Path, pages: Mapping[str, Path]) -> None:
    """First screen and whole page in light, first screen in dark, by the names of the kinds."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=_browser(), args=SOFTWARE)
        for kind, page in pages.items():
            for name, device in DEVICES.items():
                for scheme, ending in (("light", ""), ("dark", "-dark")):
                    context = chromium.new_context(**device, color_scheme=scheme)
                    tab = context.new_page()
                    tab.on("pageerror", lambda error, kind=kind: sys.exit(f"{kind}: {error}"))
                    tab.goto(page.resolve().as_uri())
                    tab.wait_for_selector("html[data-ready]", timeout=READY)
                    tab.wait_for_timeout(300)
                    tab.screenshot(path=folder / f"{kind}-{name}{ending}.png")
                    tab.screenshot(path=folder / f"{kind}-{name}{ending}-whole.png", full_page=True, scale="css")
                    context.close()
            sys.stdout.write(f"{kind}: {page.stat().st_size / 1e6:.2f} MB\n")
        chromium.close()


@contextmanager
def browser_page(size: tuple[int, int]) -> Iterator[Callable[[Path, str], bytes]]:
    """A function that photographs the first screen of a page, (file, "light" or "dark") → PNG."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=_browser(), args=SOFTWARE)

        def photograph(page: Path, scheme: str) -> bytes:
            viewport = {"width": size[0], "height": size[1]}
            context = chromium.new_context(viewport=viewport, color_scheme=scheme)
            tab = context.new_page()
            tab.goto(page.resolve().as_uri())
            tab.wait_for_selector("html[data-ready]", timeout=READY)
            tab.wait_for_timeout(300)
            png: bytes = tab.screenshot(timeout=2 * READY)
            context.close()
            return png

        yield photograph
        chromium.close()


def _browser() -> str | None:
    return next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
