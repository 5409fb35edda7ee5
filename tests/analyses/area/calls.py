"""Calls of the area analysis, on the inputs that the command line's tests make."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

from geocontact.analyses.area.result import AreaResult, pressure
from geocontact.analyses.area.result import area as analysis
from geocontact.data.errors import InputWarning
from geocontact.view.page.content import Page
from tests.cli.calls import FEMUR, INSERT


def area(moving: Path = FEMUR, fixed: Path = INSERT, *motions: Path, **options: Any) -> AreaResult:
    """Areas of two bodies, the coarse knee unless told; reservations are those of the result."""
    return quietly(analysis, moving, fixed, **_given(motions, options))


def pressed(moving: Path, fixed: Path, *motions: Path, **options: Any) -> AreaResult:
    """The same with pressures."""
    return quietly(pressure, moving, fixed, **_given(motions, options))


def quietly(job: Any, *bodies: Path, **options: Any) -> AreaResult:
    """Call a job; reservations are read off the result."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        return job(*bodies, **options)


def _given(motions: tuple[Path, ...], options: dict[str, Any]) -> dict[str, Any]:
    """What the types of the options say, which are checked here before a single value becomes a tuple."""
    if motions:
        options["motion"] = tuple(map(str, motions))
    if isinstance(options.get("threshold"), float):
        options["threshold"] = (options["threshold"],)
    return {"unit": "mm", **options}


def page_of(result: AreaResult) -> Page:
    """The page of the only motion, with all its frames."""
    (page,) = result.pages({}).values()
    return page.of(page.most)
