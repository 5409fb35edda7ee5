"""The sit-to-stand interfaces of CASES.md a second time: per site F = k u + b u', u = normal + rho rotation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.body import Site, SyntheticSystem
from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values, read
from geocontact.gap_benchmark.synthetic.systems.interface import in_series, pull

SITES = ("pelvis", "thigh", "shank")
MOTIONS = {"normal": "m", "tangential": "m", "rotation": "rad"}
"""What is measured at each site, in this order, with its unit."""
NORMAL, ROTATION = 0, 2
Sites = tuple[str, ...]


def inputs(sites: Sites) -> tuple[str, ...]:
    """Names of the inputs."""
    return tuple(f"{site}_{motion}" for site in sites for motion in MOTIONS)


def outputs(sites: Sites) -> tuple[str, ...]:
    """Names of the outputs."""
    return tuple(f"{site}_force" for site in sites)


def units(sites: Sites) -> tuple[str, ...]:
    """Of inputs, then of outputs."""
    return (*(unit for _ in sites for unit in MOTIONS.values()), *("N" for _ in sites))


def respond(course: InputCourse, numbers: Mapping[str, float], hooks: Hooks, sites: Sites) -> Float[np.ndarray, "c t"]:
    """Force of each site along a course [N].

    Behind a spring in series the pad's dashpot b stays fixed to what is measured: it lies beside both springs.
    """
    for moved in hooks.motion:
        course = moved(course)
    time, b = course.time, numbers["b"]
    rows = []
    for i, site in enumerate(sites):
        own = hooks.seen_from(site)
        normal, rotation = course.position[3 * i + NORMAL], course.position[3 * i + ROTATION]
        lever = np.full_like(rotation, numbers[f"rho_{site}"])
        for drift in own.axis:
            lever = lever + drift(rotation)
        u, k = normal + lever * rotation, numbers[f"k_n_{site}"]
        if own.series:
            elastic = in_series(u, partial(pull, time, k=k, hooks=own), own)
            rows.append(elastic + b * np.gradient(u, time, edge_order=2))
        else:
            rows.append(pull(time, u, k, own, b))
    forces = np.array(rows)
    for add in hooks.load:
        forces = forces + add(course, numbers)
    return read(hooks, course, forces)


def base_model(course: InputCourse, constants: Mapping[str, float], sites: Sites) -> Callable[[Values], Values]:
    """Outputs of the base model as a function of (k of each site, rho of each site)."""
    count, b = len(sites), constants["b"]
    normal, rotation = (course.position[row::3] for row in (NORMAL, ROTATION))
    closing, turning = (course.rate[row::3] for row in (NORMAL, ROTATION))

    def forces(theta: Values) -> Values:
        k, rho = theta[:count, None], theta[count:, None]
        return np.asarray(k * (normal + rho * rotation) + b * (closing + rho * turning))

    return forces


def course_deflection(course: InputCourse, numbers: Mapping[str, float], sites: Sites) -> tuple[Values, Values]:
    """Deflection and rate of the base model along a course, one row per site."""
    rho = np.array([numbers[f"rho_{site}"] for site in sites])[:, None]
    place, rate = course.position, course.rate
    return place[NORMAL::3] + rho * place[ROTATION::3], rate[NORMAL::3] + rho * rate[ROTATION::3]


def sit_to_stand(sites: Sites) -> SyntheticSystem:
    """Straps at these sites."""
    every = tuple(range(len(sites)))
    return SyntheticSystem(
        partial(respond, sites=sites),
        partial(base_model, sites=sites),
        partial(course_deflection, sites=sites),
        loads=every,
        normal=every,
        places=tuple(Site(site, i, 3 * i + ROTATION) for i, site in enumerate(sites)),
        spare=tuple(f"{site}_tangential" for site in sites),
    )
