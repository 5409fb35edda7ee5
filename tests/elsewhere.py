"""Calls of a module's functions in a process of its own, where shapes are not checked at every call."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from typing import Any

from tests.one_core import one_core

Elsewhere = Callable[..., Any]
"""Calls a function of a module in the other process and gives its result; several times as fast."""


@contextmanager
def another_process() -> Iterator[Elsewhere]:
    """The process lives until the end of the block."""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn"), initializer=one_core) as pool:

        def call(function: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
            return pool.submit(function, *arguments, **options).result()

        yield call
