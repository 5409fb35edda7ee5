"""What the quantities of a person with a prosthesis can be."""

from __future__ import annotations

from pathlib import Path

from geocontact.data.errors import InputError
from geocontact.data.plausible import KG, Plausible
from geocontact.data.units import deg, m, mm, percent

FULCRUM = Plausible("a fulcrum of a prosthetic foot", mm, (1.0, 500.0))
PERSON = Plausible("the mass of a walking person", KG, (10.0, 300.0), (10.0, 200.0))
"""Beside an age, by which a small mass is doubted (`analyses.person.doubt_age`)."""
ADULT = Plausible("the mass of a walking person", KG, (10.0, 300.0), (35.0, 200.0))
"""Where no age can be stated."""
RESIDUAL = Plausible("the share of the shank that is left", percent, (1.0, 99.0), (25.0, 80.0))
LIMB = Plausible("the length of a residual limb", mm, (20.0, 500.0), (80.0, 300.0))
PROSTHESIS = Plausible("the mass of a below-knee prosthesis", KG, (0.3, 10.0), (0.8, 4.0))
STATURE = Plausible("the height of a person", m, (0.8, 2.6), (0.8, 2.2))
SLOPE = Plausible("the slope of a walkway", deg, (-25.0, 25.0), (-12.0, 12.0))
EDGE = Plausible("the edge of a step under a foot", mm, (0.0, 150.0), (3.0, 150.0), or_zero=True)
USUAL_SHARE = 0.45
FEWEST_WALKS, MOST_WALKS = 4, 600
"""Draws of the markers' errors for a band: fewer say nothing about its width."""
TURNS, MOST_TURNS = 6, 50
"""Fits of the leg after the first, each with the socket's simulated motion taken out of its markers; most of them."""


def pair_of(markers: str) -> list[str]:
    """Names of markers that are written with a comma between them."""
    return [name for name in (each.strip() for each in markers.split(",")) if name]


def require_turns(turns: int) -> None:
    """InputError for a number of fits that is none."""
    if not 0 <= turns <= MOST_TURNS:
        raise InputError("", "`socket_turns`", f"{turns} is not 0 to {MOST_TURNS}", f"give for example {TURNS}")


def require_walks(walks: int | None) -> None:
    """InputError for draws of the markers' errors that make no band."""
    if walks is not None and not FEWEST_WALKS <= walks <= MOST_WALKS:
        raise InputError("", "`walks`", f"{walks} is not {FEWEST_WALKS} to {MOST_WALKS}", "give for example 12")


def require_one_socket(usual: str, numbers: Path | None) -> None:
    """InputError for the numbers of a socket both by name and in a file."""
    if numbers is not None and usual != "as_meant":
        raise InputError("", "`socket_numbers`", "they stand in place of `socket`", "give one of them")


def require_one_residual(share: float, length: float | None, markers: str | None = None) -> None:
    """InputError for a residual limb by more than one of its share of the shank, its length and two markers."""
    if markers is not None and (length is not None or share != USUAL_SHARE):
        other = "its share of the shank" if length is None else "its length"
        raise InputError("", "`residual_markers`", f"the residual limb is given by {other} as well", "give one of them")
    if markers is not None and len(pair_of(markers)) != 2:
        raise InputError("", "`residual_markers`", f"{markers!r} are not two markers", "write for example RKNE,REND")
    if length is not None and share != USUAL_SHARE:
        what = f"the residual limb is {share:.0%} of the shank and {1e3 * length:g} mm long"
        raise InputError("", "`residual_length`", what, "give one of them")
