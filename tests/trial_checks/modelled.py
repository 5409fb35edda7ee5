"""Trials with a model, with other channels, and with somebody who stands, for the checks that need them.

The model is two legs and a trunk on a rod that goes up and down, made here of its joints; whoever rises does so by a
smooth polynomial, and the plate carries m (g + a) in closed form.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.data.multibody.force_plate import ForcePlate
from geocontact.data.multibody.joint import prismatic, revolute, weld
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import GROUND, Body, Multibody
from geocontact.data.wrench import Wrench
from geocontact.trial_checks.recorded import FootPlate, MovedModel, RecordedChannel, TrialInputs

MASS, GRAVITY, HEIGHT = 75.0, 9.80665, 1.75
THIGH, SHANK = 0.245 * HEIGHT, 0.246 * HEIGHT
TIME = np.arange(0.0, 2.0, 0.01)
RISE, FIRST, LAST = 0.35, 0.4, 1.4
Change = Callable[[TrialInputs], TrialInputs]


def person(thigh: float = THIGH, shank: float = SHANK) -> Multibody:
    """Trunk with all the mass, and legs without."""
    bodies = [Body("torso", MASS, np.zeros(3), np.eye(3))]
    joints = [prismatic("up", GROUND, "torso", np.array([0.0, 1.0, 0.0]))]
    for side, z in (("r", 0.1), ("l", -0.1)):
        bodies += [Body(f"{name}_{side}", 0.0, np.zeros(3), np.zeros((3, 3))) for name in ("femur", "tibia", "talus")]
        joints += [
            revolute(f"hip_{side}", "torso", f"femur_{side}", np.array([0.0, 0.0, 1.0]), shifted(0.0, 0.0, z)),
            revolute(
                f"knee_{side}", f"femur_{side}", f"tibia_{side}", np.array([0.0, 0.0, 1.0]), shifted(0.0, -thigh, 0.0)
            ),
            weld(f"ankle_{side}", f"tibia_{side}", f"talus_{side}", shifted(0.0, -shank, 0.0)),
        ]
    ranged = tuple(
        replace(
            joint,
            coordinates=tuple(replace(c, limits=(-2.1, 0.2)) if "knee" in c.name else c for c in joint.coordinates),
        )
        for joint in joints
    )
    return Multibody("person", tuple(bodies), ranged, (), np.array([0.0, -GRAVITY, 0.0]))


def shifted(*by: float) -> RigidTransform:
    return RigidTransform.from_translation(by)


def rise(time: np.ndarray) -> np.ndarray:
    """Height [m] of who rises."""
    s = np.clip((time - FIRST) / (LAST - FIRST), 0.0, 1.0)
    return 0.6 + RISE * (10.0 * s**3 - 15.0 * s**4 + 6.0 * s**5)


def acceleration(time: np.ndarray) -> np.ndarray:
    """Its second derivative [m/s^2]."""
    s = np.clip((time - FIRST) / (LAST - FIRST), 0.0, 1.0)
    return RISE * (60.0 * s - 180.0 * s**2 + 120.0 * s**3) / (LAST - FIRST) ** 2


def risen(model: Multibody | None = None) -> TrialInputs:
    """Somebody who stands up, knees and hips at their angles, on one plate."""
    model = person() if model is None else model
    up = rise(TIME)
    bent = 1.4 * (1.0 - (up - 0.6) / RISE)
    columns = {"up": up, "hip_r": bent, "hip_l": bent, "knee_r": -bent, "knee_l": -bent}
    values = np.column_stack([columns[c.name] for c in model.coordinates])
    force = np.column_stack([0.0 * TIME, MASS * (GRAVITY + acceleration(TIME)), 0.0 * TIME])
    plate = ForcePlate(
        "feet", TIME, Wrench(force, 0 * force, 0 * force, "ground"), np.zeros(3), np.array([0.0, 1.0, 0.0])
    )
    return TrialInputs(
        plates=(FootPlate(plate, "plates.mot"),),
        mass=MASS,
        height=HEIGHT,
        stands_at=1.85,
        moved=MovedModel(model, TIME, values, "rise.mot"),
    )


def angled(change: Callable[[np.ndarray], np.ndarray]) -> Change:
    """With other angles of hips and knees."""

    def damage(_: TrialInputs) -> TrialInputs:
        trial = risen()
        assert trial.moved is not None
        values = trial.moved.values.copy()
        values[:, 1:] = change(values[:, 1:])
        return replace(trial, moved=replace(trial.moved, values=values))

    return damage


def later(by: float) -> Change:
    """With a plate whose clock is late [s]."""

    def damage(_: TrialInputs) -> TrialInputs:
        trial = risen()
        on = trial.plates[0]
        return replace(trial, plates=(replace(on, plate=replace(on.plate, time=on.plate.time + by)),))

    return damage


def standing(**heights: float) -> MarkerTrajectories:
    """Somebody who stands still, heights of landmarks in parts of the body's; `knee_l` for one of a side."""
    usual = {"ASI": 0.56, "KNE": 0.285, "ANK": 0.039, "HEE": 0.02, "TOE": 0.02} | heights
    places = {}
    for side, z in (("R", 0.1), ("L", -0.1)):
        for name, x in (("ASI", 0.05), ("KNE", 0.0), ("ANK", -0.02), ("HEE", -0.06), ("TOE", 0.15)):
            up = HEIGHT * usual.get(side + name, usual[name])
            places[side + name] = np.tile([x, up, z], (20, 1))
    return MarkerTrajectories(
        np.arange(20) / 100.0, np.stack(list(places.values()), axis=1), tuple(places), "still.trc"
    )


