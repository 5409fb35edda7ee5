"""A record that is open while a test runs, for parts of an analysis that are called by themselves."""

from __future__ import annotations

import sys
from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from geocontact.analyses.frame.record import Record

COLLECTOR = "geocontact.analyses.frame.collector"


def opened(record: Record) -> Record:
    """The record, into which the collector puts everything until the test ends."""
    import_module(COLLECTOR).OPEN.set(record)
    return record


def close() -> None:
    """Close the record that a test has opened."""
    if COLLECTOR in sys.modules:
        sys.modules[COLLECTOR].OPEN.set(None)
