"""Bodies in motion as a controlled system: implicit dynamics, the jerk as control.

States are coordinates, rates, accelerations and the laws' memory; q' = u, u' = a, a' = jerk, and the balance of forces
is held at 0 at every collocation point and at the start. A jerk for each collocation point: one for each interval has
fewer unknowns than equations once all torques are given.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from geocontact.dynamics.collocation.problem import ControlledSystem
from geocontact.dynamics.equations import Equations
from geocontact.dynamics.symbols import entries

if TYPE_CHECKING:
    from casadi import SX


def jerk_controlled(
    equations: Equations,
    *,
    controlled: Sequence[int] = (),
    control_names: Sequence[str] = (),
    data: SX | None = None,
    jerk: SX | None = None,
    cost: SX | float = 0.0,
    prior: SX | float = 0.0,
    parameter_names: Sequence[str] = (),
) -> ControlledSystem:
    """The equations' motion under jerk, and those of their inputs that are sought.

    Parameters
    ----------
    controlled, control_names
        Which of `equations.w` are controls, such as torques; the others are given over time.
    data
        Further inputs over time that only the cost knows, such as what is tracked; they follow the equations' own.
    jerk
        The symbol that the cost calls the jerk, (n, 1).
    cost, prior
        Integrated over time; of the parameters.
    """
    from casadi import SX, vertcat

    e = equations
    n = len(e.names)
    jerk = SX.sym("jerk", n) if jerk is None else jerk
    given = [k for k in range(e.w.numel()) if k not in controlled]
    memory = tuple(f"memory {k}" for k in range(e.z.numel()))
    states = (*e.names, *(f"{x}'" for x in e.names), *(f"{x}''" for x in e.names), *memory)
    return ControlledSystem(
        x=vertcat(e.q, e.u, e.a, e.z),
        u=vertcat(jerk, entries(e.w, list(controlled))),
        w=vertcat(entries(e.w, given), SX(0, 1) if data is None else data),
        p=e.p,
        duration=SX.sym("duration"),
        rate=vertcat(e.u, e.a, jerk, e.growth),
        path=e.balance,
        cost=SX(cost),
        end_cost=SX(0),
        prior=SX(prior),
        names=(states, (*(f"{x}'''" for x in e.names), *control_names), tuple(parameter_names)),
        path_at_start=tuple(range(n)),
    )
