"""What is shown of a stance: moving leg and foot with force and centre of pressure, curves, numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from geocontact.analyses.frame.pages import INPUTS, OPTIONS, thinned
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.analyses.prosthesis.number_units import with_units
from geocontact.analyses.prosthesis.quantity_words import NAMES, small_force
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.below_knee_prosthesis.evaluation import PlateStance, at_times
from geocontact.below_knee_prosthesis.from_markers import of_side
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, recorded_tree
from geocontact.below_knee_prosthesis.marker_draws import MarkerBand
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.data.motion import Course
from geocontact.loads.ground import Stairs
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet
from geocontact.view.page.content import Page, Section, Table, Words
from geocontact.view.page.scene import Linkage, Scene
from geocontact.view.page.tables import frame_table

FRAMES = 300  # that the page shows at most
METRES_PER_NEWTON = 6e-4
"""A force of 1 kN is drawn 0.6 m long."""
JOINT, LIMB, KEEL, SPHERE, ARROW = 0.02, 0.03, 0.008, 0.012, 0.008
"""Radius of joints, thickness of limbs and keel, radius of the spheres' centres, thickness of forces [m]."""
DIRECTIONS = {
    "right (+z)": (0.0, 0.0, 1.0),
    "left (−z)": (0.0, 0.0, -1.0),
    "front (+x)": (1.0, 0.0, 0.0),
    "above (+y)": (0.0, 1.0, 0.0),
}
ALONE = (
    "Only the prosthetic side is modelled: trunk, arms and the other leg are one mass on the pelvis, the measured "
    "force under the other foot acts on it, and the other leg's swing does not. Rotations of pelvis, hip and knee "
    "are as recorded; the pelvis' height and advance, the socket and the keel are computed."
)
SOLE = (
    "The foot is a keel of eight hinges on spheres. Positions and forces of the spheres are invented except for the "
    "stiffness in compression; nothing was fitted to this person."
)
CALIBRATED = (
    "The foot is a keel of eight hinges on spheres. Positions of the spheres are invented; their forces, and the "
    "offset of the foot from its standing trial, are from the law's file."
)
OWN_FOOT = (
    "The foot is a keel on hinges on {kinds}, as its file describes it; numbers.csv says where each number is from. "
    "Nothing was fitted to this person."
)
OWN_CALIBRATED = (
    "The foot is a keel on hinges on {kinds}, as its file describes it; their forces, and the offset of the foot from "
    "its standing trial, are from the law's file."
)
SCHEDULED = (
    "The fulcrum moves in the swing before a stance and stays through it. Each stance is simulated from its recorded "
    "start at its own fulcrum, along the person's motion as it was recorded: how the person would answer another "
    "setting is not in it. Curves and the moving foot are those of the longest stance."
)
TWICE = (
    "Markers on the socket include its rotation against the residual limb, so this rotation is in the knee angle as "
    "well as in the bushing."
)
IN_TURNS = (
    "Markers on the socket include its rotation against the residual limb. The simulation computes this rotation and "
    "removes it from them; fit and simulation are repeated."
)


def stance_page(
    o: ProsthesisSimulateOptions,
    s: Stance,
    curves: CurveSheet,
    tables: Mapping[str, pd.DataFrame],
    sentences: Sequence[str],
) -> Page:
    """The moving foot with its forces and the path of the centre of pressure, curves, tables."""
    shown = thinned(len(s.time), [s.force[:, 1], s.ankle_moment], most=FRAMES)
    sections: list[Section] = [
        Scene(directions=DIRECTIONS, up=(0.0, 1.0, 0.0), view=(0.3, 0.2, 1.0), linkages=_lines(s, o, shown)),
        *curves.at(shown),
        *(
            [frame_table("Compared with the force plate", tables["errors"].replace({"quantity": NAMES}))]
            if "errors" in tables
            else []
        ),
        *small_forces(tables.get("errors")),
        *strides_sections(tables),
        frame_table("Numbers of leg and foot in SI, and where they are from", with_units(tables["numbers"])),
        INPUTS,
        OPTIONS,
        Words(
            "What the numbers do not contain", [ALONE, *_sole_and_socket(o, s.foot.sole.spheres.kinds), NOT_A_DEVICE]
        ),
    ]
    return Page(
        title=f"Prosthetic stance along {o.motion.name}",
        subtitle=f"Fulcrum at {1e3 * s.fulcrum:.0f} mm, {s.motion.leg.person.mass:g} kg, {o.side} side; x forward",
        time=s.time[shown],
        time_label="time [s]",
        headline=headline(sentences, most=2),
        facts=[
            ("Vertical force up to", f"{s.force[:, 1].max():.0f} N"),
            ("Ankle moment up to", f"{s.ankle_moment.max():.0f} N m"),
        ],
        sections=tuple(sections),
        numbers=shown + 1,
        total=len(s.time),
    )


