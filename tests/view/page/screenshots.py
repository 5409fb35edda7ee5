"""Pictures of pages to look at: python -m tests.view.page.screenshots FOLDER [REPORT.html ...]."""

from __future__ import annotations

import shutil
import sys
import time
from pathlib import Path

from playwright.sync_api import sync_playwright

from geocontact.view.page.write import write_page
from tests.browsers import CHROMIUM, SOFTWARE
from tests.view.page.conftest import DESKTOP, PHONE, READY
from tests.view.page.examples import curves_page, small_page
from tests.view.page.hostile import HOSTILE, hostile_page


def shoot(folder: Path, reports: list[Path]) -> None:
    """Write the example pages and photograph them and the given reports, on a desktop and on a phone."""
    folder.mkdir(parents=True, exist_ok=True)
    examples = {"ball": small_page(), "curves": curves_page(), "hostile": hostile_page(small_page(), HOSTILE)}
    for name, page in examples.items():
        write_page(page, folder / f"{name}.html")
    files = [*(folder / f"{name}.html" for name in examples), *reports]
    executable = next(filter(None, map(shutil.which, CHROMIUM)))
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=executable, args=SOFTWARE)
        for file in files:
            for device, options in (("desktop", DESKTOP), ("phone", PHONE)):
                tab = chromium.new_context(**options).new_page()
                start = time.perf_counter()
                tab.goto(file.resolve().as_uri())
                tab.wait_for_selector("html[data-ready]", timeout=READY)
                ready = time.perf_counter() - start
                tab.wait_for_timeout(500)
                tab.screenshot(path=folder / f"{file.stem}-{device}.png")
                sys.stdout.write(f"{file.stem} {device}: {file.stat().st_size / 1e6:.2f} MB, ready in {ready:.1f} s\n")
        chromium.close()


if __name__ == "__main__":
    shoot(Path(sys.argv[1]), [Path(name) for name in sys.argv[2:]])
