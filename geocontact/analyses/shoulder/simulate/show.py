"""What is shown of a simulation: moving arms with the forces in their cuffs, curves, numbers of the device."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from geocontact.analyses.frame.pages import INPUTS, OPTIONS, thinned
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.shoulder.simulate.wearer_body import wearer_body
from geocontact.data.motion import Course
from geocontact.shoulder_exoskeleton.device import JOINTS, Wearer
from geocontact.shoulder_exoskeleton.work_phases import PHASES
from geocontact.shoulder_exoskeleton.working_arm import SimulatedArm
from geocontact.view.curves.declared import Curve, Curves, CurveSheet, stroke
from geocontact.view.page.content import Page, Readout, Row, Section, Words
from geocontact.view.page.scene import Linkage, Scene, Tone
from geocontact.view.page.tables import frame_table

METRES_PER_NEWTON = 5e-3
"""A force of 100 N is drawn 0.5 m long."""
JOINT, MARKER, LINK, LIMB, ARROW = 0.012, 0.009, 0.014, 0.03, 0.008
"""Radius of joints and markers, thickness of links, limbs and forces [m]."""
DIRECTIONS = {
    "behind (+y)": (0.0, 1.0, 0.0),
    "front (−y)": (0.0, -1.0, 0.0),
    "right (−x)": (-1.0, 0.0, 0.0),
    "left (+x)": (1.0, 0.0, 0.0),
    "above (+z)": (0.0, 0.0, 1.0),
}
AT = "Where the shoulder comes up to an elevation"
VIEW = {"right": (-1.0, 0.55, 0.35), "left": (1.0, 0.55, 0.35)}
"""From behind, on the side of the first arm."""
POINT = (
    "The cuff holds the arm at one point: a sphere in a tube of the same radius. That holds two of the three joints; "
    "the third is held by friction, stops and damping of the joints, which are invented, and so is what of the passive "
    "joints, of slip and shear depends on them. Padding, skin and the area of contact are not modelled."
)
SURFACE = (
    "The cuff holds the arm by an elastic foundation: pad and soft tissue as springs that do not know each other, the "
    "arm a round cylinder. Layers, interference and damping are invented. Tilt and friction of the pressed wall hold "
    "the third joint, which a point leaves to friction, stops and damping."
)
FRAME = (
    "The human arm is recorded: the exoskeleton does not change its motion. The device's frame moves with the trunk; "
    "gravity turns with it, accelerations of the trunk do not act on the exoskeleton's arms."
)

KEPT = (
    "A person who wears the device neither keeps the motion nor the shoulder's torque: both are bounds. Torque kept "
    "means that nothing but weight and inertia resists the support. Stiffness of the ankles is invented."
)
PERSON = "What the person carries, without and with the device"


def simulation_page(
    o: ShoulderSimulateOptions,
    arms: Sequence[SimulatedArm],
    markers: Float[np.ndarray, "t m 3"],
    wearer: Wearer,
    tables: Mapping[str, pd.DataFrame],
    sentences: Sequence[str],
    person: CurveSheet | None = None,
) -> Page:
    """The page of simulated arms, opened where the force that lifts an arm is largest.

    Parameters
    ----------
    markers
        All that were recorded, in the device's frame [m].
    tables, sentences
        Those of the result.
    person
        What the person carries; None where it was not asked for.
    """
    time = arms[0].simulation.motion.time
    lifting = [each.simulation.supporting for each in arms]
    shown = thinned(len(time), [np.linalg.norm(each.simulation.outputs["force"], axis=1) for each in arms] + lifting)
    answered = [FRAME] if person is None else [FRAME, KEPT]
    changed = [tables[name] for name in ("sensitivity",) if name in tables]
    sections: list[Section] = [
        Scene(
            directions=DIRECTIONS,
            up=(0.0, 0.0, 1.0),
            view=VIEW[arms[0].side],
            linkages=[
                *_lines(arms, markers, shown),
                *wearer_body(wearer, arms[0].simulation.motion.shoulder.mean(axis=0)),
            ],
        ),
        *arm_curves(arms).at(shown),
        *(() if person is None else person.at(shown)),
        *(frame_table(PERSON, tables[name], 3) for name in ("person",) if name in tables),
        Readout([row for each in arms for row in _phases(each, shown)]),
        *(frame_table(AT, tables[name], 3) for name in ("at_elevation",) if name in tables and len(tables[name])),
        *(frame_table("What each number of the device changes, root mean square", table) for table in changed),
        frame_table("Length, lever and torque of the cylinder over the elevation", tables["levers"], 4),
        frame_table("Numbers of the device, and where they are from", tables["numbers"]),
        INPUTS,
        OPTIONS,
        Words("What the numbers do not contain", [SURFACE if o.cuff == "surface" else POINT, *answered, NOT_A_DEVICE]),
    ]
    return Page(
        title=f"Shoulder exoskeleton along {o.markers.name}",
        subtitle=f"Support level {o.level:.0%}; the device's frame: x to the left, y backwards, z up",
        time=time[shown],
        time_label="time [s]",
        headline=headline(sentences, most=2),
        facts=[fact for each in arms for fact in _facts(each)],
        start_frame=_start(tables, shown, np.max(lifting, axis=0)),
        sections=tuple(sections),
        numbers=shown + 1,
        total=len(time),
    )


def _start(tables: Mapping[str, pd.DataFrame], shown: Int[np.ndarray, " k"], lifting: Float[np.ndarray, " t"]) -> int:
    """Frame at the first elevation that was asked for, else of the largest force."""
    if "at_elevation" in tables and len(tables["at_elevation"]):
        return int(np.argmin(np.abs(shown + 1 - int(tables["at_elevation"]["frame"].iloc[0]))))
    return int(np.argmax(lifting[shown]))


def _lines(
    arms: Sequence[SimulatedArm], markers: Float[np.ndarray, "t m 3"], shown: Int[np.ndarray, " k"]
) -> list[Linkage]:
    device, human, force = [], [], []
    for each in arms:
        s = each.simulation
        joints = s.outputs["joints"].reshape(-1, 4, 3)[shown]
        base = np.zeros((len(shown), 1, 3))
        device.append(np.concatenate([base, joints], axis=1))
        human.append(np.stack([s.motion.shoulder[shown], s.motion.interface[shown]], axis=1))
        tip = s.motion.interface + METRES_PER_NEWTON * s.outputs["force"]
        force.append(np.stack([s.motion.interface[shown], tip[shown]], axis=1))
    return [
        _linkage("exoskeleton", device, "model", JOINT, LINK),
        _linkage("upper arms, shoulder to cuff", human, "bone", JOINT, LIMB),
        Linkage("markers", markers[shown], np.zeros((0, 2), np.int64), "seen", MARKER, 0.0),
        _linkage("forces on the arms, 0.5 m for 100 N", force, "force", 0.0, ARROW),
    ]


def _linkage(
    name: str, chains: Sequence[Float[np.ndarray, "t k 3"]], tone: Tone, radius: float, width: float
) -> Linkage:
    lines = _chains(len(chains), chains[0].shape[1])
    return Linkage(name, np.concatenate(chains, axis=1), lines, tone, radius, width)


def _chains(count: int, points: int) -> Int[np.ndarray, "k 2"]:
    """Lines from point to point, chain by chain."""
    return np.array([(i, i + 1) for c in range(count) for i in range(c * points, c * points + points - 1)], np.int64)


def arm_curves(arms: Sequence[SimulatedArm]) -> CurveSheet:
    """Elevations, force and shear on the arms, support and passive joints over time; blue the first arm, orange the
    second, dashed what belongs to the exoskeleton.
    """

    def panel(title: str, unit: str, curves: Sequence[tuple[str, Float[np.ndarray, " t"], int]]) -> Curves:
        return Curves(title, unit, [Curve(name, values, stroke=own) for name, values, own in curves])

    each = [(one.side, one.simulation, stroke(k), stroke(k, 1)) for k, one in enumerate(arms)]
    elevation = [
        pair
        for side, s, own, device in each
        for pair in (
            (f"shoulder, {side}", np.degrees(s.motion.elevation), own),
            (f"exoskeleton, {side}", np.degrees(s.elevation), device),
        )
    ]
    found = [
        panel("Elevation", "deg", elevation),
        panel("Interface force that lifts the arm", "N", [(side, s.supporting, own) for side, s, own, _ in each]),
        panel("Shear on the arm", "N", [(side, s.shear, own) for side, s, own, _ in each]),
        panel("Slip along the cuff's wall", "mm", [(side, 1e3 * s.slip, own) for side, s, own, _ in each]),
        panel("Support torque", "N m", [(side, s.outputs["support"][:, 0], own) for side, s, own, _ in each]),
    ]
    led = [(one.side, one.factor, stroke(k)) for k, one in enumerate(arms) if one.factor is not None]
    if led:
        found.append(panel("Factor of the support", "-", led))
    passive = [
        (f"{joint}, {side}", np.degrees(s.angles[:, k]), (own, device)[k])
        for side, s, own, device in each
        for k, joint in enumerate(JOINTS[:2])
    ]
    found.append(panel("Passive joints", "deg", passive))
    return CurveSheet(found, Course("time", "s", arms[0].simulation.motion.time))


def _phases(each: SimulatedArm, shown: Int[np.ndarray, " k"]) -> list[Row]:
    rows = [Row(f"phase, {each.side}", "", [PHASES[k] for k in each.phase[shown]])]
    if each.detected is not None:
        rows.append(Row(f"detected phase, {each.side}", "", [PHASES[k] for k in each.detected[shown]]))
    return rows


def _facts(each: SimulatedArm) -> list[tuple[str, str]]:
    s = each.simulation
    facts = [
        (f"Largest supporting force, {each.side}", f"{s.supporting.max():.1f} N"),
        (f"Elevation up to, {each.side}", f"{np.degrees(s.elevation.max()):.0f}°"),
    ]
    if s.out_of_cuff.any():
        facts.append((f"Out of the cuff, {each.side}", f"{s.out_of_cuff.mean():.1%} of the time"))
    return facts
