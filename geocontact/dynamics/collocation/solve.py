"""The problem solved by IPOPT with MUMPS, on a mesh that is refined where the balance needs it.

Halved on its own an interval of degree d leaves about 2^-d of what it left, where the motion is smooth.
"""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from time import process_time
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.blocks import SparseProgram, sparse_program
from geocontact.dynamics.collocation.certificate import CertificateLimits, fine_residual, interval_residuals
from geocontact.dynamics.collocation.motion import CollocatedMotion, scheme
from geocontact.dynamics.collocation.multipliers import carried, nested
from geocontact.dynamics.collocation.problem import ControlProblem, checked
from geocontact.dynamics.collocation.transcription import Mesh, Transcription, scales_from

if TYPE_CHECKING:
    from types import FrameType


MOST_HALVINGS = 4
"""Halvings of an interval, at the most: to a sixteenth of its first length."""
ROUGH = 1e-3
"""Tolerance on meshes that are halved afterwards: what they leave of the balance is then known to a hundredth."""

FEW_NEW = 1.25
"""Times as many intervals below which a mesh may be the last: to solve it again takes longer than a few iterations."""


def rough(options: SolverOptions) -> SolverOptions:
    """The same with the tolerance of meshes on the way."""
    return replace(options, tolerance=max(options.tolerance, ROUGH))


def refined(
    problem: ControlProblem,
    found: CollocationResult,
    options: SolverOptions,
    turning: Sequence[bool],
    limits: CertificateLimits | None = None,
    progress: Progress | None = None,
) -> CollocationResult:
    """Solve again, from what was found, on meshes of `halved`, until no interval leaves more than the limits let pass.

    At most `MOST_HALVINGS` times, and no further where a search was not solved; iterations and seconds are those of all
    searches, and the options' seconds hold for all of them. Meshes on the way are solved to `ROUGH`, the last one, and
    any that may be the last, to the options' tolerance.

    Parameters
    ----------
    found
        Solved to any tolerance.
    turning
        Of each coordinate: whether it is an angle, so that its balance is in N m.
    """
    began, iterations, seconds, halvings = process_time(), found.iterations, found.seconds, 0
    while found.solved:
        meshes = halved(problem, found, turning, limits) if halvings < MOST_HALVINGS else found.meshes
        new, old = ([len(mesh) - 1 for mesh in each] for each in (meshes, found.meshes))
        same, few = new == old, sum(new) < FEW_NEW * sum(old)
        if same and found.tolerance <= options.tolerance:
            break
        halvings += not same
        left = max(options.seconds - seconds - (process_time() - began), 1e-3)
        chosen = replace(options if same or few else rough(options), seconds=left)
        found = solve(problem, chosen, meshes=meshes, warm=found, progress=progress)
        iterations += found.iterations
    return replace(found, iterations=iterations, seconds=seconds + process_time() - began)


def halved(
    problem: ControlProblem,
    found: CollocationResult,
    turning: Sequence[bool],
    limits: CertificateLimits | None = None,
    shortest: Sequence[float] | None = None,
) -> tuple[Mesh, ...]:
    """Meshes with every interval halved that somewhere leaves more of the balance than the limits let pass.

    Parameters
    ----------
    shortest
        Of each trial, in parts of it: intervals are not halved to less.
    """
    limit, finer = limits or CertificateLimits(), []
    least = shortest or [0.0] * len(found.meshes)
    for trial, motion, mesh, part in zip(problem.trials, found.motions, found.meshes, least, strict=True):
        left = fine_residual(problem.system, trial, motion, found.p, turning)
        force, moment = (of.reshape(len(mesh) - 1, -1).max(axis=1) for of in (left.force, left.moment))
        middle = 0.5 * (mesh[:-1] + mesh[1:])
        coarse = np.diff(mesh) > 1.5 * part  # halved once more, lengths are parts or twice them, but for rounding
        finer.append(np.sort(np.r_[mesh, middle[coarse & ((force > limit.force) | (moment > limit.moment))]]))
    return tuple(finer)


Vector = Float[np.ndarray, " _"]


@runtime_checkable
class Stoppable(Protocol):
    """A search that looks at `stop` now and then."""

    stop: bool


Progress = Callable[[int, float, float], None]
"""Iteration, objective, largest violation of a scaled constraint."""

