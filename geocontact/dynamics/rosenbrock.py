"""One step of a Rosenbrock method in symbols, of any equations of motion.

RODAS3 of Sandu, Verwer, Blom, Spee, Carmichael & Potra (1997), Benchmarking stiff ODE solvers for atmospheric chemistry
problems II: Rosenbrock solvers, Atmos Environ 31, 3459-3472; form without products of Jacobians, as in Hairer & Wanner
(1996), Solving ODEs II, sec. IV.7. Four linear systems share one matrix. Coordinates are eliminated, so that it has
the size of the rates and memories only, and rows of accelerations stay multiplied by the mass matrix.
"""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from geocontact.dynamics import equations, symbols
from geocontact.dynamics.equations import Equations, solved
from geocontact.dynamics.machine_code import Recipe
from geocontact.dynamics.symbols import entries

if TYPE_CHECKING:
    from casadi import SX, Function


ORDER = 3
GAMMA = 0.5
DRIFT = (0.5, 1.5, 0.0, 0.0)
"""What the derivative of the inputs counts in each stage."""
MEMORY = ((), (4.0,), (1.0, -1.0), (1.0, -1.0, -8.0 / 3.0))
"""What earlier stages count on the right-hand side, over the step."""


def rosenbrock_step(e: Equations) -> Function:
    """(x, h, w, w at the end, w', p) to (x at the end, error of it, x' at the start); x = (q, u, z), h the step [s].

    The first inputs are those at the start, w' their derivative there.
    """
    from casadi import SX, Function, densify, vertcat

    n = e.q.numel()
    h, later, slope = SX.sym("h"), SX.sym("later", e.w.numel()), SX.sym("slope", e.w.numel())
    x = vertcat(e.q, e.u, e.z)
    parts = Function("parts", e.state, [e.mass, e.force, e.growth])
    mass, force, growth = parts(*e.state)
    start = solved(mass, force)
    rest = [(e.u, force, growth)] * 2
    linear = _Linear(e, start, mass, h, slope)
    stages: list[SX] = []
    for stage, (drift, earlier) in enumerate(zip(DRIFT, MEMORY, strict=True)):
        if stage >= 2:
            there = x + 2.0 * stages[0] + (stages[2] if stage == 3 else 0.0)
            at = _split(there, n)
            own, acting, grown = parts(*at, later, e.p)
            rest.append((at[1], mass @ solved(own, acting), grown))
        right = list(rest[stage])
        right[1] = right[1] + drift * h * linear.drift_force
        right[2] = right[2] + drift * h * linear.drift_growth
        for weight, one in zip(earlier, stages, strict=True):
            of_q, of_u, of_z = _split(one, n)
            right[0] = right[0] + weight / h * of_q
            right[1] = right[1] + weight / h * (mass @ of_u)
            right[2] = right[2] + weight / h * of_z
        stages.append(linear.solved(*right))
    found = x + 2.0 * stages[0] + stages[2] + stages[3]
    rate = vertcat(e.u, start, growth)
    given = [x, h, e.w, later, slope, e.p]
    names = ["x", "h", "w", "later", "slope", "p"]
    outputs = [densify(found), densify(stages[3]), densify(rate)]
    return Function("step", given, outputs, names, ["end", "error", "rate"])


def step_recipe(e: Equations) -> Recipe:
    """`rosenbrock_step`, made only where its machine code is not kept: it takes ten times as long as to look it up."""
    from casadi import Function

    size = 2 * e.q.numel() + e.z.numel()
    written = Function("equations", [*e.state, e.a], [e.balance, e.growth]).serialize()
    sizes = (size, 1, e.w.numel(), e.w.numel(), e.w.numel(), e.p.numel())
    return Recipe(f"{step_source()} {written}", sizes, (size, size, size), lambda: without_repeats(rosenbrock_step(e)))


def without_repeats(function: Function) -> Function:
    """The same function, each operation done once: the stages of a step share a seventh of theirs; equal results."""
    from casadi import SX, Function, cse

    given = [SX.sym(function.name_in(k), function.sparsity_in(k)) for k in range(function.n_in())]
    return Function(function.name(), given, cse(list(function.call(given))), function.name_in(), function.name_out())


@cache
def step_source() -> str:
    """Text of all modules that make a step of its equations, in a sum."""
    texts = [Path(file).read_bytes() for file in (__file__, equations.__file__, symbols.__file__)]
    return hashlib.sha256(b"\0".join(texts)).hexdigest()