def strides_sections(tables: Mapping[str, pd.DataFrame]) -> list[Section]:
    """Every stride of a schedule, and what it means; nothing without one."""
    if "strides" not in tables:
        return []
    return [frame_table("Strides", tables["strides"]), Words("The schedule", [SCHEDULED])]


def small_forces(errors: pd.DataFrame | None) -> list[Words]:
    """Why an R² below 0 of the sideways force says little; nothing where it is above."""
    if errors is None:
        return []
    said = [small_force(str(name), float(r2)) for name, r2 in zip(errors["quantity"], errors["r2 [-]"], strict=True)]
    return [Words("Sideways force", [line for line in said if line])] if any(said) else []


def _sole_and_socket(o: ProsthesisSimulateOptions, kinds: str) -> list[str]:
    usual, calibrated = (SOLE, CALIBRATED) if o.foot is None else (OWN_FOOT, OWN_CALIBRATED)
    sole = (usual if o.law is None else calibrated).format(kinds=kinds)
    return [sole, TWICE if o.socket_turns == 0 else IN_TURNS]


def _lines(s: Stance, o: ProsthesisSimulateOptions, shown: Int[np.ndarray, " k"]) -> list[Linkage]:
    def place(points: Float[np.ndarray, "k n 3"]) -> Float[np.ndarray, "k n 3"]:
        return of_side(points, o.side)

    motion = s.motion
    values = motion.at(s.time[shown])
    values[:, 3:5] = s.found.q[shown, :2]
    poses = recorded_tree(motion.leg).poses(values)
    limb = np.stack([poses["pelvis"].translation, poses["thigh"].translation, poses["shank"].translation], axis=1)
    below = np.stack([poses["shank"].apply(motion.leg.bushing), s.ankle[shown]], axis=1)
    keel = _keel(s)[shown]
    centre = s.centre("ground")[shown]
    force = np.stack([centre, centre + METRES_PER_NEWTON * s.force[shown]], axis=1)
    thin = s.centre("ground")[:: max(1, len(s.time) // 60)]
    path = np.broadcast_to(thin, (len(shown), *thin.shape))
    border = _floor(s)
    floor = np.broadcast_to(border, (len(shown), *border.shape))
    around = np.append(_chain(len(border)), [(len(border) - 1, 0)], axis=0)
    return [
        Linkage("pelvis, thigh, residual limb", place(limb), _chain(3), "bone", JOINT, LIMB),
        Linkage("socket and pylon", place(below), _chain(2), "model", JOINT, LIMB),
        Linkage("keel", place(keel), _chain(keel.shape[1]), "model", 0.0, KEEL),
        Linkage("spheres", place(s.loads.centre[shown]), np.zeros((0, 2), np.int64), "seen", SPHERE, 0.0),
        Linkage("path of the centre of pressure", place(path), _chain(path.shape[1]), "force", 0.0, 0.5 * ARROW),
        Linkage("force of the ground, 0.6 m for 1 kN", place(force), _chain(2), "force", 0.0, ARROW),
        Linkage("floor", place(floor), around, "floor", 0.0, 0.5 * ARROW),
    ]


def _floor(s: Stance) -> Float[np.ndarray, "n 3"]:
    """Border of the ground around the stance, from the one end to the other and back [m]."""
    ground, x = s.ground, np.array([-0.5, 0.7])
    if isinstance(ground, Stairs):
        edges = np.array(ground.edges)
        inner = edges[(edges > x[0]) & (edges < x[1])]
        x = np.concatenate([x[:1], np.repeat(inner, 2), x[1:]])
        steps = np.searchsorted(edges, x, side="right")
        steps[1:-1:2] -= 1
        line = np.column_stack([x, np.array(ground.heights)[steps]])
        sides = [np.column_stack([line, np.full(len(line), z)]) for z in (-0.15, 0.25)]
    else:
        normal, point = np.asarray(ground.normal, float), np.asarray(ground.point, float)
        sides = []
        for z in (-0.15, 0.25):
            y = (normal @ point - normal[0] * x - normal[2] * z) / normal[1]
            sides.append(np.column_stack([x, y, np.full(2, z)]))
    return np.concatenate([sides[0], sides[1][::-1]])


def _keel(s: Stance) -> Float[np.ndarray, "t n 3"]:
    """The keel's end, joints and tip in the laboratory [m]."""
    keel = s.foot.keel
    angle = np.cumsum(s.keel_angles, axis=1)
    twist = np.zeros((len(s.time), 1)) if s.twist is None else s.twist[:, None]
    up, across = np.cos(twist), np.sin(twist)
    steps = keel.pitch * np.stack([np.cos(angle), up * np.sin(angle), across * np.sin(angle)], axis=2)
    first = np.broadcast_to([keel.posterior, 0.0, 0.0], (len(s.time), 1, 3))
    points = np.concatenate([np.zeros_like(first), first, first + np.cumsum(steps, axis=1)], axis=1)
    turned = np.einsum("tij,tnj->tni", s.poses.rotation.as_matrix(), points)
    return np.asarray(turned + s.poses.translation[:, None])


def _chain(points: int) -> Int[np.ndarray, "k 2"]:
    return np.array([(i, i + 1) for i in range(points - 1)], np.int64)


def _errors_table(errors: pd.DataFrame) -> Table:
    return frame_table("Compared with the force plate", errors.replace({"quantity": NAMES}))


def stance_curves(s: Stance, plate: PlateStance | None, band: MarkerBand | None = None) -> CurveSheet:
    """Forces beside the plate's, centre of pressure, ankle, keel and socket over time; with the band of the markers'
    errors where there is one.
    """
    mass = s.motion.leg.person.mass
    weight = mass * GRAVITY
    panels = []
    for title, name, axis in (("Vertical force", "vertical", 1), ("Fore-aft force, forward positive", "fore_aft", 0)):
        curves = [Curve("simulated", s.force[:, axis] / weight, *_ends(band, name), stroke=0)]
        if plate is not None:
            seen = at_times(s.time, plate.time, plate.force)[:, axis] / weight
            curves.append(Curve("plate", seen, stroke=INK))
        panels.append(Curves(title, "BW", curves))
    along = [
        Curve("ground point", 1e2 * s.along_foot("ground"), *_ends(band, "cop_ground", 1e2)),
        Curve("sphere point", 1e2 * s.along_foot("sphere")),
    ]
    panels += [
        Curves("Centre of pressure from heel to toe", "% of the foot", along),
        Curves(
            "Ankle moment", "N m", [Curve("against dorsiflexion", s.ankle_moment, *_ends(band, "ankle_moment", mass))]
        ),
        Curves("Energy of the keel", "J", [Curve("stored", s.stored), Curve("lost", s.lost)]),
        Curves("Pistoning of the socket", "mm", [Curve("along the residual limb", 1e3 * s.pistoning)]),
    ]
    return CurveSheet(panels, Course("time", "s", s.time))


def _ends(
    band: MarkerBand | None, name: str, factor: float = 1.0
) -> tuple[Float[np.ndarray, " t"] | None, Float[np.ndarray, " t"] | None]:
    """Lower and upper end of the band of a quantity; None without one."""
    if band is None:
        return None, None
    middle, half = band.curves[name], band.half[name]
    return factor * (middle - half), factor * (middle + half)
