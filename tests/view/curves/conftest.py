"""One specimen of every figure, and shapes left unchecked so that the figures' own refusals are reached."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import jaxtyping
import numpy as np
import pytest
from matplotlib.figure import Figure

from geocontact.data.gap_cells import Cell
from geocontact.data.motion import Course
from geocontact.view.curves.before_after import before_after
from geocontact.view.curves.bland_altman import bland_altman
from geocontact.view.curves.declared import Curve, Curves, CurveSheet, Limit, Points, Shade
from geocontact.view.curves.diagnosis_answers import Ranked, ranking_figure
from geocontact.view.curves.drawn import drawn
from geocontact.view.curves.gap_map import gap_map_figure
from geocontact.view.curves.over_cycle import mean_over_cycle
from geocontact.view.curves.path import contact_path
from geocontact.view.curves.quantity import AREA, CYCLE, FORCE, LENGTH
from geocontact.view.curves.residuals import residual_figure, residual_histogram, residual_quantiles
from geocontact.view.curves.style import DOUBLE, panels

PERCENT = np.linspace(0.0, 100.0, 51)
ANGLE = 2.0 * np.pi * PERCENT / 100.0


def trials(count: int, level: float) -> np.ndarray:
    rng = np.random.default_rng(count)
    return level * (1.0 + 0.4 * np.sin(ANGLE) + 0.1 * rng.standard_normal((count, 1)))


def over_cycle(name: str) -> Figure:
    groups = {name: trials(5, 300e-6), "implant": trials(3, 200e-6), "one": trials(1, 90e-6)}
    groups["implant"][:2, 20:30] = np.nan
    return mean_over_cycle(PERCENT, groups, replace(AREA, name=name), along=replace(CYCLE, name=name))


def two_panels(name: str) -> Figure:
    _, (left, right) = panels(1, 2, DOUBLE)
    mean_over_cycle(PERCENT, {name: trials(5, 300e-6)}, AREA, left)
    return mean_over_cycle(PERCENT, {name: trials(5, 900.0)}, FORCE, right)


def path(name: str) -> Figure:
    points = np.c_[-0.02 + 0.004 * np.cos(ANGLE), 0.006 * np.sin(ANGLE)]
    gated = points * [-1.0, 1.0]
    gated[30:40] = np.nan
    outline = np.c_[0.035 * np.cos(ANGLE), 0.022 * np.sin(ANGLE)]
    return contact_path(PERCENT, {name: points, "lateral": gated}, outline=outline, plane=(name, "anterior"))


def centre_of_pressure(name: str) -> Figure:
    return contact_path(PERCENT / 100.0, {name: np.c_[0.02 * np.sin(ANGLE / 4.0), 0.002 * PERCENT]})


def before_and_after(name: str) -> Figure:
    measured = trials(4, 800.0)
    names = [name, "two", "three", "four"]
    bump = 50.0 * np.sin(ANGLE) ** 2
    return before_after(PERCENT, measured, measured - bump, measured - 0.2 * bump, FORCE, name, (2, 3), names)


def agreement(name: str) -> Figure:
    rng = np.random.default_rng(0)
    first = rng.uniform(100e-6, 400e-6, 30)
    second = 0.95 * first + 9e-6 * rng.standard_normal(30)
    return bland_altman(first, second, replace(AREA, name=name), (name, "film"), slope=True)


def gap_map(name: str) -> Figure:
    axes = ("phase", name, f"{name}'", "load", "fast phase")
    channels = (name, "force_y", "cop_x")
    cells = [
        Cell(channel, axis, k / 6.0, (k + 1.0) / 6.0, (-1.0) ** k, 1.0 / 6.0, 0.01 if k % 2 else 0.5, (0.1, 0.2), 0.3)
        for channel in channels
        for axis in axes
        for k in range(6)
    ]
    bands = ((0.0, 1.0), (1.0, 5.0), (5.0, np.inf))
    cells += [
        Cell(channel, "band", low, high, 1.0, 1.0 / 3.0, 0.01, (0.2, 0.4), 0.3)
        for channel in channels
        for low, high in bands
    ]
    return gap_map_figure(
        cells, {"phase": "–", "fast phase": "–", name: "rad", f"{name}'": "rad/s", "load": "N", "band": "Hz"}
    )


def gains(name: str) -> Figure:
    models = [Ranked("none", "none", 0.0, 0.0, 0.0), Ranked("unknown", "unknown", 140.0, 70.0, 0.01)]
    models += [Ranked(name, name, 520.0, 300.0, 0.98), Ranked("preload", "preload", -4.0, -4.0, 0.001)]
    return ranking_figure([*models, Ranked(f"{name} + damping", f"damping + {name}", 525.0, 301.0, None)])


def declared(name: str) -> Figure:
    """Panels of their own axes, with marks, spans and limits, each with a legend of its own."""
    time = Course(name, "s", PERCENT)
    curves = [Curve(name, np.sin(ANGLE), np.sin(ANGLE) - 0.2, np.sin(ANGLE) + 0.2), Curve("b", np.cos(ANGLE))]
    marked = Curves(
        name,
        "N",
        curves,
        [Points("by hand", PERCENT[::9], np.cos(ANGLE)[::9])],
        [Limit("limit 1 N", 1.0)],
        spans=[Shade(name, 10.0, 30.0), Shade("present", 50.0, 50.0)],
    )
    own = Curves("Moment", "mm", [Curve("mean", ANGLE)], over=Course("cycle", "%", PERCENT), log=True)
    joined = Curves("Path", "mm", [], [Points("way", np.cos(ANGLE), np.sin(ANGLE), joined=True)], over=time)
    return drawn(CurveSheet([marked, own, joined], time))


RESIDUAL = np.random.default_rng(5).normal(0.2e-3, 1.5e-3, 120)
SPECIMENS: dict[str, Callable[[str], Figure]] = {
    "over_cycle": over_cycle,
    "two_panels": two_panels,
    "declared": declared,
    "path": path,
    "centre_of_pressure": centre_of_pressure,
    "before_after": before_and_after,
    "bland_altman": agreement,
    "gap_map": gap_map,
    "ranking": gains,
    "histogram": lambda name: residual_histogram(RESIDUAL, replace(LENGTH, name=name)),
    "quantiles": lambda name: residual_quantiles(RESIDUAL, replace(LENGTH, name=name)),
    "residuals": lambda name: residual_figure(RESIDUAL, replace(LENGTH, name=name)),
}


@pytest.fixture(params=SPECIMENS)
def specimen(request: pytest.FixtureRequest) -> Callable[[str], Figure]:
    """Draws one of the figures with a name of the test's choice in it."""
    return SPECIMENS[request.param]


@pytest.fixture
def unchecked() -> Iterator[None]:
    """As a user meets the functions: nobody checks shapes before they do."""
    config: Any = jaxtyping.config
    config.update("jaxtyping_disable", True)
    yield
    config.update("jaxtyping_disable", False)
