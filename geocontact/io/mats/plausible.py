"""Pressures that no skin is under: most likely another unit is meant."""

from __future__ import annotations

import math
import warnings

from geocontact.data.errors import InputWarning
from geocontact.io.text.units import DIMENSIONS

LEAST, MOST = 1e2, 2e6
"""Largest pressure of a recording [Pa]: less no mat resolves; more no skin bears, plantar peaks reach 1.5 MPa."""

LIKELY = ("kPa", "mmHg", "N/cm^2", "psi", "Pa", "MPa")
"""Units that makers of mats export, the usual one first."""


def tell_implausible(file: str, name: str, highest: float, unit: float) -> None:
    """Warn of a recording whose largest pressure [Pa] is none of a body's; `unit` is what one of the file's is [Pa]."""
    if not 0.0 < highest < math.inf or LEAST <= highest <= MOST:
        return
    read = next((each for each, factor in DIMENSIONS["Pa"].items() if math.isclose(factor, unit)), f"{unit:g} Pa")
    value = highest / unit
    meant = next((each for each in LIKELY if LEAST < value * DIMENSIONS["Pa"][each] < MOST), None)
    bound = f"more than {MOST * 1e-6:g} MPa" if highest > MOST else f"less than {LEAST:g} Pa"
    said = f"{file}: the largest pressure of '{name}' is {value:.4g} {read}, {bound}, which no skin under load reads"
    warnings.warn(InputWarning(f"{said}{f'; is the file in {meant}?' if meant else ''}"), stacklevel=5)
