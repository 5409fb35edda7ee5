"""The numbers of the force law: from the table of spheres, a file, an option, or the defaults."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.analyses.cop.options import LAW, CopOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.plausible import numbers_in
from geocontact.io.recordings.spheres import LawFile, SphereTable, read_law
from geocontact.loads.sphere_set import SoleLaw

STIFFNESS, EXPONENT = 8e4, 1.2  # N/m^1.2: 75 N press a sphere 3 mm deep
DAMPING, FULL_DEPTH = 200.0, 2e-3  # N s/m, m
STATIC, KINETIC, THRESHOLD_SPEED = 0.9, 0.7, 0.25  # -, -, m/s: rubber on a laboratory floor


def sole_law(record: Record, table: SphereTable, o: CopOptions) -> SoleLaw:
    """The law; a number that is given in two places is refused, one that is given nowhere has its default, told."""
    file = LawFile() if o.law is None else read_law(o.law)
    if o.law is not None:
        record.add_input("law", o.law)
    if file.foot is not None:
        record.warn(f"{o.law}: [foot] is beside the standing trial of a prosthesis and has no effect here")
    _refuse_strange_zones(o, file, table)
    assumed: dict[str, float] = {}
    static, kinetic = (None, None) if o.friction is None else o.friction
    one = _Numbers(o, assumed)
    exponent = table.exponent if o.exponent is None and file.n is None else None  # the unit of k says it
    if exponent is None:
        exponent = one("exponent", "n", o.exponent, file.n, EXPONENT)
    if table.exponent is not None and table.exponent != exponent:
        what = f"column k is in N/m^{table.exponent:g} but the exponent is {exponent:g}"
        raise InputError("", "`exponent`", what, f"give `exponent` {table.exponent:g}")
    try:
        law = SoleLaw(
            stiffness=_each(record, one, table, file, "k"),
            damping=_each(record, one, table, file, "b"),
            exponent=exponent,
            full_depth=one("full_depth", "delta_full", o.full_depth, file.delta_full, FULL_DEPTH),
            static=_friction(one, table, file, "mu_s", static, STATIC),
            kinetic=_friction(one, table, file, "mu_k", kinetic, KINETIC),
            threshold_speed=one("threshold_speed", "v_th", o.threshold_speed, file.v_th, THRESHOLD_SPEED),
        )
    except InputError:
        raise
    except ValueError as error:
        raise InputError(o.law or "", "force law", str(error), "correct the number") from error
    _check_sizes(record, o, law)
    _tell_assumed(record, assumed, law)
    return law


def _check_sizes(record: Record, o: CopOptions, law: SoleLaw) -> None:
    """Refuse numbers of files that a law cannot have, and warn of unusual ones; those of options are checked there."""
    found = {
        "k": None if o.stiffness is not None else (float(law.stiffness.min()), float(law.stiffness.max())),
        "b": None if o.damping is not None else (float(law.damping.min()), float(law.damping.max())),
        "n": None if o.exponent is not None else law.exponent,
        "delta_full": None if o.full_depth is not None else law.full_depth,
        "mu_s": None if o.friction is not None else (float(law.static.min()), float(law.static.max())),
        "mu_k": None if o.friction is not None else (float(law.kinetic.min()), float(law.kinetic.max())),
        "v_th": None if o.threshold_speed is not None else law.threshold_speed,
    }
    for name, known, value in numbers_in(LAW, found):
        if refusal := known.refusal(value):
            raise InputError(o.law or o.spheres, name, *refusal)
        if doubt := known.doubt(value):
            record.warn(f"force law: {name}: {doubt}")


class _Numbers:
    """One number of the law from the options or the file; what neither gives is noted as assumed."""

    def __init__(self, o: CopOptions, assumed: dict[str, float]) -> None:
        self.options, self.assumed = o, assumed

    def __call__(self, option: str, key: str, given: float | None, filed: float | None, default: float) -> float:
        if given is not None and filed is not None:
            what = f"is given a second time by {key} in {self.options.law}"
            raise InputError("", f"`{option}`", what, "give it once")
        if given is None and filed is None:
            self.assumed[key] = default
            return default
        return given if given is not None else filed if filed is not None else default


UNITS = {"n": "", "b": " N s/m", "delta_full": " m", "mu_s": "", "mu_k": "", "v_th": " m/s"}


def _tell_assumed(record: Record, assumed: dict[str, float], law: SoleLaw) -> None:
    """Say which numbers nobody gave, of those that have an effect."""
    idle = {"delta_full": not law.damping.any(), "v_th": not (law.static.any() or law.kinetic.any())}
    shown = [f"{key} = {assumed[key]:g}{unit}" for key, unit in UNITS.items() if key in assumed and not idle.get(key)]
    if shown:
        record.warn(f"numbers of the force law that were not given are assumed: {', '.join(shown)}")


def _each(record: Record, one: _Numbers, table: SphereTable, file: LawFile, key: str) -> Float[np.ndarray, " n"]:
    """k or b of every sphere."""
    option, given, filed, column, default = {
        "k": ("stiffness", one.options.stiffness, file.k, table.stiffness, STIFFNESS),
        "b": ("damping", one.options.damping, file.b, table.damping, DAMPING),
    }[key]
    zones = {name: value for name, zone in file.zone.items() if (value := getattr(zone, key)) is not None}
    if column is not None:
        if given is not None or filed is not None or zones:
            source = f"`{option}`" if given is not None else f"{key} in {one.options.law}"
            raise InputError("", source, f"has no effect with the column {key} of the spheres", "give it once")
        return column
    without = set(table.zone) - set(zones)
    rest = one(option, key, given, filed, default) if without or given is not None or filed is not None else default
    if key == "k" and key in one.assumed:
        where = "every sphere" if not zones else f"zone {', '.join(sorted(without))}"
        record.warn(f"no stiffness given for {where}: {default:g} N/m^n is taken; forces are only as good as that")
    return np.array([zones.get(zone, rest) for zone in table.zone])


def _friction(
    one: _Numbers, table: SphereTable, file: LawFile, key: str, given: float | None, default: float
) -> Float[np.ndarray, " n"]:
    """Static or kinetic friction of every sphere."""
    zones = {name: value for name, zone in file.zone.items() if (value := getattr(zone, key)) is not None}
    without = set(table.zone) - set(zones)
    filed = getattr(file, key)
    rest = one("friction", key, given, filed, default) if without or given is not None or filed is not None else default
    return np.array([zones.get(zone, rest) for zone in table.zone])


def _refuse_strange_zones(o: CopOptions, file: LawFile, table: SphereTable) -> None:
    strange = sorted(set(file.zone) - set(table.zone))
    if strange:
        known = ", ".join(dict.fromkeys(table.zone))
        raise InputError(o.law or "", f"zone.{strange[0]}", "no sphere is in that zone", f"zones are: {known}")
