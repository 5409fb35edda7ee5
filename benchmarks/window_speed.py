"""How soon the window is there: start of the server, first paint of the start page, forms after a click.

`python -m benchmarks.window_speed` prints medians of wall-clock times, which a busy machine lengthens, and CPU time of
the server and of all processes of the browser for each form, which it does not. Needs Chromium and playwright.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

import psutil

ENTRY = "from geocontact.cli.main import main; main()"
FORMS = ("area", "mat", "prosthesis.simulate", "prosthesis.keel")
TIMES = 7
PAINT = "performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? null"


def cpu(process: int) -> float:
    """CPU time of a process [s]."""
    words = Path(f"/proc/{process}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def of_browser() -> float:
    """CPU time of all processes that this one started, the server among them [s]."""
    return sum(cpu(child.pid) for child in psutil.Process().children(recursive=True))


def main() -> None:
    from playwright.sync_api import sync_playwright

    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        began = time.perf_counter()
        command = [sys.executable, "-c", ENTRY, "app", "--no-browser", "--out", folder]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
            assert server.stdout is not None
            address = server.stdout.readline().strip()
            print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
            print(f"address printed after {time.perf_counter() - began:.2f} s")
            chromium = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
            tab = chromium.new_page()
            tab.goto(address)
            tab.wait_for_selector("h1")
            home, paints = tab.url, []
            for _ in range(TIMES):
                tab.goto(home)
                tab.wait_for_selector("h1")
                tab.wait_for_timeout(500)
                paints.append(tab.evaluate(PAINT))
            print(f"first paint of the start page {median(filter(None, paints)) / 1e3:.2f} s")
            for form in FORMS:
                seconds, used, all_used = [], [], []
                for _ in range(TIMES):
                    tab.goto(home)
                    tab.wait_for_selector("h1")
                    tab.wait_for_timeout(1000)
                    before, every, start = cpu(server.pid), of_browser(), time.perf_counter()
                    tab.locator(f'a[href$="/form/{form}"]').first.click()
                    tab.wait_for_selector(".field")
                    seconds.append(time.perf_counter() - start)
                    used.append(cpu(server.pid) - before)
                    all_used.append(of_browser() - every)
                fields = tab.locator(".field").count()
                spent = f"CPU of the server {median(used):.2f} s, of both {median(all_used):.2f} s"
                print(f"{form}: {fields} fields {median(seconds):.2f} s; {spent}")
            chromium.close()
            server.terminate()


if __name__ == "__main__":
    main()
