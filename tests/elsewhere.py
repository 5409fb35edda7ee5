"""Calls of functions where shapes are not checked at every call: in a process of its own, if they are checked here."""

from __future__ import annotations

import multiprocessing
import warnings
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


def here(function: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
    """What a call gives in this process, warnings aside, as it would elsewhere."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return function(*arguments, **options)
