"""Exoskeleton strapped to a body that stands up: normal force at each site, one deflection per site.

Each site has a spring, a dashpot and a memory of its own; sites do not feel each other.

u = normal + ρ rotation, the displacement of the exoskeleton against the body segment at the nominal attachment. Sites
are those of pelvis, thigh and shank that have a stiffness. Inputs `<site>_normal [m]`, `<site>_tangential [m]`,
`<site>_rotation [rad]`, of which the base does not use the tangential one; output `<site>_force [N]`. Parameters
k_n_<site> [N/m], rho_<site> [m]; constant b [N s/m].
"""

from __future__ import annotations

import functools
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.interface_law import INTERFACE_LAW
from geocontact.chain.links import Balance, Law, LawParameters, Loads, Motion, Sensor, Source, Values
from geocontact.chain.magnitudes import Magnitudes
from geocontact.chain.single_deflection import along, in_series, known_changes
from geocontact.chain.system import System, require_convergence
from geocontact.chain.traits import Role, Traits, Way
from geocontact.data.parameter import Parameter
from geocontact.geometry.kernels.compile import kernel
from geocontact.systems.base import Base, CaseNeeds, require_numbers

SITE_GEOMETRY = LawParameters(
    {
        "rho": 0.0,
        "axis_migration.slope": 0.0,
        "axis_migration.curvature": 0.0,
        "axis_migration.centre": 0.0,
        "series_compliance.compliance": 0.0,
        "series_compliance.exponent": 1.0,
        "series_compliance.reference": 1.0,
    }
)
"""Numbers of one site in the order in which the kernels read them."""
COMPLIANCE = 4


@kernel
def deflected(
    position: Float[np.ndarray, "i t"],
    speed: Float[np.ndarray, "i t"],
    rows: Int[np.ndarray, "s two"],
    numbers: Float[np.ndarray, "s seven"],
) -> tuple[Float[np.ndarray, "s t"], Float[np.ndarray, "s t"]]:
    """u = normal + ρ φ and its rate, ρ = ρ0 + a ψ + c ψ², ψ the rotation φ from the middle of its range.

    `rows` are those of the normal displacement and of the rotation of each site.
    """
    u, rate = np.empty((len(rows), position.shape[1])), np.empty((len(rows), position.shape[1]))
    for s in range(len(rows)):
        rho0, slope, bend, centre = numbers[s, 0], numbers[s, 1], numbers[s, 2], numbers[s, 3]
        normal, rotation = rows[s, 0], rows[s, 1]
        for i in range(position.shape[1]):
            turn = position[rotation, i]
            angle = turn - centre
            rho = rho0 + angle * (slope + bend * angle)
            u[s, i] = position[normal, i] + rho * turn
            rate[s, i] = speed[normal, i] + speed[rotation, i] * (rho + turn * (slope + 2.0 * bend * angle))
    return u, rate


@kernel
def carried(
    time: Float[np.ndarray, " t"],
    position: Float[np.ndarray, "i t"],
    speed: Float[np.ndarray, "i t"],
    rows: Int[np.ndarray, "s two"],
    numbers: Float[np.ndarray, "s seven"],
    law: Float[np.ndarray, "s numbers"],
) -> tuple[Float[np.ndarray, "t s"], int]:
    """Load of every site, and how many samples have no solution behind a spring in series."""
    u, rate = deflected(position, speed, rows, numbers)
    out = np.empty((time.size, len(rows)))
    straight = np.array([[0.0, 1.0], [0.0, 1.0], [1.0, 1.0]])
    unsolved = 0
    for s in range(len(rows)):
        if numbers[s, COMPLIANCE] == 0.0:
            out[:, s] = along(time, u[s], rate[s], law[s])
        else:
            out[:, s], missed = in_series(time, u[s], rate[s], straight, numbers[s, COMPLIANCE:], law[s])
            unsolved += missed
    return out, unsolved


@functools.lru_cache(maxsize=32)
def rows_of(sites: tuple[str, ...], inputs: tuple[str, ...]) -> Int[np.ndarray, "s two"]:
    """Places of the normal displacement and of the rotation of each site among the inputs."""
    return np.array([[inputs.index(f"{site}_{motion}") for motion in ("normal", "rotation")] for site in sites])


