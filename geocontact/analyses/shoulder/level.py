"""The support level as it is typed. Light to import."""

from __future__ import annotations

from geocontact.analyses import quantities
from geocontact.data.errors import InputError

EXAMPLE = "100%"


def level(text: str, option: str) -> float:
    """ "100%" or "0.5" to a share; 0 is no support."""
    value = quantities.number(text.strip().rstrip("% "), option, EXAMPLE)
    if "%" not in text and value > 1.0:
        raise InputError("", option, f"{text!r} may be meant in per cent", f"write {text}% or {0.01 * value:g}")
    return value * (0.01 if "%" in text else 1.0)
