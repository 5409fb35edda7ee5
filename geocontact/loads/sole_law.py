"""The force law of a sole from numbers for all spheres, for zones and for single spheres."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.loads.sphere_set import SoleLaw

ASSUMED: Mapping[str, float] = MappingProxyType(
    {"k": 8e4, "n": 1.2, "b": 200.0, "delta_full": 2e-3, "mu_s": 0.9, "mu_k": 0.7, "v_th": 0.25}
)
"""Numbers where none are given: k [N/m^n], of which 75 N press a sphere 3 mm deep; n; b [N s/m]; delta_full [m]; static
and kinetic friction of rubber on a laboratory floor [-]; v_th [m/s].
"""
OF_SPHERES = ("k", "b", "mu_s", "mu_k")
"""Numbers that may differ from sphere to sphere."""
NONE: Mapping[str, Mapping[str, float]] = MappingProxyType({})
NO_COLUMN: Mapping[str, Float[np.ndarray, " n"]] = MappingProxyType({})


def law_of_sole(
    zone: Sequence[str],
    given: Mapping[str, float],
    zones: Mapping[str, Mapping[str, float]] = NONE,
    columns: Mapping[str, Float[np.ndarray, " n"]] = NO_COLUMN,
) -> tuple[SoleLaw, dict[str, float]]:
    """Force law of n spheres, and the numbers of it that are assumed.

    A sphere has the number of its own column, else that of its zone, else that which is given for all, else `ASSUMED`.

    Parameters
    ----------
    zone
        Zone of each of the n spheres.
    given
        Numbers for all spheres by their keys in `ASSUMED`, SI units.
    zones
        Numbers of `OF_SPHERES` for the spheres of a zone, by zone and key.
    columns
        Numbers of `OF_SPHERES` for each sphere, by key.

    Returns
    -------
    law
        Numbers sphere by sphere.
    assumed
        Those that are taken from `ASSUMED` and have an effect: delta_full has none without damping, v_th none without
        friction.

    Raises
    ------
    InputError
        A zone in `zones` that no sphere is in.
    ValueError
        Numbers beside a column of the same key, keys that are not known, and what `SoleLaw` refuses.
    """
    _refuse_strange(zone, zones)
    _refuse_unknown(given, zones, columns)
    assumed: dict[str, float] = {}

    def one(key: str) -> float:
        if key not in given:
            assumed[key] = ASSUMED[key]
        return given.get(key, ASSUMED[key])

    def each(key: str) -> Float[np.ndarray, " n"]:
        if key in columns:
            return columns[key]
        own = {name: numbers[key] for name, numbers in zones.items() if key in numbers}
        rest = one(key) if set(zone) - set(own) else np.nan
        return np.array([own.get(name, rest) for name in zone])

    stiffness, damping, static, kinetic = (each(key) for key in OF_SPHERES)
    law = SoleLaw(stiffness, damping, one("n"), one("delta_full"), static, kinetic, one("v_th"))
    if not law.damping.any():
        assumed.pop("delta_full", None)
    if not (law.static.any() or law.kinetic.any()):
        assumed.pop("v_th", None)
    return law, assumed


def changed_law(
    law: SoleLaw,
    zone: Sequence[str],
    given: Mapping[str, float],
    zones: Mapping[str, Mapping[str, float]] = NONE,
) -> SoleLaw:
    """A law with some of its numbers changed; the rest stay as they are.

    Parameters
    ----------
    zone, given, zones
        As those of `law_of_sole`: a sphere has the number of its zone, else that which is given for all, else its own.

    InputError and ValueError as those of `law_of_sole`.
    """
    _refuse_strange(zone, zones)
    _refuse_unknown(given, zones, NO_COLUMN)

    def each(key: str, own: Float[np.ndarray, "#n"]) -> Float[np.ndarray, " n"]:
        usual = np.broadcast_to(given.get(key, own), len(zone))
        return np.array([zones.get(name, {}).get(key, float(value)) for name, value in zip(zone, usual, strict=True)])

    return SoleLaw(
        each("k", law.stiffness),
        each("b", law.damping),
        given.get("n", law.exponent),
        given.get("delta_full", law.full_depth),
        each("mu_s", law.static),
        each("mu_k", law.kinetic),
        given.get("v_th", law.threshold_speed),
    )


def _refuse_strange(zone: Sequence[str], zones: Mapping[str, Mapping[str, float]]) -> None:
    strange = sorted(set(zones) - set(zone))
    if strange:
        known = ", ".join(dict.fromkeys(zone))
        raise InputError("", f"zone.{strange[0]}", "no sphere is in that zone", f"zones are: {known}")


def _refuse_unknown(
    given: Mapping[str, float],
    zones: Mapping[str, Mapping[str, float]],
    columns: Mapping[str, Float[np.ndarray, " n"]],
) -> None:
    unknown = set(given) - set(ASSUMED)
    for numbers in (*zones.values(), columns):
        unknown |= set(numbers) - set(OF_SPHERES)
    if unknown:
        raise ValueError(f"{min(unknown)} is not a number of the law, or none that single spheres can have")
    twice = [key for key in columns if key in given or any(key in numbers for numbers in zones.values())]
    if twice:
        raise ValueError(f"{twice[0]} has no effect together with the column {twice[0]} of the spheres")
