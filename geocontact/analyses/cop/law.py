"""The numbers of the force law: from the table of spheres, a file, the command line, or the defaults."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.analyses.quantities import length, number
from geocontact.analyses.run_record import Record
from geocontact.cli.cop import CopOptions
from geocontact.data.errors import InputError
from geocontact.io.recordings.spheres import LawFile, SphereTable, read_law
from geocontact.loads.sphere_set import SoleLaw

STIFFNESS, EXPONENT = 8e4, 1.2  # N/m^1.2: 75 N press a sphere 3 mm deep
DAMPING, FULL_DEPTH = 200.0, 2e-3  # N s/m, m
STATIC, KINETIC, THRESHOLD_SPEED = 0.9, 0.7, 0.25  # -, -, m/s: rubber on a laboratory floor


def sole_law(record: Record, table: SphereTable, o: CopOptions) -> SoleLaw:
    """The law; a number that is given in two places is refused, one that is given nowhere has its default."""
    file = LawFile() if o.law is None else read_law(o.law)
    if o.law is not None:
        record.add_input("law", o.law)
    _refuse_strange_zones(o, file, table)
    static, kinetic = _friction(o)
    exponent = _one(o, "--exponent", "n", o.exponent, file.n, EXPONENT)
    if table.exponent is not None and table.exponent != exponent:
        what = f"column k is in N/m^{table.exponent:g} but the exponent is {exponent:g}"
        raise InputError("", "--exponent", what, f"give --exponent {table.exponent:g}")
    try:
        return SoleLaw(
            stiffness=_each(record, o, table, file, "k"),
            damping=_each(record, o, table, file, "b"),
            exponent=exponent,
            full_depth=_one(o, "--full-depth", "delta_full", _full_depth(o), file.delta_full, FULL_DEPTH),
            static=_one(o, "--friction", "mu_s", static, file.mu_s, STATIC),
            kinetic=_one(o, "--friction", "mu_k", kinetic, file.mu_k, KINETIC),
            threshold_speed=_one(o, "--threshold-speed", "v_th", o.threshold_speed, file.v_th, THRESHOLD_SPEED),
        )
    except InputError:
        raise
    except ValueError as error:
        raise InputError(o.law or "", "force law", str(error), "correct the number") from error


def _one(o: CopOptions, option: str, key: str, typed: float | None, filed: float | None, default: float) -> float:
    if typed is not None and filed is not None:
        raise InputError("", option, f"is given a second time by {key} in {o.law}", "give it once")
    return typed if typed is not None else filed if filed is not None else default


def _each(record: Record, o: CopOptions, table: SphereTable, file: LawFile, key: str) -> Float[np.ndarray, " n"]:
    """k or b of every sphere."""
    option, typed, filed, column, default = {
        "k": ("--stiffness", o.stiffness, file.k, table.stiffness, STIFFNESS),
        "b": ("--damping", o.damping, file.b, table.damping, DAMPING),
    }[key]
    zones = {name: value for name, zone in file.zone.items() if (value := getattr(zone, key)) is not None}
    if column is not None:
        if typed is not None or filed is not None or zones:
            source = option if typed is not None else f"{key} in {o.law}"
            raise InputError("", source, f"does nothing beside the column {key} of the spheres", "give it once")
        return column
    rest = _one(o, option, key, typed, filed, default)
    if typed is None and filed is None and set(zones) < set(table.zone) and key == "k":
        where = "every sphere" if not zones else f"zone {', '.join(sorted(set(table.zone) - set(zones)))}"
        record.warn(f"no stiffness given for {where}: {default:g} N/m^n is taken; forces are only as good as that")
    return np.array([zones.get(zone, rest) for zone in table.zone])


def _refuse_strange_zones(o: CopOptions, file: LawFile, table: SphereTable) -> None:
    strange = sorted(set(file.zone) - set(table.zone))
    if strange:
        known = ", ".join(dict.fromkeys(table.zone))
        raise InputError(o.law or "", f"zone.{strange[0]}", "no sphere is in that zone", f"zones are: {known}")


def _friction(o: CopOptions) -> tuple[float | None, float | None]:
    if o.friction is None:
        return None, None
    parts = o.friction.split(",")
    if len(parts) != 2:
        raise InputError("", "--friction", f"{o.friction!r} is not two numbers", "write static,kinetic as 0.9,0.7")
    static, kinetic = (number(part, "--friction", "--friction 0.9,0.7") for part in parts)
    return static, kinetic


def _full_depth(o: CopOptions) -> float | None:
    return None if o.full_depth is None else length(o.full_depth, "--full-depth")