def stood(**given: float | MarkerTrajectories) -> Change:
    return lambda _: TrialInputs(**({"standing": standing(), "mass": MASS} | given))  # type: ignore[arg-type]


def channel(unit: str, size: float, step: float = 1e-3) -> Change:
    """A channel whose largest value is so large."""
    time = step * np.arange(100)
    values = size * np.sin(np.linspace(0.0, 0.5 * np.pi, 100))
    return lambda _: TrialInputs(channels=(RecordedChannel("one", unit, time, values, "more.csv"),))


def rated(factor: float) -> Change:
    """Rates of the coordinates besides, times a factor."""

    def damage(_: TrialInputs) -> TrialInputs:
        trial = risen()
        assert trial.moved is not None
        rates = factor * np.gradient(trial.moved.values, TIME, axis=0)
        return replace(trial, moved=replace(trial.moved, rates=rates))

    return damage


def aside(by: float) -> Change:
    """With the plate's load elsewhere [m]."""

    def damage(_: TrialInputs) -> TrialInputs:
        trial = risen()
        on = trial.plates[0]
        origin = on.plate.wrench.origin + np.array([by, 0.0, 0.0])
        wrench = replace(on.plate.wrench, origin=origin)
        return replace(trial, plates=(replace(on, plate=replace(on.plate, wrench=wrench)),))

    return damage


def cut(first: float, last: float) -> Change:
    """Only a part of who stands up, with rates: the recording begins or ends while the person moves."""

    def damage(_: TrialInputs) -> TrialInputs:
        trial = rated(1.0)(risen())
        assert trial.moved is not None and trial.moved.rates is not None
        kept, on = (first <= TIME) & (last >= TIME), trial.plates[0]
        plate, wrench = on.plate, on.plate.wrench
        wrench = replace(wrench, force=wrench.force[kept], moment=wrench.moment[kept], origin=wrench.origin[kept])
        moved = replace(trial.moved, time=TIME[kept], values=trial.moved.values[kept], rates=trial.moved.rates[kept])
        return replace(trial, moved=moved, plates=(replace(on, plate=replace(plate, time=TIME[kept], wrench=wrench)),))

    return damage


def uneven(copied: bool) -> Change:
    """Right hip and knee bend less than the left ones, or the right knee's column is the left one's."""

    def change(_: TrialInputs) -> TrialInputs:
        trial = risen()
        assert trial.moved is not None
        columns = [c.name for c in trial.moved.model.coordinates]
        values = trial.moved.values.copy()
        values[:, columns.index("hip_r")] *= 0.96
        values[:, columns.index("knee_r")] *= 1.0 if copied else 0.96
        return replace(trial, moved=replace(trial.moved, values=values))

    return change


def tilted(share: float) -> Change:
    """With a part of the force out of the floor in the force along it."""

    def damage(_: TrialInputs) -> TrialInputs:
        trial = risen()
        on = trial.plates[0]
        force = on.plate.wrench.force.copy()
        force[:, 0] += share * force[:, 1]
        return replace(
            trial, plates=(replace(on, plate=replace(on.plate, wrench=replace(on.plate.wrench, force=force))),)
        )

    return damage


