"""What is shown of synthetic trials: surfaces of the displacement, and the page of the first trial."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import counted
from geocontact.analyses.misalignment.law_numbers import PER_SI, WRITTEN
from geocontact.analyses.misalignment.page import ANGLE, FRAMES, NOT_IN_THE_NUMBERS, elbow_page
from geocontact.analyses.misalignment.simulate.trials import LoadedTrial, Surfaces
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.view.curves.style import BLACK, DOUBLE, SMALL, empty, in_style
from geocontact.view.page.content import Curve, Curves, Page, Picture, Readout, Row, Section, Table, Words

if TYPE_CHECKING:
    from matplotlib.figure import Figure


LEVELS = 13
STRIPES = 31  # of a surface, each way


@in_style
def surface_figure(s: Surfaces) -> Figure:
    """Draw d_tot over angle and x (left) and over angle and y (right), the other offset being 0.

    As surfaces in space above, and as maps with lines of equal d_tot below, where values can be read off.
    """
    figure = empty(DOUBLE, 0.14)
    degrees, offset = np.degrees(s.angle), s.offset * 1e3
    most = float(max(np.abs(s.over_x).max(), np.abs(s.over_y).max())) * 1e3
    colours: dict[str, Any] = {"cmap": "RdBu_r", "vmin": -most, "vmax": most, "rasterized": True}
    maps = []
    for column, (values, name, other) in enumerate(((s.over_x * 1e3, "x", "y"), (s.over_y * 1e3, "y", "x"))):
        space: Any = figure.add_subplot(2, 2, 1 + column, projection="3d")
        space.plot_surface(*np.meshgrid(degrees, offset), values, rcount=STRIPES, ccount=STRIPES, lw=0.1, **colours)
        space.set_zlabel("d_tot [mm]")
        panel = figure.add_subplot(2, 2, 3 + column)
        shown = panel.pcolormesh(degrees, offset, values, shading="nearest", **colours)
        lines = panel.contour(degrees, offset, values, levels=LEVELS, colors=BLACK, linewidths=0.5)
        panel.clabel(lines, fontsize=SMALL, fmt="%g")
        for axes in (space, panel):
            axes.set_ylabel(f"offset {name} [mm]")
        space.set_xlabel("β [°]")
        panel.set_xlabel(ANGLE)
        space.set_title(f"{other} = 0, l = {s.l * 1e3:g} mm, z = {s.z * 1e3:g} mm", fontsize=SMALL)
        maps.append(panel)
    figure.colorbar(shown, ax=maps, label="displacement d_tot [mm]")
    return figure


SURFACES = (
    "Displacement of the attachment along the limb over the angle and one offset, the other being 0; blue and red are "
    "its two directions. Offsets may have either sign."
)
TURNS = "Moment on the forearm at the cuff, flexion positive"
SYNTHETIC = "These recordings are synthetic: the explicit model with the numbers below, and noise. No one was measured."


def simulation_page(loaded: Sequence[LoadedTrial], numbers: Mapping[str, float], drawing: bytes) -> Page:
    """The page of a simulation, its first trial over time."""
    made = [each.recording for each in loaded]
    first = made[0]
    every = -(-len(first.time) // FRAMES)
    shown = slice(None, None, every)
    degrees, force = np.degrees(first.beta[shown]), first.force[shown]
    turns = {"moment on the cuff": loaded[0].loads.moment[shown]}
    if first.torque is not None:
        turns |= {"torque of the joint": loaded[0].loads.joint_torque[shown], "of the actuator": first.torque[shown]}
    rows = [
        Row("angle", "deg", [f"{v:.1f}" for v in degrees]),
        Row("force", "N", [f"{v:.2f}" for v in force]),
        *(Row(name, "N m", [f"{v:.3f}" for v in values]) for name, values in turns.items()),
    ]
    true = [(name, WRITTEN[name], f"{value * PER_SI[name]:g}") for name, value in numbers.items()]
    sections: list[Section] = [
        Curves(f"Constraint force, {first.name} (synthetic)", "N", [Curve("force", force)]),
        Curves(f"Angle, {first.name} (synthetic)", "deg", [Curve("beta", degrees)]),
        Curves(TURNS, "N m", [Curve(name, values) for name, values in turns.items()]),
        Readout(rows),
        *_free_trial(made),
        Words("What this is", [SYNTHETIC]),
        Picture("Displacement over angle and offset", SURFACES, drawing, wide=True),
        Table("True numbers", ("number", "unit", "value"), true),
        INPUTS,
        OPTIONS,
        NOT_IN_THE_NUMBERS,
    ]
    facts = [(r.name, f"{r.force.min():.1f} … {r.force.max():.1f} N") for r in made]
    title, subtitle = "Synthetic recordings of an elbow exoskeleton", "Explicit model of constraint forces"
    time = first.time[shown]
    return elbow_page(title, subtitle, time, "time [s]", answer(made, numbers), facts, sections)


def answer(made: Sequence[ElbowRecording], numbers: Mapping[str, float]) -> list[str]:
    """What forces were made, with a locked and with a free joint, and from which numbers."""
    kinds = {
        "locked joint": [r for r in made if r.displacement is None],
        "free joint": [r for r in made if r.displacement is not None],
    }
    told = [
        f"{counted(len(trials), 'synthetic trial')} with a {kind}: forces of {_span([r.force for r in trials])} N over "
        f"{_span([np.degrees(r.beta) for r in trials], 0)}°."
        for kind, trials in kinds.items()
        if trials
    ]
    shown = ("k", "x", "y", "l", "z")
    told.append(f"Made with {', '.join(f'{n} = {numbers[n] * PER_SI[n]:g} {WRITTEN[n]}' for n in shown)}; see below.")
    return told


def _span(values: Sequence[Float[np.ndarray, " _"]], digits: int = 1) -> str:
    return f"{min(v.min() for v in values):.{digits}f} … {max(v.max() for v in values):.{digits}f}"


def _free_trial(made: Sequence[ElbowRecording]) -> list[Section]:
    """Force and displacement of the first trial with a free joint, over its time; none without."""
    for r in made:
        if r.displacement is not None and r is not made[0] and len(r.time) == len(made[0].time):
            every = slice(None, None, -(-len(r.time) // FRAMES))
            force, slide = Curve("force", r.force[every]), Curve("displacement", r.displacement[every] * 1e3)
            return [
                Curves(f"Constraint force, {r.name} (synthetic)", "N", [force]),
                Curves(f"Displacement of the joint, {r.name} (synthetic)", "mm", [slide]),
            ]
    return []
