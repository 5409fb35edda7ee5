"""E* of a contact from its area and its force, with intervals and what the data cannot tell."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from geocontact.contact.elasticity import plane_modulus
from geocontact.data.evolution import TiltedAreas
from geocontact.data.parameter import Parameter
from geocontact.elastic_modulus.area_force import (
    ADDUCTION,
    LAG,
    MODULUS,
    SLOPE,
    THRESHOLD,
    WORK,
    AreaForce,
    derivative,
)
from geocontact.identify.identifiability import Identifiability, identifiability
from geocontact.identify.intervals.block_bootstrap import Replicates, block_bootstrap
from geocontact.identify.intervals.profile_likelihood import Profile, profile
from geocontact.identify.noise.autocorrelation import Autocorrelation, autocorrelation_of
from geocontact.identify.optimise.least_squares import Fit
from geocontact.identify.optimise.least_squares import fit as least_squares
from geocontact.identify.optimise.quasi_newton import search, spread_starts

PAUSE = 3.0  # durations between one side's end and the next one's start: a residual forgets in less


def end_to_end(
    models: Sequence[AreaForce], measured: Sequence[Float[np.ndarray, " n"]]
) -> tuple[AreaForce, Float[np.ndarray, " m"]]:
    """One model, and its forces, of sides that share motion, reading, lag and threshold; one after another.

    The sides' residuals are taken for independent of each other: a pause parts them.
    """
    parts = [m.evolution for m in models]
    first = models[0]
    span = float(parts[0].time[-1] - parts[0].time[0])
    shifts = [k * (1.0 + PAUSE) * span for k in range(len(models))]
    tilts = [each.tilts for each in parts]
    flexions = [each.flexion for each in parts]
    evolution = replace(
        parts[0],
        time=np.concatenate([each.time + shift for each, shift in zip(parts, shifts, strict=True)]),
        area=np.concatenate([each.area for each in parts]),
        radius=np.concatenate([each.radius for each in parts]),
        tilts=_tilts([each for each in tilts if each is not None], len(parts)),
        flexion=None if any(f is None for f in flexions) else np.concatenate([f for f in flexions if f is not None]),
    )
    frames = np.concatenate([m.frames + shift for m, shift in zip(models, shifts, strict=True)])
    return replace(first, evolution=evolution, frames=frames), np.concatenate(measured)


def _tilts(known: Sequence[TiltedAreas], count: int) -> TiltedAreas | None:
    if len(known) < count:
        return None
    return TiltedAreas(known[0].offsets, np.concatenate([each.area for each in known]))


WEAKEST, STRONGEST = 1e3, 1e13  # bounds of E* [Pa]: softer than any gel, stiffer than diamond
STARTS = 8
REPLICATES = 1000
REFITS = 200  # replicates at most where more than E* is free and each is a search
FLAT = 1e-9  # of the force; a parameter that changes less within its bounds is not identified
SMALL = 1e-6  # of a threshold, a lag or an offset, for differences [m, s, rad, 1/rad]
NEAR = 1e-6  # of the range between bounds, or of the lower one: a value so near lies on it
PART = 1e-5  # of E*, E, R or a work of adhesion, for differences
POISSON = 0.25  # where the sensitivity to it is taken; which value does not matter
YOUNG, RATIO, RADIUS = "E", "nu", "R"


@dataclass(frozen=True, eq=False)
class Identification:
    """What one force curve tells of one area curve's law.

    Parameters
    ----------
    model, measured
        The law, and the force at its frames [N].
    fit, memory
        Least-squares estimates; how the residual remembers.
    profiles, replicates
        Intervals by profile likelihood, one per free parameter, and by block bootstrap (None where not asked for).
    told_apart
        Free parameters among themselves; (E, nu); (E*, R); and, where they could be free, E* with the others.
    """

    model: AreaForce
    measured: Float[np.ndarray, " n"]
    fit: Fit
    memory: Autocorrelation
    profiles: Mapping[str, Profile]
    replicates: Replicates | None
    told_apart: Mapping[str, Identifiability]

    @property
    def modulus(self) -> float:
        """E* [Pa]."""
        return self.fit.values[MODULUS]

    @property
    def predicted(self) -> Float[np.ndarray, " n"]:
        """Force by the law [N]."""
        return self.model.force(self.fit.values)

    @property
    def on_bound(self) -> tuple[str, ...]:
        """Free parameters whose interval reaches a bound."""
        return tuple(name for name, p in self.profiles.items() if p.lower_open or p.upper_open)


def moduli_of_poses(each: Identification, areas: Float[np.ndarray, "t k n"]) -> Float[np.ndarray, " n"]:
    """E* [Pa] with the area of each drawn pose instead, by least squares; other free parameters as identified.

    Parameters
    ----------
    areas
        Of each draw at the times and thresholds of the model's evolution [m^2].
    """
    found = np.empty(areas.shape[2])
    for k in range(len(found)):
        evolution = replace(each.model.evolution, area=np.ascontiguousarray(areas[:, :, k]))
        model = replace(each.model, evolution=evolution)
        found[k] = np.nan
        if model.per_modulus(each.fit.values).any():
            found[k] = model.refit(each.measured[None], each.fit.values, (WEAKEST, STRONGEST))[0, 0]
    return found


def agreement(measured: Float[np.ndarray, " n"], predicted: Float[np.ndarray, " n"]) -> tuple[float, float]:
    """Root mean square error, and R^2 about the mean of what was measured; below 0 a constant would do better."""
    off, varied = measured - predicted, measured - measured.mean()
    total = float(varied @ varied)
    return float(np.sqrt(np.mean(off**2))), 1.0 - float(off @ off) / total if total > 0.0 else float("nan")


def modulus_parameter() -> Parameter:
    """E* with its bounds."""
    return Parameter(MODULUS, "Pa", 1e7, WEAKEST, STRONGEST)


def fitted(
    model: AreaForce, measured: Float[np.ndarray, " n"], parameters: Sequence[Parameter], starts: int = STARTS
) -> Fit:
    """Least squares by bounded quasi-Newton from the parameters' own start and `starts` more.

    Each start takes E* that fits best beside its other values, which is known in closed form: the pull of JKR, which
    grows with the root of E*, makes a second minimum at no stiffness at all. With E* alone there is one start.
    """
    floor = np.array([max(float(np.sqrt(np.mean(measured**2))), np.finfo(float).tiny)])
    others = [p for p in parameters if p.name != MODULUS and not p.fixed]
    begin = []
    for start in spread_starts(parameters, starts if others else 0):
        values = {p.name: start.get(p.name, p.start) for p in others}
        if model.per_modulus(values).any():
            values[MODULUS] = float(model.refit(measured[None], values, (WEAKEST, STRONGEST))[0, 0])
        begin.append(values)
    return search(model.predict, [measured[:, None]], parameters, floor, begin)


def identify(
    model: AreaForce,
    measured: Float[np.ndarray, " n"],
    others: Sequence[Parameter] = (),
    replicates: int = REPLICATES,
    level: float = 0.95,
    starts: int = STARTS,
) -> Identification:
    """E* and the other free parameters of a model from the force at its frames.

    Parameters
    ----------
    others
        Free parameters besides E*: "threshold" [m], "lag" [s], "adduction" [rad], "slope" [1/rad], "work" [J/m^2].
    replicates
        Of the bootstrap; 0 for none.
    starts
        Of the search, besides the parameters' own.

    The force must be above 0 N somewhere. ValueError where a free parameter changes nothing at the best fit: neither
    it nor an interval of it is identified then.
    """
    parameters = (modulus_parameter(), *others)
    fit = fitted(model, measured, parameters, starts)
    jacobian = fit.jacobian[0][:, 0, :]
    if not np.isfinite(jacobian).all():
        raise ValueError("the law has no slope at the best fit")
    _require_effect(model, fit, others, jacobian)
    memory = autocorrelation_of(model.frames, fit.residuals[0][:, 0], jacobian[:, _inside(fit, parameters)])
    profiles = {
        name: profile(model.predict, measured, model.frames, parameters, fit, memory, name, level) for name in fit.names
    }
    drawn = _bootstrap(model, fit, memory, parameters, replicates, level) if replicates else None
    return Identification(model, measured, fit, memory, profiles, drawn, _told_apart(model, fit, jacobian))


def _require_effect(
    model: AreaForce, fit: Fit, others: Sequence[Parameter], jacobian: Float[np.ndarray, "n p"]
) -> None:
    size = float(np.linalg.norm(model.force(fit.values)))
    for one in others:
        slope = float(np.linalg.norm(jacobian[:, fit.names.index(one.name)]))
        if slope * (one.upper - one.lower) <= FLAT * size:
            raise ValueError(f"{one.name} is not identifiable: the areas do not change with it at the best fit")


def _inside(fit: Fit, parameters: Sequence[Parameter]) -> Bool[np.ndarray, " p"]:
    """Parameters that do not lie on a bound; E* always.

    On a bound the residual still holds what the parameter would take: the noise is estimated without its column.
    """
    bounds = {p.name: (p.lower, p.upper) for p in parameters}
    return np.array([name == MODULUS or _between(fit.values[name], *bounds[name]) for name in fit.names])


def _between(value: float, lower: float, upper: float) -> bool:
    """Further from both bounds than a search stops from them."""
    span = upper - lower
    return lower + NEAR * (min(span, abs(lower)) if lower else span) < value < upper - NEAR * span


def _bootstrap(
    model: AreaForce, fit: Fit, memory: Autocorrelation, parameters: Sequence[Parameter], count: int, level: float
) -> Replicates:
    best = np.array([fit.values[name] for name in fit.names])
    alone = fit.names == (MODULUS,)

    def refit(rows: Float[np.ndarray, "b n"]) -> Float[np.ndarray, "b p"]:
        if alone:
            return model.refit(rows, fit.values, (WEAKEST, STRONGEST))
        found = np.empty((len(rows), len(best)))
        for k, row in enumerate(rows):
            floor = np.array([float(np.sqrt(np.mean(row**2)))])
            values = least_squares(model.predict, [row[:, None]], parameters, floor, [fit.values]).values
            found[k] = [values[name] for name in fit.names]
        return found

    count = count if alone else min(count, REFITS)
    return block_bootstrap(model.frames, model.force(fit.values), fit.residuals[0][:, 0], memory, refit, count, level)


def _told_apart(model: AreaForce, fit: Fit, jacobian: Float[np.ndarray, "n p"]) -> dict[str, Identifiability]:
    """The groups of numbers that somebody may want to identify together."""
    star, values = fit.values[MODULUS], fit.values
    young = star * (1.0 - POISSON**2)
    sides = {YOUNG: young, RATIO: POISSON}

    def by_material(v: Mapping[str, float]) -> Float[np.ndarray, " n"]:
        return model.force({**values, MODULUS: plane_modulus(v[YOUNG], v[RATIO])})

    def by_radius(v: Mapping[str, float]) -> Float[np.ndarray, " n"]:
        evolution = replace(model.evolution, radius=model.evolution.radius * v[RADIUS])
        return replace(model, evolution=evolution).force({**values, MODULUS: v[MODULUS]})

    pair = np.column_stack([derivative(by_material, sides, name, PART * sides[name]) for name in sides])
    scaled = {MODULUS: star, RADIUS: 1.0}
    radius = np.column_stack([derivative(by_radius, scaled, name, PART * scaled[name]) for name in scaled])
    groups = {"E, nu": identifiability(("E", "nu"), pair), "E*, R": identifiability(("E*", "R"), radius)}
    full = {THRESHOLD: model.threshold, LAG: model.taken, **_offsets(model), **values}
    for name in [name for name in (THRESHOLD, LAG, ADDUCTION, SLOPE, WORK) if name in full]:
        if name == THRESHOLD and len(model.evolution.thresholds) == 1:
            continue
        step = PART * full[WORK] if name == WORK else SMALL
        columns = np.column_stack(
            [derivative(model.force, full, each, h) for each, h in ((MODULUS, PART * star), (name, step))]
        )
        if float(np.linalg.norm(columns[:, 1])) > 0.0:
            groups[f"E*, {name}"] = identifiability(("E*", name), columns)
    if len(fit.names) > 1:
        groups["free"] = identifiability(["E*" if name == MODULUS else name for name in fit.names], jacobian)
    return groups


def _offsets(model: AreaForce) -> dict[str, float]:
    """What else could be free, at nothing; a work of adhesion as given."""
    evolution = model.evolution
    known = ((ADDUCTION, evolution.tilts is not None), (SLOPE, evolution.flexion is not None))
    sticks = {} if model.adhesion is None else {WORK: model.adhesion.work}
    return {**{name: 0.0 for name, there in known if there}, **sticks}
