"""One headless browser for all tests of a process; skipped, with the reason, where there is none (in CI: failed)."""

from __future__ import annotations

import asyncio
import os
import shutil
from collections.abc import Coroutine, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Browser

CHROMIUM = ("chromium", "chromium-browser", "google-chrome")
SOFTWARE = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


T = TypeVar("T")


def awaited(coroutine: Coroutine[Any, Any, T]) -> T:
    """Its result, in a thread of its own: once a browser was started, a loop runs in that of the tests."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(asyncio.run, coroutine).result()


def absent(reason: str) -> NoReturn:
    """Skip on a desk; fail where the tests are relied upon."""
    if os.environ.get("CI"):
        pytest.fail(reason)
    pytest.skip(reason)


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    try:
        from playwright import sync_api
    except ImportError as missing:
        absent(f"playwright is not installed: {missing}")
    executable = next(filter(None, map(shutil.which, CHROMIUM)), None)
    if executable is None:
        absent("no chromium on PATH: apt install chromium")
    with ExitStack() as open_until_the_end:
        try:
            playwright = open_until_the_end.enter_context(sync_api.sync_playwright())
        except Exception as broken:  # noqa: BLE001 - the driver is a program of its own and fails in ways of its own
            absent(f"the driver of the browser does not start: {broken}")
        chromium = playwright.chromium.launch(executable_path=executable, args=SOFTWARE)
        yield chromium
        chromium.close()