def tangent_step(step: Function) -> Function:
    """The step's arguments and dx/dp at its start to dx/dp at its end and the derivative of x' at the start by p."""
    from casadi import SX, Function, densify, jtimes, vertcat

    given = [SX.sym(step.name_in(i), step.size1_in(i)) for i in range(step.n_in())]
    x, p = given[0], given[5]
    found, _, rate = step(*given)
    turned = SX.sym("turned", x.numel(), p.numel())
    both, seeds = vertcat(x, p), vertcat(turned, SX.eye(p.numel()))
    outputs = [densify(jtimes(found, both, seeds)), densify(jtimes(rate, both, seeds))]
    return Function("tangent", [*given, turned], outputs)


def _split(x: SX, n: int) -> tuple[SX, SX, SX]:
    """The parts of a state, or of its change, that belong to n coordinates, their rates and the memories."""
    return entries(x, slice(n)), entries(x, slice(n, 2 * n)), entries(x, slice(2 * n, None))


class _Linear:
    """(1/(h γ) - J) K = F at the start of a step, the row of the rates times the mass matrix.

    `drift_force` and `drift_growth` are what the inputs' derivative `slope` adds to force and growth per second.
    """

    def __init__(self, e: Equations, start: SX, mass: SX, h: SX, slope: SX) -> None:
        from casadi import SX, blockcat, jacobian, jtimes, substitute

        def there(of: SX, by: SX) -> SX:
            return substitute(jacobian(of, by), e.a, start)

        self.n, self.hg = e.q.numel(), GAMMA * h
        self.force_q, force_u, force_z = (there(e.balance, by) for by in (e.q, e.u, e.z))
        self.growth_q, growth_u, growth_z = (jacobian(e.growth, by) for by in (e.q, e.u, e.z))
        along = [jtimes(of, e.w, slope) for of in (e.balance, e.growth)]  # one direction, not a column for each input
        self.drift_force, self.drift_growth = substitute(along[0], e.a, start), along[1]
        rates = mass / self.hg - force_u - self.hg * self.force_q
        memories = SX.eye(e.z.numel()) / self.hg - growth_z
        matrix = blockcat([[rates, -force_z], [-growth_u - self.hg * self.growth_q, memories]])
        self.factors = _Factors(matrix)

    def solved(self, speed: SX, force: SX, growth: SX) -> SX:
        """K of the right-hand sides of coordinates, rates (times the mass matrix) and memories."""
        from casadi import vertcat

        found = self.factors.solved(
            vertcat(force + self.hg * (self.force_q @ speed), growth + self.hg * (self.growth_q @ speed))
        )
        return vertcat(self.hg * (entries(found, slice(self.n)) + speed), found)


class _Factors:
    """L U of a small matrix in symbols, without exchange of rows: for short steps it is little but the mass matrix.

    Where it fails numbers become infinite, and the step is tried again shorter.
    """

    def __init__(self, matrix: SX) -> None:
        self.rows = matrix.size1()
        self.lu = {(i, j): matrix[i, j] for i in range(self.rows) for j in range(self.rows) if _there(matrix[i, j])}
        for k in range(self.rows):
            below = [i for i in range(k + 1, self.rows) if (i, k) in self.lu]
            right = [j for j in range(k + 1, self.rows) if (k, j) in self.lu]
            for i in below:
                self.lu[i, k] = self.lu[i, k] / self.lu[k, k]
                for j in right:
                    product = self.lu[i, k] * self.lu[k, j]
                    self.lu[i, j] = self.lu[i, j] - product if (i, j) in self.lu else -product

    def solved(self, right: SX) -> SX:
        """The solution for one right-hand side."""
        from casadi import vertcat

        x = [right[i] for i in range(self.rows)]
        for i in range(self.rows):
            for j in range(i):
                if (i, j) in self.lu:
                    x[i] = x[i] - self.lu[i, j] * x[j]
        for i in reversed(range(self.rows)):
            for j in range(i + 1, self.rows):
                if (i, j) in self.lu:
                    x[i] = x[i] - self.lu[i, j] * x[j]
            x[i] = x[i] / self.lu[i, i]
        return vertcat(*x)


def _there(entry: SX) -> bool:
    return not entry.is_zero()