def seated(by: float) -> Change:
    """On a chair before the rise, whose plate is elsewhere [m]; its load goes over to the feet within 0.1 s."""

    def damage(_: TrialInputs) -> TrialInputs:
        trial = risen()
        on = trial.plates[0]
        whole = on.plate.wrench.force
        share = np.clip((TIME - FIRST) / 0.1, 0.0, 1.0)[:, None]
        place = np.tile([by, 0.0, 0.0], (len(TIME), 1))
        chair = ForcePlate(
            "chair", TIME, Wrench((1.0 - share) * whole, 0.0 * whole, place, "ground"), np.zeros(3), on.plate.normal
        )
        feet = replace(on.plate, wrench=replace(on.plate.wrench, force=share * whole))
        return replace(trial, plates=(replace(on, plate=feet), FootPlate(chair, "plates.mot")))

    return damage


DAMAGED: dict[str, tuple[str, Change]] = {
    "cross-talk of 15 %": ("level", tilted(0.15)),
    "a chair 0.2 m ahead": ("balance before the rise", seated(0.2)),
    "a knee's column copied": ("one coordinate twice", uneven(copied=True)),
    "radians as degrees": ("angles in degrees", angled(np.radians)),
    "angles to whole degrees": ("resolution", angled(lambda q: np.radians(np.round(np.degrees(q))))),
    "sign of all angles": ("range of a coordinate", angled(np.negative)),
    "a plate 0.1 s late under who rises": ("weight in time", later(0.1)),
    "a plate 0.1 s early under who rises": ("weight in time", later(-0.1)),
    "feet 0.1 m aside": ("balance", aside(0.1)),
    "sign of the rates": ("rates", rated(-1.0)),
    "rates in degrees": ("rates", rated(np.degrees(1.0))),
    "pounds of who rises": ("mass and height", lambda _: replace(risen(), mass=2.2046 * MASS)),
    "height in feet": ("mass and height", lambda _: replace(risen(), height=5.74)),
    "legs of a child": ("mass and height", lambda _: risen(person(0.7 * THIGH, 0.7 * SHANK))),
    "pounds of who stands": ("mass and height", stood(mass=2.2046 * MASS)),
    "markers 30 % larger": ("mass and height", stood(height=HEIGHT / 1.3)),
    "thigh and shank exchanged by a scale": ("thigh and shank", lambda _: risen(person(0.6 * THIGH, SHANK / 0.7))),
    "knees and ankles exchanged": ("thigh and shank", stood(standing=standing(KNE=0.12))),
    "a knee at the thigh": ("thigh and shank", stood(standing=standing(RKNE=0.33))),
    "time in ms": ("sampling", channel("N", 100.0, 1.0)),
    "time in minutes": ("sampling", channel("N", 100.0, 1e-6)),
    "N mm as N m": ("size of a channel", channel("N m", 60e3)),
    "mV as V": ("size of a channel", channel("V", 500.0)),
    "degrees as radians": ("size of a channel", channel("rad", 60.0)),
    "MPa as Pa": ("size of a channel", channel("Pa", 2.0)),
    "mN as N": ("size of a channel", channel("N", 5e5)),
}
NEARLY: dict[str, Change] = {
    "who rises": lambda _: risen(),
    "who rises unevenly": uneven(copied=False),
    "who hardly moves, in degrees": angled(lambda q: np.radians(0.2) * q / np.abs(q).max()),
    "angles to a tenth of a degree": angled(lambda q: np.radians(np.round(np.degrees(q), 1))),
    "knees 8 degrees beyond their range": angled(lambda q: np.full_like(q, np.radians(20.0))),
    "feet 30 mm aside": aside(0.03),
    "cross-talk of 5 %": tilted(0.05),
    "a chair 60 mm ahead": seated(0.06),
    "rates as they are": rated(1.0),
    "rates a fifth too large": rated(1.2),
    "0.03 s late under who rises": later(0.03),
    "who rises, begun on the way": cut(0.9, 2.0),
    "who rises, ended on the way": cut(0.0, 0.9),
    "short legs": lambda _: risen(person(0.9 * THIGH, 0.9 * SHANK)),
    "thin": stood(mass=50.0),
    "stout": stood(mass=140.0),
    "another height": stood(height=1.1 * HEIGHT),
    "knees 40 mm apart": stood(standing=standing(RKNE=0.307)),
    "60 Hz": channel("N", 100.0, 1.0 / 60.0),
    "200 N m": channel("N m", 200.0),
    "a jump's landing": channel("N", 8e3),
    "an amplified electromyogram": channel("V", 5.0),
}
