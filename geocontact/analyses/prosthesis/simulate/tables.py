"""Tables of a simulated stance, of its errors, and of all numbers with their sources."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd

from geocontact.below_knee_prosthesis.foot_numbers import foot_numbers, socket_numbers
from geocontact.below_knee_prosthesis.from_markers.sides import of_side
from geocontact.below_knee_prosthesis.keel.vsf_foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.model.leg import Leg, Side
from geocontact.below_knee_prosthesis.model.leg_tree import GRAVITY, SOCKET
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.below_knee_prosthesis.stance_errors import StanceErrors
from geocontact.contact.bushing import Bushing
from geocontact.data.sourced_number import Number

UNITS = {"impulse": "s"}
"""Of quantities that are not shares: forces are over body weight, centres of pressure over the foot's length."""


def stance_table(s: Stance, side: Side) -> pd.DataFrame:
    """Over time; forces and places in the laboratory's frame."""
    force, ground, sphere = (of_side(each, side) for each in (s.force, s.centre("ground"), s.centre("sphere")))
    return pd.DataFrame(
        {
            "time [s]": s.time,
            **{f"force_{axis} [N]": column for axis, column in zip("xyz", force.T, strict=True)},
            **{f"cop_{axis} [mm]": 1e3 * column for axis, column in zip("xz", ground[:, ::2].T, strict=True)},
            **{f"sphere_cop_{axis} [mm]": 1e3 * column for axis, column in zip("xz", sphere[:, ::2].T, strict=True)},
            "cop along foot [-]": s.along_foot("ground"),
            "sphere cop along foot [-]": s.along_foot("sphere"),
            "ankle moment [N m]": s.ankle_moment,
            "stored [J]": s.stored,
            "lost [J]": s.lost,
            **{
                f"{name} [deg]": np.degrees(column)
                for name, column in zip(SOCKET[:3], s.found.q[:, 2:5].T, strict=True)
            },
            **{f"{name} [mm]": 1e3 * column for name, column in zip(SOCKET[3:], s.found.q[:, 5:8].T, strict=True)},
            **{f"{name} moment [N m]": column for name, column in zip(SOCKET[:3], s.socket[:, :3].T, strict=True)},
            **{f"{name} force [N]": column for name, column in zip(SOCKET[3:], s.socket[:, 3:].T, strict=True)},
            **{f"{zone} [N]": s.loads.pressing[:, of].sum(axis=1) for zone, of in s.foot.sole.spheres.zones.items()},
        }
    )


def errors_table(errors: StanceErrors) -> pd.DataFrame:
    """R² and root mean square error by quantity, and the stance's length."""
    rows = [(name, UNITS.get(name, "-"), r2, off) for name, (r2, off) in errors.table.items()]
    rows.append(("stance", "s", np.nan, errors.stance[0] - errors.stance[1]))
    return pd.DataFrame(rows, columns=["quantity", "unit", "r2 [-]", "rmse"])


def curves_table(errors: StanceErrors) -> pd.DataFrame:
    """Simulated and measured curves over 101 points of the plate's stance."""
    columns = {"stance [-]": errors.share}
    for name, (model, measured) in errors.curves.items():
        unit = UNITS.get(name, "-")
        columns |= {f"{name} [{unit}]": model, f"{name} measured [{unit}]": measured}
    return pd.DataFrame(columns)


def all_numbers(leg: Leg, foot: VariableStiffnessFoot, fulcrum: float, bushing: Bushing) -> Mapping[str, Number]:
    """Of leg, socket, keel and sole as they were simulated, in SI; motion, plates and ground are in files and options.

    What is also fixed: a pinned end of the keel (`Keel.compliance` tells its hinges from EI and fulcrum).
    """
    return leg_numbers(leg) | socket_numbers(bushing) | numbers_without_leg(foot, fulcrum)


def leg_numbers(leg: Leg) -> dict[str, Number]:
    """By name, in SI; height and pitch of the foot beside its standing trial are in `leg keel` and `leg turn`."""
    return {f"leg {name}": number for name, number in leg.numbers().items()}


def numbers_without_leg(foot: VariableStiffnessFoot, fulcrum: float) -> dict[str, Number]:
    """Of keel and sole, and gravity."""
    return foot_numbers(foot, fulcrum) | {"gravity": Number(GRAVITY, "derived", "standard gravity")}


def numbers_of(s: Stance) -> Mapping[str, Number]:
    """`all_numbers` of a stance that was simulated."""
    return all_numbers(s.motion.leg, s.foot, s.fulcrum, s.bushing)


def numbers_table(numbers: Mapping[str, Number]) -> pd.DataFrame:
    """Every number in SI, and where it is from."""
    rows = [(name, number.value, number.source, number.note) for name, number in numbers.items()]
    return pd.DataFrame(rows, columns=["number", "value", "source", "note"])