STALLED = "Solved_To_Acceptable_Level", "Search_Direction_Becomes_Too_Small", "Error_In_Step_Computation"
"""Endings before the tolerance that rounding may be the cause of."""
ENDINGS = {
    "Solve_Succeeded": "solved",
    "At_Rounding": "solved as closely as the variables' digits let",
    "Solved_To_Acceptable_Level": "solved, but not to the tolerance",
    "Infeasible_Problem_Detected": "no motion meets the constraints near where the search ended",
    "Maximum_Iterations_Exceeded": "out of iterations",
    "Maximum_CpuTime_Exceeded": "out of time",
    "Maximum_WallTime_Exceeded": "out of time",
    "User_Requested_Stop": "interrupted; the last iterate is saved",
    "Restoration_Failed": "the search found no way back to the constraints",
    "Error_In_Step_Computation": "no step could be worked out",
    "Search_Direction_Becomes_Too_Small": "the search came to a stop before the tolerance",
    "Invalid_Number_Detected": "a function or derivative is not a number",
}


@dataclass(frozen=True)
class SolverOptions:
    """How a problem is discretised and solved.

    Parameters
    ----------
    kind, degree
        radau or legendre, and how many points an interval has.
    intervals
        Of every trial, even, unless meshes are given.
    tolerance
        Of the scaled problem.
    iterations, seconds
        At most so many, and CPU seconds.
    refinements
        How often intervals may be halved.
    residual
        Scaled residual between the points above which an interval is halved.
    """

    kind: str = "radau"
    degree: int = 3
    intervals: int = 50
    tolerance: float = 1e-8
    iterations: int = 1000
    seconds: float = 600.0
    refinements: int = 0
    residual: float = 1e-3


@dataclass(frozen=True)
class CollocationResult:
    """What was found, and how the search ended.

    Parameters
    ----------
    solved
        Whether the tolerance was met, or missed by no more than the last digits of the variables change.
    ending
        In words.
    motions, p
        One for each trial, and the parameters.
    objective, violation
        Cost, and largest violation of a scaled constraint.
    iterations, seconds
        Taken, CPU seconds, over all meshes.
    meshes
        The last.
    multipliers
        Of the last problem: of the bounds and of the constraints, for the next start.
    tolerance
        To which it was searched.
    """

    solved: bool
    ending: str
    motions: tuple[CollocatedMotion, ...]
    p: Vector
    objective: float
    violation: float
    iterations: int
    seconds: float
    meshes: tuple[Mesh, ...]
    multipliers: tuple[Vector, Vector]
    tolerance: float


def solve(
    problem: ControlProblem,
    options: SolverOptions | None = None,
    *,
    meshes: tuple[Mesh, ...] | None = None,
    warm: CollocationResult | None = None,
    progress: Progress | None = None,
) -> CollocationResult:
    """Solve, and halve intervals whose residual is too large as often as the options allow.

    Ctrl-C ends the search after the present iteration and keeps it.

    Parameters
    ----------
    warm
        A result of the same problem on any mesh, from which the search starts instead.

    InputError where the problem cannot be meant.
    """
    o = options or SolverOptions()
    checked(problem)
    points = scheme(o.kind, o.degree)
    on = meshes or tuple(np.linspace(0.0, 1.0, o.intervals + 1) for _ in problem.trials)
    scales, began, iterations = scales_from(problem), time.process_time(), 0
    for left in range(o.refinements, -1, -1):
        transcription = Transcription(problem, points, on, scales)
        found = _solved(transcription, o, warm, progress, o.seconds - (time.process_time() - began))
        iterations += found.iterations
        if not left or not found.solved:
            break
        finer = _refined(problem, found, scales.x, scales.path, o.residual)
        if all(len(a) == len(b) for a, b in zip(on, finer, strict=True)):
            break
        warm, on = found, finer
    return CollocationResult(**{**vars(found), "iterations": iterations, "seconds": time.process_time() - began})


def _solved(
    on: Transcription, o: SolverOptions, warm: CollocationResult | None, progress: Progress | None, seconds: float
) -> CollocationResult:
    program = sparse_program(on.blocks(), on.size)
    low, high = on.bounds()
    start = {"x0": on.guess()} if warm is None else _from(on, warm)
    watch = _watch(program, progress)
    settings = _settings(o, warm is not None, "lam_x0" in start, max(seconds, 1e-3))
    from casadi import nlpsol

    solver = nlpsol(
        "solver",
        "ipopt",
        program.value,
        {
            "grad_f": program.gradient,
            "jac_g": program.jacobian,
            "hess_lag": program.hessian,
            "iteration_callback": watch,
            "print_time": False,
            "error_on_fail": False,
            "ipopt": settings,
        },
    )
    with stopped_by_ctrl_c(watch):
        answer = solver(**start, lbx=low, ubx=high, lbg=program.lower, ubg=program.upper)
    status = solver.stats()["return_status"]
    z, of_bounds, of_rows = (np.array(answer[key]).ravel() for key in ("x", "lam_x", "lam_g"))
    if status in STALLED and program.at_minimum(z, of_bounds, of_rows, (low, high), o.tolerance):
        status = "At_Rounding"
    if status == "User_Requested_Stop" and watch.last is not None:
        z = watch.last
    cost, rows = (np.array(each).ravel() for each in program.value(z, []))
    p, motions = on.unpacked(z)
    violation = float(np.maximum(program.lower - rows, rows - program.upper).max(initial=0.0))
    return CollocationResult(
        status in ("Solve_Succeeded", "At_Rounding"),
        ENDINGS.get(status, status.replace("_", " ").lower()),
        motions,
        p,
        float(cost[0]),
        violation,
        int(solver.stats()["iter_count"]),
        0.0,
        on.meshes,
        (of_bounds, of_rows),
        o.tolerance,
    )


