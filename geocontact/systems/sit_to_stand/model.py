"""Exoskeleton strapped to a body that stands up: normal force of the pressure mat at each site, F = k_n u + b u'.

u = normal + ρ rotation, the displacement of the exoskeleton against the body segment at the nominal attachment. Sites
are those of pelvis, thigh and shank that have a stiffness. Inputs `<site>_normal [m]`, `<site>_tangential [m]`,
`<site>_rotation [rad]`, of which the base does not use the tangential one; output `<site>_force [N]`. Parameters
k_n_<site> [N/m], rho_<site> [m]; constant b [N s/m].
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.chain.interface_law import INTERFACE_LAW
from geocontact.chain.links import Balance, Law, Loads, Motion, Sensor
from geocontact.chain.magnitudes import Magnitudes
from geocontact.chain.system import System
from geocontact.chain.traits import Role, Traits, Way
from geocontact.data.parameter import Parameter
from geocontact.systems.base import Base, require_numbers
from geocontact.systems.sit_to_stand.sites import SITE_GEOMETRY, InterfaceSites

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


def measured_forces(loads: Loads) -> Float[np.ndarray, "t c"]:
    """Each site's load is an output."""
    return loads.normal.copy()


def build(
    parameters: tuple[Parameter, ...], constants: Mapping[str, float], tables: Mapping[str, pd.DataFrame]
) -> System:
    """The base model; ValueError when a number that it needs is neither parameter nor constant."""
    sites = sites_of(parameters, constants)
    needed = [f"{number}_{site}" for number in ("k_n", "rho") for site in sites]
    require_numbers("sit_to_stand", (*needed, "b"), parameters, constants)
    inputs, outputs = channels(sites)
    law = {f"{site}.k": f"k_n_{site}" for site in sites} | {f"{site}.b": "b" for site in sites}
    units = {f"{site}_{motion}": unit for site in sites for motion, unit in MOTIONS.items()}
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
        units={**units, **dict.fromkeys(outputs, "N")},
        spare=tuple(f"{site}_tangential" for site in sites),
        places=sites,
        traits=traits,
    )


SIT_TO_STAND = Base("sit_to_stand", *channels(SITES), build)
"""Channels are those of all sites; a case may have fewer."""
