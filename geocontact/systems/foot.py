"""Prosthetic foot on level ground: spheres in zones, in the sagittal plane (variable-stiffness foot).

Inputs `x [m]`, `y [m]`, `pitch [rad]`; outputs `force_x [N]`, `force_y [N]`, `cop_x [m]` in the foot's frame, empty
where force_y < 20 N. Parameters k_<zone>, b_<zone>; constants n, delta_full, mu_s, mu_k, v_th; table `spheres`.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.chain.contact_law import CONTACT_LAW
from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.links import RECORDING, Balance, Channels, Law, Loads, Modifier, Motion, Sensor, Values
from geocontact.chain.magnitudes import Magnitudes
from geocontact.chain.system import System
from geocontact.chain.traits import Mass, Traits, Way
from geocontact.data.parameter import Parameter
from geocontact.geometry.kernels.compile import kernel
from geocontact.systems.base import Base, CaseNeeds, require_numbers
from geocontact.systems.foot_spheres import INPUTS, FootSpheres

OUTPUTS = ("force_x", "force_y", "cop_x")
UNITS = {"x": "m", "y": "m", "pitch": "rad", "force_x": "N", "force_y": "N", "cop_x": "m"}
CONSTANTS = {"n": "-", "delta_full": "m", "mu_s": "-", "mu_k": "-", "v_th": "m/s"}
POSITIVE = ("n", "delta_full", "v_th")
LETTERS = {"k": "N/m^n", "b": "N s/m"}
COLUMNS = ("px [m]", "py [m]", "radius [m]", "zone")
LEAST_FORCE = 20.0
"""Vertical force [N] below which a plate gives no centre of pressure."""
TRAITS = Traits(
    roles={"x": "travel"},
    pushes_only=True,
    plausible={"y": 0.16, "pitch": 0.15},
    way=Way(3.0, "deflection", load="force_y"),
    masses=(Mass(moved=INPUTS),),
)
"""Only the rate of x enters; pylon and liner give way by three deflections of the sole at the most."""


def resultant(loads: Loads) -> Float[np.ndarray, "t c"]:
    """Sums of the forces and their centre Σ F_n x / Σ F_n; NaN off the ground."""
    return np.asarray(sums(*(np.ascontiguousarray(each) for each in (loads.normal, loads.tangential, loads.arm))))


@kernel
def sums(
    normal: Float[np.ndarray, "t n"], tangential: Float[np.ndarray, "t n"], arm: Float[np.ndarray, "t n"]
) -> Float[np.ndarray, "t three"]:
    """Σ F_t, Σ F_n and Σ F_n x / Σ F_n of every sample, NaN where Σ F_n is not positive."""
    out = np.empty((normal.shape[0], 3))
    for i in range(normal.shape[0]):
        along = down = moment = 0.0
        for j in range(normal.shape[1]):
            along += tangential[i, j]
            down += normal[i, j]
            moment += normal[i, j] * arm[i, j]
        out[i, 0], out[i, 1] = along, down
        out[i, 2] = moment / down if down > 0.0 else np.nan
    return out


def without_centre(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
    """No centre of pressure where the measured vertical force is too small for one."""
    out = outputs.copy()
    out[np.abs(out[:, 1]) < LEAST_FORCE, 2] = np.nan
    return out


def zones_of(tables: Mapping[str, pd.DataFrame]) -> tuple[str, ...]:
    """Zone of each sphere; ValueError when there is no table of spheres, or one that cannot be."""
    if "spheres" not in tables:
        raise ValueError('foot: the table of spheres is missing; name it in case.toml, spheres = "spheres.csv"')
    table = tables["spheres"]
    for column in COLUMNS:
        if column not in table.columns:
            raise ValueError(f"foot: the spheres have no column {column!r}; they have {', '.join(map(str, table))}")
    for row, values in enumerate(table[list(COLUMNS[:3])].to_numpy(float), 1):
        if not np.isfinite(values).all():
            raise ValueError(f"foot: row {row} of the table spheres has a number that is not finite; correct it")
        if not values[2] > 0.0:
            what = f"row {row} of the table spheres has radius {values[2]:g} m, which must be positive"
            raise ValueError(f"foot: {what}; correct it or take the row out")
    return tuple(str(zone) for zone in table["zone"])


def numbers_of(zones: tuple[str, ...]) -> dict[str, str]:
    """Stiffness and damping of each zone, and what all have alike, with SI units."""
    own = {f"{letter}_{zone}": unit for letter, unit in LETTERS.items() for zone in dict.fromkeys(zones)}
    return own | CONSTANTS


def build(
    parameters: tuple[Parameter, ...], constants: Mapping[str, float], tables: Mapping[str, pd.DataFrame]
) -> System:
    """The base model; ValueError when a table, column or number that it needs is missing."""
    zones = zones_of(tables)
    needed = tuple(numbers_of(zones))
    positive = [name for name in needed if name in POSITIVE]
    not_negative = [name for name in needed if name not in positive]
    require_numbers("foot", needed, parameters, constants, positive=positive, not_negative=not_negative)
    place = [np.ascontiguousarray(tables["spheres"][column], float) for column in COLUMNS[:3]]
    return System(
        name="foot",
        motion=Motion(INPUTS),
        geometry=FootSpheres(place[0], place[1], place[2], zones),
        law=Law(CONTACT_LAW).having({name: name for name in CONSTANTS}),
        balance=Balance(OUTPUTS, resultant),
        sensor=Sensor(OUTPUTS, (Modifier("least_force", RECORDING, without_centre),)),
        parameters=parameters,
        constants=dict(constants),
        scale=Magnitudes(),
        units=UNITS,
        extent=float(np.ptp(place[0])),
        quotients={"cop_x": "force_y"},
        traits=TRAITS,
    )


NEEDS = CaseNeeds(
    "prosthetic foot of spheres on level ground",
    UNITS,
    lambda _channels, tables: numbers_of(zones_of(tables)),
    {"spheres": COLUMNS},
)
FOOT = Base("foot", INPUTS, OUTPUTS, build, needs=NEEDS)