@dataclass(frozen=True)
class InterfaceSites:
    """Geometry link: at each site the exoskeleton moves against the body along the normal and about the attachment.

    Parameters
    ----------
    sites
        Names that the channels begin with ("thigh_normal").
    slots
        Numbers of all sites, "thigh.rho"; of a single one without its name.
    """

    sites: tuple[str, ...]
    slots: LawParameters

    @property
    def yields(self) -> str:
        """What gives way to a spring in series: the normal displacement, here that of the first site."""
        return f"{self.sites[0]}_normal"

    def having(self, sources: Mapping[str, Source]) -> InterfaceSites:
        """The same link with more of its numbers coming from somewhere."""
        return replace(self, slots=self.slots.having(sources))

    def at(self, place: str) -> InterfaceSites:
        """One site alone."""
        return InterfaceSites((place,), self.slots.at(place))

    def deflection(
        self, movement: DifferentiatedInputs, values: Values
    ) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "t n"]]:
        """u [m] and u' [m/s] of each site, nothing giving way."""
        rows = rows_of(self.sites, movement.inputs)
        u, rate = deflected(movement.position, movement.rate, rows, self._numbers(values))
        return u.T, rate.T

    def loads(self, movement: DifferentiatedInputs, law: Law, values: Values) -> Loads:
        """Force of each site along a movement, each with a memory of its own."""
        numbers, rows = self._numbers(values), rows_of(self.sites, movement.inputs)
        of_law = law.slots.numbers(values).reshape(len(self.sites), -1)
        normal, unsolved = carried(movement.time, movement.position, movement.rate, rows, numbers, of_law)
        require_convergence(unsolved, normal.size, numbers[:, COMPLIANCE].max())
        nothing = np.zeros_like(normal)
        return Loads(normal, nothing, nothing)

    def changes(
        self, movement: DifferentiatedInputs, law: Law, values: Values, others: Sequence[Values]
    ) -> tuple[Loads, list[Loads | None]] | None:
        """Forces along a movement, and how they change towards other values (`chain.system`)."""
        return known_changes(self, movement, law, values, others, by_slots=True)

    def _numbers(self, values: Values) -> Float[np.ndarray, "s seven"]:
        return self.slots.numbers(values).reshape(len(self.sites), -1)


SITES = ("pelvis", "thigh", "shank")
MOTIONS = {"normal": "m", "tangential": "m", "rotation": "rad"}
ROLES: dict[str, Role] = {"normal": "displacement", "tangential": "displacement", "rotation": "turn"}
"""Motions are those of the exoskeleton against the body, not in space."""
BIAS = 2.5
"""Largest plausible bias of a displacement over its half-range."""


def channels(sites: tuple[str, ...]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Inputs and outputs."""
    return tuple(f"{site}_{motion}" for site in sites for motion in MOTIONS), tuple(f"{site}_force" for site in sites)


def sites_of(parameters: tuple[Parameter, ...], constants: Mapping[str, float]) -> tuple[str, ...]:
    """Sites that have a stiffness; ValueError when there is none, or one that is not known."""
    named = [name.removeprefix("k_n_") for name in (*(p.name for p in parameters), *constants) if name[:4] == "k_n_"]
    for site in named:
        if site not in SITES:
            raise ValueError(f"sit_to_stand: no site {site} (k_n_{site}); there are {', '.join(SITES)}")
    if not named:
        raise ValueError(f"sit_to_stand: no stiffness is given; name k_n_<site> for at least one of {', '.join(SITES)}")
    return tuple(site for site in SITES if site in named)


def units_of(sites: tuple[str, ...]) -> dict[str, str]:
    """SI units of the channels."""
    inputs = {f"{site}_{motion}": unit for site in sites for motion, unit in MOTIONS.items()}
    return inputs | {f"{site}_force": "N" for site in sites}


def numbers_of(sites: tuple[str, ...]) -> dict[str, str]:
    """Numbers of the sites with SI units."""
    own = {f"{number}_{site}": unit for number, unit in (("k_n", "N/m"), ("rho", "m")) for site in sites}
    return own | {"b": "N s/m"}


def recorded_sites(names: Collection[str]) -> tuple[str, ...]:
    """Sites with a channel among these names, all where none has."""
    return tuple(site for site in SITES if any(each in names for each in units_of((site,)))) or SITES


def measured_forces(loads: Loads) -> Float[np.ndarray, "t c"]:
    """Each site's load is an output."""
    return loads.normal.copy()


def build(
    parameters: tuple[Parameter, ...], constants: Mapping[str, float], tables: Mapping[str, pd.DataFrame]
) -> System:
    """The base model; ValueError when a number that it needs is neither parameter nor constant."""
    sites = sites_of(parameters, constants)
    positive = [f"k_n_{site}" for site in sites]
    needed = tuple(numbers_of(sites))
    require_numbers("sit_to_stand", needed, parameters, constants, positive=positive, not_negative=("b",))
    inputs, outputs = channels(sites)
    law = {f"{site}.k": f"k_n_{site}" for site in sites} | {f"{site}.b": "b" for site in sites}
    traits = Traits(
        roles={f"{site}_{motion}": role for site in sites for motion, role in ROLES.items()},
        pushes_only=True,
        plausible={f"{site}_normal": BIAS for site in sites},
        way=Way(1.0, "deflection"),
    )
    return System(
        name="sit_to_stand",
        motion=Motion(inputs),
        geometry=InterfaceSites(sites, SITE_GEOMETRY.apart(sites)).having({f"{s}.rho": f"rho_{s}" for s in sites}),
        law=Law(INTERFACE_LAW.apart(sites)).having(law).lacking(*(f"{site}.asymmetry.excess" for site in sites)),
        balance=Balance(outputs, measured_forces),
        sensor=Sensor(outputs),
        parameters=parameters,
        constants=dict(constants),
        scale=Magnitudes(),
        units=units_of(sites),
        spare=tuple(f"{site}_tangential" for site in sites),
        places=sites,
        traits=traits,
    )


NEEDS = CaseNeeds(
    "exoskeleton strapped to a body that stands up",
    units_of(SITES),
    lambda names, _tables: numbers_of(recorded_sites(names)),
)
SIT_TO_STAND = Base("sit_to_stand", *channels(SITES), build, needs=NEEDS)
"""Channels are those of all sites; a case may have fewer."""
