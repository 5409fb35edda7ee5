"""Which points of a body correspond from subject to subject, and when their distances are compared."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from geocontact.data.errors import InputError
from geocontact.io.text.units import LENGTH

KEYS = ("particles", "unit", "body", "at")
BODIES = ("fixed", "moving")


@dataclass(frozen=True)
class SurfaceSettings:
    """What [surface] of a study says.

    Parameters
    ----------
    particles
        Path of a trial's .particles, from the study's folder; may hold `{name}`.
    unit
        Of these files.
    body
        On which they lie: fixed or moving.
    at
        Places on the curve [%]; distances are interpolated linearly between frames.
    """

    particles: str
    unit: str
    body: str = "fixed"
    at: tuple[float, ...] = (0.0, 25.0, 50.0, 75.0, 100.0)


def surface_of(
    path: Path, told: Mapping[str, Any], analysis: str, options: Mapping[str, Any]
) -> SurfaceSettings | None:
    """From [surface] of a study's description; None where there is none."""
    if not told:
        return None
    odd = next((key for key in told if key not in KEYS), None)
    if odd is not None:
        raise InputError(path, f"[surface] {odd}", "is not known here", f"write {', '.join(KEYS)}")
    if analysis != "area" or not options.get("save_map"):
        remedy = 'write analysis = "area", and save_map = true in [options]'
        raise InputError(path, "[surface]", "needs the distances of every vertex", remedy)
    particles, unit, body = told.get("particles"), told.get("unit"), told.get("body", "fixed")
    if not isinstance(particles, str) or not particles:
        raise InputError(path, "[surface]", "no `particles`", 'write particles = "{subject}/talus.particles"')
    if unit not in LENGTH:
        raise InputError(path, "[surface] unit", f"{unit!r} is none of length", f"write one of {', '.join(LENGTH)}")
    if body not in BODIES:
        raise InputError(path, "[surface] body", f"{body!r} is no body", f"write {' or '.join(BODIES)}")
    return SurfaceSettings(particles, str(unit), str(body), _places(path, told.get("at", list(SurfaceSettings.at))))


def _places(path: Path, given: Any) -> tuple[float, ...]:
    numbers = isinstance(given, list) and all(isinstance(x, int | float) and not isinstance(x, bool) for x in given)
    if not numbers or not given or not all(0.0 <= x <= 100.0 for x in given) or len(set(given)) < len(given):
        raise InputError(path, "[surface] at", f"{given!r} are no places from 0 to 100 %", "write at = [0, 50, 100]")
    return tuple(float(x) for x in given)
