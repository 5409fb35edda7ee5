"""Problems of optimal control whose answers are known."""

from __future__ import annotations

import casadi
import numpy as np
from casadi import SX
from scipy.linalg import expm
from scipy.optimize import brentq

from geocontact.dynamics.collocation.problem import ControlledSystem, ControlledTrial, ControlProblem

G = 9.81


def system(x: SX, u: SX, rate: SX, *, cost: SX | float = 0.0, end_cost: SX | float = 0.0, **other) -> ControlledSystem:
    """An explicit differential equation under control."""
    parts = {"w": SX(0, 1), "p": SX(0, 1), "path": SX(0, 1), "prior": SX(0), "duration": SX.sym("T")} | other
    names = tuple(tuple(f"{n}{k}" for k in range(s.numel())) for n, s in (("x", x), ("u", u), ("p", parts["p"])))
    return ControlledSystem(x=x, u=u, rate=rate, cost=SX(cost), end_cost=SX(end_cost), names=names, **parts)


def trial(x0, x1, duration, guess_u, *, limit=np.inf) -> ControlledTrial:
    """From x0 to x1, NaN where the end is free; the search starts on a straight line."""
    x0, x1 = np.array(x0, float), np.array(x1, float)
    n, m, mean = len(x0), len(guess_u), float(np.mean(duration))
    free = np.isnan(x1)
    end = np.where(free, -np.inf, x1), np.where(free, np.inf, x1)
    target = np.where(free, 1.0, x1)
    wide = lambda k: (np.full(k, -np.inf), np.full(k, np.inf))  # noqa: E731
    line = lambda t: x0 + np.outer(t / mean, target - x0)  # noqa: E731
    return ControlledTrial(
        "trial",
        0.0,
        duration,
        wide(n),
        (np.full(m, -limit), np.full(m, limit)),
        (x0, x0),
        end,
        line,
        lambda t: np.tile(guess_u, (len(t), 1)),
    )


def exponential() -> tuple[ControlProblem, float]:
    """x' = u - x from 1, least integral of (x^2 + u^2)/2 over 1 s, end free: the last state by the Hamiltonian."""
    x, u = SX.sym("x"), SX.sym("u")
    one = system(x, u, u - x, cost=(x * x + u * u) / 2)
    flow = expm(np.array([[-1.0, -1.0], [-1.0, 1.0]]))
    costate = -flow[1, 0] / flow[1, 1]
    return ControlProblem(one, (trial([1.0], [np.nan], (1.0, 1.0), [0.0]),)), float(flow[0] @ [1.0, costate])


def move_to_rest() -> ControlProblem:
    """x'' = u from rest at 0 to rest at 1 in 1 s, least integral of u^2/2: x = 3t^2 - 2t^3, cost 6."""
    x, u = SX.sym("x", 2), SX.sym("u")
    return ControlProblem(
        system(x, u, casadi.vertcat(x[1], u), cost=u * u / 2), (trial([0, 0], [1, 0], (1.0, 1.0), [0.5]),)
    )


def quickest_move() -> ControlProblem:
    """The same in the least time with |u| <= 1: 2 s, full ahead and full back."""
    x, u, T = SX.sym("x", 2), SX.sym("u"), SX.sym("T")
    quick = system(x, u, casadi.vertcat(x[1], u), end_cost=T, duration=T)
    return ControlProblem(quick, (trial([0, 0], [1, 0], (0.5, 5.0), [0.1], limit=1.0),))


def brachistochrone() -> ControlProblem:
    """From rest at 0 to 1 m aside and 1 m down in the least time."""
    x, angle, T = SX.sym("x", 3), SX.sym("angle"), SX.sym("T")
    rate = casadi.vertcat(x[2] * casadi.cos(angle), x[2] * casadi.sin(angle), G * casadi.sin(angle))
    quick = system(x, angle, rate, end_cost=T, duration=T)
    return ControlProblem(quick, (trial([0, 0, 0], [1, 1, np.nan], (0.2, 1.0), [1.0], limit=2.0),))


def cycloid_time() -> float:
    """Of the cycloid through (1, 1): r (phi - sin phi) = r (1 - cos phi) = 1, T = phi sqrt(r/g)."""
    phi = brentq(lambda f: f - np.sin(f) - 1.0 + np.cos(f), 1.0, 4.0, xtol=1e-15)
    return float(phi * np.sqrt(1.0 / (1.0 - np.cos(phi)) / G))
