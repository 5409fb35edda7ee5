"""Values of options as they are typed, in SI: on the command line and in the file of a study."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from geocontact.analyses.options import Declared


def key(one: Declared) -> str:
    """Its name in `run.json`."""
    return one.spelled.key or one.name


def read(one: Declared, value: Any) -> Any:
    """What was typed, in SI."""
    if one.typed is None or value is None:
        return value
    place, _, name = one.typed.read.rpartition(":")
    function = getattr(import_module(f"geocontact.analyses.{place or 'quantities'}"), name)
    return function(value, f"`{one.name}`")
