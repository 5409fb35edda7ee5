"""Whole diagnoses run in a process of their own, where shapes are not checked at every call: ten times as fast."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import pytest

from tests.one_core import one_core

Elsewhere = Callable[..., Any]


@pytest.fixture(scope="session")
def elsewhere() -> Iterator[Elsewhere]:
    """Calls a function of a module in the other process and gives its result."""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn"), initializer=one_core) as pool:

        def call(function: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
            return pool.submit(function, *arguments, **options).result()

        yield call
