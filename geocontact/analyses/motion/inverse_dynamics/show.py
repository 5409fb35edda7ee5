"""The page of moments and forces over time, and residuals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.analyses.frame.collector import contradicted
from geocontact.analyses.frame.pages import INPUTS, OPTIONS, thinned
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.analyses.motion.gait_cycles import cycles_curves
from geocontact.analyses.motion.inverse_dynamics.forces import words
from geocontact.analyses.motion.inverse_dynamics.muscles import EstimatedMuscles, muscle_curves
from geocontact.analyses.motion.panels import panels_of
from geocontact.analyses.motion.skeleton import forces_on, scene_of, skeleton
from geocontact.data.motion import Course
from geocontact.data.wrench import Wrench
from geocontact.dynamics.residuals import GeneralisedForces, force_residual, moment_residual, verdict
from geocontact.identify.signals.gait_cycles import GaitCycles
from geocontact.view.curves.declared import Curve, Curves, CurveSheet, Scale
from geocontact.view.page.content import Page, Section, Table, Words

LEFT = (
    "The joint to the ground has no muscle: a force or moment along its coordinates shows how far motion, masses and "
    "plates disagree. Hicks et al. (2015, J Biomech Eng 137, 020905) ask for peaks below 5 % of the largest external "
    "force, and for moments below 1 % of that force times the height of the mass centre. OpenSim calls a largest force "
    "up to 10 N good, up to 25 N okay and more bad after residual reduction, which nothing here has done."
)
FILTERED = (
    "Moments follow from accelerations: the low-pass of the coordinates decides how much of an impact is left. Forces "
    "of plates are not filtered. Positive values act along the coordinate."
)


def forces_page(
    title: str,
    forces: GeneralisedForces,
    coordinates: Float[np.ndarray, "t n"],
    loads: Mapping[str, Wrench],
    cycles: GaitCycles,
    sentences: Sequence[str] = (),
    muscles: EstimatedMuscles | None = None,
) -> Page:
    """The page of moments and forces over time."""
    shown = thinned(len(forces.time), list(np.asarray(forces.values).T))
    turning = np.array([c.kind == "rotational" for c in forces.model.coordinates], dtype=bool)
    base = forces.at_ground
    values = np.asarray(forces.values)[shown]
    model = forces.model
    sections: list[Section] = [
        scene_of(model, [skeleton(model, coordinates[shown]), *forces_on(model, loads, shown)]),
        *forces_curves(forces).at(shown),
        *muscle_curves(muscles, shown),
        *cycles_curves(cycles),
        *_left_over(forces, values, turning, base),
        *_residuals(forces),
        INPUTS,
        OPTIONS,
        Words("What the numbers do not contain", [LEFT, FILTERED, NOT_A_DEVICE]),
    ]
    return Page(
        title=title,
        subtitle=f"{int((~base).sum())} coordinates of {forces.model.name or 'the model'}",
        time=forces.time[shown],
        time_label="time [s]",
        headline=answer(forces, turning & ~base) or headline(sentences, most=2),
        facts=_facts(forces, turning & ~base),
        start_frame=_start(forces, turning & ~base, shown),
        sections=tuple(sections),
        numbers=shown + 1,
        total=len(forces.time),
    )


def forces_curves(forces: GeneralisedForces) -> CurveSheet:
    """Moments, with a second scale over the model's mass, and forces over time, without those at the ground."""
    model, base, values = forces.model, forces.at_ground, np.asarray(forces.values)
    turning = np.array([c.kind == "rotational" for c in model.coordinates], dtype=bool)
    by_mass = Scale("N m/kg", 1.0 / model.mass) if model.mass > 0.0 else None
    panels = [
        *panels_of(model, "N m", values, turning & ~base, by_mass),
        *panels_of(model, "N", values, ~turning & ~base),
    ]
    return CurveSheet(panels, Course("time", "s", forces.time))


def answer(forces: GeneralisedForces, turning: Bool[np.ndarray, " n"]) -> list[str]:
    """The largest moment and the residuals at the ground; nothing where no joint turns or the loads contradict it."""
    if contradicted() or not turning.any():
        return []
    frame, which = forces.largest(turning)
    name, size = forces.model.coordinates[which].name, abs(forces.values[frame, which])
    told = [f"{name} needs the largest moment, {size:.1f} N m at {forces.time[frame]:.3g} s."]
    if forces.at_ground.any():
        told += [f"{part[0].upper()}{part[1:]}." for part in words(forces).split("; residual")[:1]]
        told += [f"Residual{part}." for part in words(forces).split("; residual")[1:]]
    return told


def _start(forces: GeneralisedForces, turning: Bool[np.ndarray, " n"], shown: Int[np.ndarray, " k"]) -> int:
    """The frame shown that is next to the largest moment."""
    return int(np.argmin(np.abs(shown - forces.largest(turning)[0]))) if turning.any() else 0


def _facts(forces: GeneralisedForces, turning: Bool[np.ndarray, " n"]) -> list[tuple[str, str]]:
    told = []
    if turning.any() and not contradicted():
        frame, which = forces.largest(turning)
        where = f"{forces.model.coordinates[which].name} at {forces.time[frame]:.3g} s"
        told.append(("Largest moment", f"{abs(forces.values[frame, which]):.1f} N m, {where}"))
    if forces.at_ground.any():
        left = force_residual(forces)
        of = "the largest measured force" if forces.peak > 0.0 else "the weight (only gravity acts)"
        told.append(("Largest residual at the ground", f"{left.size:.1f} N ({left.share:.1%} of {of})"))
    return told


def _residuals(forces: GeneralisedForces) -> list[Section]:
    """Sizes beside what they should be below; nothing where no body is free."""
    if not forces.at_ground.any():
        return []
    rows = []
    for name, unit, sizes, peak in (
        ("force", "N", forces.residual_forces, force_residual(forces)),
        ("moment", "N m", forces.residual_moments, moment_residual(forces)),
    ):
        limit = f"{peak.allowed * peak.whole:.1f}" if peak.whole > 0.0 else "-"
        mean = float(np.sqrt(np.mean(sizes**2)))
        told = verdict(peak.size) if unit == "N" else "-"
        rows.append((f"{name} [{unit}]", f"{peak.size:.1f}", f"{peak.time:.3g}", f"{mean:.1f}", limit, told))
    grade = "OpenSim's grade (after residual reduction)"
    header = ("residual", "largest", "at [s]", "root mean square", "Hicks et al.: below", grade)
    return [Table("Residual force and moment at the ground, and recommended limits", header, rows)]


def _left_over(
    forces: GeneralisedForces,
    values: Float[np.ndarray, "t n"],
    turning: Bool[np.ndarray, " n"],
    base: Bool[np.ndarray, " n"],
) -> list[Section]:
    found: list[Section] = []
    for title, unit, which in (("forces", "N", ~turning & base), ("moments", "N m", turning & base)):
        names = [c.name for c, there in zip(forces.model.coordinates, which, strict=True) if there]
        if names:
            curves = [Curve(name, value) for name, value in zip(names, values[:, which].T, strict=True)]
            found.append(Curves(f"Residual at the ground: {title}", unit, curves))
    return found