MOST_NEW = 1.5
"""Times as many intervals up to which multipliers are carried: those of a mesh far coarser lead astray."""


def _from(on: Transcription, warm: CollocationResult) -> dict[str, Vector]:
    """Where a search starts that follows another one; without multipliers where the solver estimates better ones."""
    same_points = all(np.array_equal(m.scheme.points, on.scheme.points) for m in warm.motions)
    if same_points and all(np.array_equal(a, b) for a, b in zip(on.meshes, warm.meshes, strict=True)):
        start, known = on.again(warm.p, warm.motions), warm.multipliers
        return {"x0": start, "lam_x0": known[0], "lam_g0": known[1]}
    start = on.resampled(warm.p, warm.motions)
    longer = sum(map(len, on.meshes)) < MOST_NEW * sum(map(len, warm.meshes))
    if not (same_points and longer and nested(warm.meshes, on.meshes)):
        return {"x0": start}
    known = carried(on, warm.meshes, warm.multipliers)
    return {"x0": start, "lam_x0": known[0], "lam_g0": known[1]}


def _settings(o: SolverOptions, warm: bool, multipliers: bool, seconds: float) -> dict[str, Any]:
    settings: dict[str, Any] = {
        "tol": o.tolerance,
        "max_iter": o.iterations,
        "max_cpu_time": seconds,
        "linear_solver": "mumps",
        "mumps_mem_percent": 100,
        "print_level": 0,
        "sb": "yes",
        "nlp_scaling_method": "none",  # variables and constraints have been scaled
        "mu_strategy": "adaptive",
    }
    if warm:
        settings |= {"mu_init": 1e-6, "mu_strategy": "monotone"}
    if multipliers:
        settings |= {
            "warm_start_init_point": "yes",
            "warm_start_bound_push": 1e-8,
            "warm_start_mult_bound_push": 1e-8,
        }
    return settings


def _refined(
    problem: ControlProblem, found: CollocationResult, scale_x: Vector, scale_path: Vector, limit: float
) -> tuple[Mesh, ...]:
    """Meshes with every interval halved whose scaled residual between the points exceeds the limit."""
    finer = []
    for trial, motion, mesh in zip(problem.trials, found.motions, found.meshes, strict=True):
        size = interval_residuals(problem.system, trial, motion, found.p, scale_x, scale_path)
        middle = 0.5 * (mesh[:-1] + mesh[1:])
        finer.append(np.sort(np.r_[mesh, middle[size > limit]]))
    return tuple(finer)


def _watch(program: SparseProgram, progress: Progress | None) -> Any:
    """Keeps the last iterate, tells the progress, and stops the search when asked."""
    from casadi import Callback, Sparsity, nlpsol_n_out, nlpsol_out

    class Watch(Callback):
        def __init__(self) -> None:
            Callback.__init__(self)
            self.last: Vector | None = None
            self.count, self.stop = 0, False
            self.sizes = {"x": program.size, "lam_x": program.size, "f": 1, "lam_p": 0}
            self.construct("watch", {})

        def get_n_in(self) -> int:
            return int(nlpsol_n_out())

        def get_n_out(self) -> int:
            return 1

        def get_name_in(self, i: int) -> str:
            return str(nlpsol_out(i))

        def get_name_out(self, i: int) -> str:
            return "ret"

        def get_sparsity_in(self, i: int) -> Sparsity:
            return Sparsity.dense(self.sizes.get(nlpsol_out(i), len(program.lower)), 1)

        def eval(self, arguments: Any) -> Any:
            given = dict(zip(map(nlpsol_out, range(nlpsol_n_out())), arguments, strict=True))
            self.last = np.array(given["x"]).ravel()
            if progress is not None:
                rows = np.array(given["g"]).ravel()
                off = np.maximum(program.lower - rows, rows - program.upper).max(initial=0.0)
                progress(self.count, float(given["f"]), float(off))
            self.count += 1
            return [int(self.stop)]

    return Watch()


@contextmanager
def stopped_by_ctrl_c(watch: Stoppable) -> Iterator[None]:
    """Ctrl-C asks the search to end; outside of the main thread it does what it did."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def ask(number: int, frame: FrameType | None) -> None:
        watch.stop = True

    before = signal.signal(signal.SIGINT, ask)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
