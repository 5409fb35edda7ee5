"""Which options name what is unknown besides E*; bounds as typed."""

from __future__ import annotations

from geocontact.cli.modulus import ModulusOptions
from geocontact.data.errors import InputError
from geocontact.elastic_modulus.area_force import ADDUCTION, LAG, SLOPE, THRESHOLD

NAMES = (THRESHOLD, LAG, ADDUCTION, SLOPE)


def freed(o: ModulusOptions) -> dict[str, str]:
    """Text of the bounds by name of the unknown; empty where none are given."""
    found: dict[str, str] = {}
    for part in [] if o.free is None else o.free.split(","):
        name, _, bounds = (piece.strip() for piece in part.partition("="))
        if name not in NAMES or name in found:
            what = f"{part.strip()!r} is none of {', '.join(NAMES)}, or is named twice"
            raise InputError("", "--free", what, "write threshold,lag=-0.05:0.05")
        found[name] = bounds
    return found
