"""The shoulder exoskeleton: an arm on a hinge that the recorded one drives; work at and above shoulder height.

The base model of CASES.md a second time. The deflection of the interface is u = -r, its force positive where it
supports; what is hooked in acts on them over the whole trial, and so does what is hooked in at the hinge.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pandas as pd
from jaxtyping import Float, Int
from scipy.interpolate import CubicSpline

from geocontact.data.parameter import Parameter
from geocontact.gap_benchmark.synthetic.course import InputCourse, Path, reached, through
from geocontact.gap_benchmark.synthetic.hooks import BASE, Hooks, Swing, Values, read
from geocontact.gap_benchmark.synthetic.noise import NoiseFilter, corner_of
from geocontact.gap_benchmark.synthetic.plan import (
    COMMON,
    COMMON_UNKNOWN,
    STRAP_IN_SERIES,
    STRAPPED,
    Biased,
    DriftingLength,
    EffectNumbers,
)
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene, SyntheticSystem, colour
from geocontact.gap_benchmark.synthetic.systems.interface import in_series, pull
from geocontact.gap_benchmark.synthetic.systems.swing import GRAVITY, Arm, Torque, at_rest, follow, swing, tick

INPUTS, OUTPUTS = ("arm", "event"), ("exo", "force")
UNITS = ("rad", "-", "rad", "N")
FORCE = 1
COARSEST = 2.5e-3
"""Longest step of the base model [s]."""
SMALL = 1e-5
"""Change by which slopes are taken [rad or rad/s]."""
Numbers = Mapping[str, float]
Table = Float[np.ndarray, "two k"]
"""Angles [rad] and torques of full support [N m]."""


@dataclass(frozen=True)
class Driven:
    """What drives the arm: the sphere's place from the hinge and its rate, rows x, y, x', y', over time [s]."""

    time: Float[np.ndarray, " t"]
    way: Float[np.ndarray, "four t"]

    def off(self, angle: Values) -> Values:
        """u = -r [m] at an angle of the arm."""
        return np.asarray(-self.way[0] * np.cos(angle) - self.way[1] * np.sin(angle))

    def along(self, angle: Values) -> Values:
        """s [m]."""
        return np.asarray(self.way[0] * np.sin(angle) - self.way[1] * np.cos(angle))

    @property
    def still(self) -> Driven:
        """A course that rests where it begins."""
        begin = np.repeat(self.way[:, :1], 3, axis=1)
        begin[2:] = 0.0
        return Driven(self.time[:3], begin)


def driven(course: InputCourse, numbers: Numbers, hooks: Hooks) -> Driven:
    """p = L_h (sin a, -cos a) less the hinge, which may drift with the arm."""
    angle, rate = course.position[0], course.rate[0]
    s, c, l = np.sin(angle), np.cos(angle), numbers["L_h"]
    o_x = np.full_like(angle, numbers["o_x"])
    for drift in hooks.axis:
        o_x = o_x + drift(angle)
    drift = np.gradient(o_x, course.time, edge_order=2)
    way = np.array([l * s - o_x, -l * c - numbers["o_y"], l * c * rate - drift, l * s * rate])
    return Driven(course.time, way)


def carried(time: Float[np.ndarray, " t"], u: Values, numbers: Numbers, hooks: Hooks) -> Values:
    """Force of the interface [N]; behind a spring in series the dashpot lies beside both springs."""
    k, b = numbers["k_t"], numbers["b_t"]
    if not hooks.series:
        return pull(time, u, k, hooks, b)
    elastic = in_series(u, partial(pull, time, k=k, hooks=hooks), hooks)
    return np.asarray(elastic + b * np.gradient(u, time, edge_order=2))


def torque_beyond(drive: Driven, numbers: Numbers, hooks: Hooks) -> Torque:
    """What the hooks make of the interface and of the hinge, less what the base model has [N m]."""
    time = drive.time

    def further(angle: Values) -> Values:
        u = drive.off(angle)
        force = carried(time, u, numbers, hooks)
        torque = (carried(time, u, numbers, BASE) - force) * drive.along(angle)
        rate = np.gradient(angle, time, edge_order=2)
        acceleration = np.gradient(rate, time, edge_order=2)
        acceleration[1:-1] = np.diff(angle, 2) / (time[1] - time[0]) ** 2
        return np.asarray(torque - sum(held(Swing(time, angle, rate, acceleration, force)) for held in hooks.hinge))

    return further


def arm_of(course: InputCourse, numbers: Numbers, table: Table) -> Arm:
    """The arm at a trial's level of support."""
    weight = numbers["m"] * GRAVITY * numbers["l_c"]
    torque = course.setting["level"] * table[1]
    return Arm(numbers["I"], numbers["c"], weight, numbers["k_t"], numbers["b_t"], table[0], torque)


def moved(course: InputCourse, numbers: Numbers, hooks: Hooks, table: Table) -> tuple[Driven, Values]:
    """What drives the arm, and the arm's angle, on a course whose samples are evenly apart."""
    drive, arm = driven(course, numbers, hooks), arm_of(course, numbers, table)
    begin = drive.still.way[:, 0]
    changed = bool(hooks.hinge or hooks.series or hooks.play or hooks.has_memory_in_law)
    further = torque_beyond(drive, numbers, hooks) if changed else None
    beyond = torque_beyond(drive.still, numbers, hooks) if changed else None

    def torque(e: float) -> float:
        more = 0.0 if beyond is None else float(beyond(np.full(3, e))[0])
        return float(arm.driven(np.asarray(e), np.zeros(()), begin)[0]) + more

    rest = at_rest(torque, float(np.arctan2(begin[0], -begin[1])))
    return drive, swing(float(course.time[1] - course.time[0]), drive.way, arm, further, rest)


def respond(course: InputCourse, numbers: Numbers, hooks: Hooks, table: Table) -> Float[np.ndarray, "c t"]:
    """exo [rad] and force [N] along a course."""
    for change in hooks.motion:
        course = change(course)
    drive, angle = moved(course, numbers, hooks, table)
    outputs = np.array([angle, carried(course.time, drive.off(angle), numbers, hooks)])
    for add in hooks.load:
        outputs = outputs + add(course, numbers)
    return read(hooks, course, outputs)


def finer(course: InputCourse) -> tuple[InputCourse, Int[np.ndarray, " s"]]:
    """Steps of at most `COARSEST`, evenly apart also where rows were lost; and which of them are the course's."""
    step = tick(course.time)
    h = step / np.ceil(step / COARSEST - 1e-6)
    rows = np.round((course.time - course.time[0]) / h).astype(int)
    path = through(course.time, course.position, course.duration, course.phase, course.setting)
    return path(course.time[0] + h * np.arange(rows[-1] + 1)), rows


def base_model(course: InputCourse, constants: Numbers, table: Table) -> Callable[[Values], Values]:
    """Outputs of the base model as a function of (k_t, b_t, m)."""
    fine, rows = finer(course)

    def outputs(theta: Values) -> Values:
        k, b, m = (float(value) for value in theta)
        numbers = {**constants, "k_t": k, "b_t": b, "m": m}
        drive, angle = moved(fine, numbers, BASE, table)
        return np.array([angle, carried(fine.time, drive.off(angle), numbers, BASE)])[:, rows]

    return outputs


def course_deflection(course: InputCourse, numbers: Numbers, table: Table) -> tuple[Values, Values]:
    """Deflection and rate of the base model along a course."""
    fine, rows = finer(course)
    drive, angle = moved(fine, numbers, BASE, table)
    u = drive.off(angle)
    return u[rows], np.gradient(u, fine.time, edge_order=2)[rows]


def passed_on(course: InputCourse, numbers: Numbers, row: int, noise: Values, table: Table) -> Values:
    """What small noise of an input makes of the outputs, "c t q" for "t q": the base model, linear about its motion."""
    if row:
        return np.zeros((len(OUTPUTS), *noise.shape))
    fine, rows = finer(course)
    h = float(fine.time[1] - fine.time[0])
    drive, angle = moved(fine, numbers, BASE, table)
    arm, rate = arm_of(course, numbers, table), np.gradient(angle, h, edge_order=2)

    def slope(name: str) -> tuple[Values, Values]:
        sides = [replace(fine, **{name: getattr(fine, name) + change}) for change in (SMALL, -SMALL)]
        more, less = (driven(side, numbers, BASE).way for side in sides)
        return half(arm.driven(angle, rate, more), arm.driven(angle, rate, less))

    by_arm, by_arm_rate = slope("position"), slope("rate")
    by_angle = half(*(arm.driven(angle + sign * SMALL, rate, drive.way) for sign in (1.0, -1.0)))
    by_rate = half(*(arm.driven(angle, rate + sign * SMALL, drive.way) for sign in (1.0, -1.0)))
    spline = CubicSpline(course.time, noise)
    shaken, shaking = spline(fine.time), spline(fine.time, 1)
    push, added = (by_arm[i][:, None] * shaken + by_arm_rate[i][:, None] * shaking for i in (0, 1))
    rest = -by_arm[0][0] / by_angle[0][0] * shaken[0]
    x = follow(h, arm.inertia, by_angle[0], by_rate[0], push, rest)
    force = added + by_angle[1][:, None] * x + by_rate[1][:, None] * np.gradient(x, h, axis=0, edge_order=2)
    return np.array([x[rows], force[rows]])


def half(more: tuple[Values, Values], less: tuple[Values, Values]) -> tuple[Values, Values]:
    """Slopes of torque and force by central differences."""
    torque, force = ((a - b) / (2.0 * SMALL) for a, b in zip(more, less, strict=True))
    return torque, force


EFFECTS = EffectNumbers(
    (*COMMON, "axis_migration", *STRAPPED, "contact_loss", "event_load", "gravity_load", "inertia_load"),
    (*COMMON_UNKNOWN, "catch"),
    biased=lambda scale: (Biased("arm", 0, 0.15, "rad", 0, scale.middle, 0.7 * scale.span),),
    quick=(0.06, 0.12),
    apart=(15.0, 30.0),
    gains=(0.9, 0.9),
    recovery=(0.08, 0.14),
    pitch=(3.5, 9.0),
    confounded=("damping", "gravity_load", "series_compliance"),
    hinge=0.25,
    either_way=True,
    axis=DriftingLength("o_x", 0.05, hanging=True),
    series=STRAP_IN_SERIES,
    uneven=(0.5, 0.8),
    thinning=(1.5, 3.0),
    thinning_departs=True,
    softer=1.5,
    lossy=4.0,
    relaxing=4.0,
    lagging=9.0,
    hanging=2.5,
    lever="L_h",
    heaviest=6.0,
)


def shoulder(support: pd.DataFrame) -> SyntheticSystem:
    """An exoskeleton with this support."""
    table = support[["angle [rad]", "torque [N m]"]].to_numpy(float).T.copy()
    return SyntheticSystem(
        partial(respond, table=table),
        partial(base_model, table=table),
        partial(course_deflection, table=table),
        EFFECTS,
        loads=(FORCE,),
        normal=(FORCE,),
        spare=INPUTS[1:],
        lengths=("L_h", "o_x", "o_y", "l_c"),
        passed_on=partial(passed_on, table=table),
        fine=4,
        quickest=1.4,
    )


@dataclass(frozen=True)
class ShoulderStyle:
    """How one case moves: `kind`, angles hanging and raised [rad], mean rate [rad/s], duration [s], step [s].

    "raise" goes up once, "heights" stops on the way, "cycle" goes up and down again and again. `levels` of support are
    taken in turn.
    """

    kind: str
    hanging: float
    raised: float
    pace: float
    duration: float
    step: float
    levels: tuple[float, ...]


def shoulder_path(rng: Rng, style: ShoulderStyle, turn: int) -> Path:
    """Trial number `turn`."""
    low, high = style.hanging + rng.normal(0.0, 0.05), style.raised + rng.normal(0.0, 0.08)
    places = {"raise": [low, high, low], "heights": [low, 0.5 * (low + high), high, low]}.get(
        style.kind, [low, high, low, high, low, high, low]
    )
    pace = style.pace * float(np.exp(rng.normal(0.0, 0.08)))
    moves = np.abs(np.diff(places)) / pace
    wait = rng.uniform(0.6, 1.1)
    duration = style.duration * float(np.exp(rng.normal(0.0, 0.04)))
    rests = max((duration - moves.sum() - 2.0 * wait) / max(len(moves) - 1, 1), 0.15) * rng.uniform(
        0.8, 1.0, len(moves) - 1
    )
    begin = wait + np.concatenate([[0.0], np.cumsum(moves[:-1] + rests)])
    runs = events(rng, begin[:-1] + moves[:-1], begin[1:], float(begin[-1] + moves[-1]))
    lasting = float(begin[-1] + moves[-1]) + wait
    sway, omega = rng.uniform(0.002, 0.006), 2.0 * np.pi * rng.uniform(0.25, 0.5)
    phase = rng.uniform(0.0, 2.0 * np.pi)
    setting = {"level": style.levels[turn % len(style.levels)]}

    def along(time: Float[np.ndarray, " t"]) -> InputCourse:
        place, rate, acceleration = (np.zeros_like(time) for _ in range(3))
        place += low
        for at, move, size in zip(begin, moves, np.diff(places), strict=True):
            share = (time - at) / move
            u = np.clip(share, 0.0, 1.0)
            place += size * reached(share, 0.0, 1.0)
            rate += size / move * 30.0 * u * u * (1.0 - u) ** 2
            acceleration += size / move**2 * 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u)
        # a body sways
        place += sway * (1.0 - np.cos(omega * time))
        rate += sway * omega * np.sin(omega * time)
        acceleration += sway * omega**2 * np.cos(omega * time)
        flag = np.any([(time >= a) & (time < b) for a, b in runs], axis=0).astype(float)
        nothing = np.zeros_like(time)
        rows = np.array([[place, flag], [rate, nothing], [acceleration, nothing]])
        return InputCourse(time, rows[0], rows[1], rows[2], lasting, phase, setting)

    return along


def events(
    rng: Rng, arrived: Float[np.ndarray, " m"], left: Float[np.ndarray, " m"], end: float
) -> tuple[tuple[float, float], ...]:
    """When the tool runs: while the arm is held long enough, else once at any time."""
    runs = []
    for begin, leave in zip(arrived, left, strict=True):
        if leave - begin > 1.0:
            start = begin + rng.uniform(0.1, 0.3) * (leave - begin)
            runs.append((start, start + rng.uniform(0.4, 0.65) * (leave - begin)))
    start = rng.uniform(0.2, 0.6) * end
    return tuple(runs) or ((start, start + 0.2 * end),)


LEVELS = ((0.0, 0.5, 1.0), (0.0, 0.5, 1.0), (0.0, 1.0), (0.3, 0.6, 1.0), (0.6, 0.8, 1.0))
"""Levels of support, taken in turn by the trials."""

RATE, STILL = 0.06, 0.0014
"""Noise of the recorded arm: of its rate [rad/s], about, whatever the corner, for who smooths little has markers of
low noise; and the most of its angle [rad]."""


def shoulder_scene(rng: Rng, *, shifted: bool) -> SyntheticScene:
    """An exoskeleton that carries the arm, at several levels of support."""
    typical = rng.random() < 0.55
    style = style_of(rng, typical=typical)
    later = other_style(rng, style) if shifted else style
    k, b, m = rng.normal(900.0, 40.0), rng.normal(30.0, 1.5), rng.normal(1.9, 0.05)
    if not typical:
        k, b, m = np.exp(rng.uniform(np.log(400.0), np.log(2000.0))), rng.uniform(10.0, 45.0), rng.uniform(1.2, 3.0)
    wide, corner = rng.uniform(0.6, 1.3), corner_of(rng, style.step)
    force = 0.4 if typical else float(np.exp(rng.uniform(np.log(0.2), np.log(0.8))))
    angle = 0.002 if typical else rng.uniform(0.001, 0.003)
    lengths = {"L_h": 0.25, "o_x": 0.01, "o_y": 0.02, "I": 0.09, "c": 0.2, "l_c": 0.2}
    if not typical:
        other = {"L_h": (0.2, 0.3), "o_x": (-0.02, 0.03), "o_y": (-0.01, 0.03), "I": (0.05, 0.15), "c": (0.05, 0.4)}
        lengths |= {name: rng.uniform(*within) for name, within in other.items()}
        lengths["l_c"] = rng.uniform(0.15, 0.25)
    return SyntheticScene(
        "shoulder",
        INPUTS,
        OUTPUTS,
        UNITS,
        (
            Parameter("k_t", "N/m", 700.0, 100.0, 5000.0),
            Parameter("b_t", "N s/m", 20.0, 0.0, 100.0),
            Parameter("m", "kg", 2.0, 0.3, 5.0),
        ),
        lengths,
        {"support": (table := support(rng, typical=typical))},
        np.array([k, b, m]),
        (np.diag([0.03 * k, 0.05 * b, 0.004 * m]) * wide) ** 2,
        (colour(rng, angle), colour(rng, force)),
        np.array([min(rng.uniform(0.6, 1.2) * RATE / (2.0 * np.pi * corner), STILL), 0.0]),
        style.step,
        (NoiseFilter(corner), NoiseFilter(corner)),
        lambda r, i: shoulder_path(r, style, i),
        lambda r, i: shoulder_path(r, later, i),
        shoulder(table),
    )


def support(rng: Rng, *, typical: bool) -> pd.DataFrame:
    """Torque of full support: rises from the hanging arm, is largest about shoulder height and falls above it."""
    top = 8.0 if typical else rng.uniform(5.0, 12.0)
    apart = 0.2 if typical else float(rng.choice([0.1, 0.2, 0.25]))
    begin, peak = rng.uniform(-0.15, -0.05), rng.uniform(1.35, 1.6)
    angle = np.arange(-0.6, 3.0, apart)
    rising = np.sin(np.clip(0.5 * np.pi * (angle - begin) / (peak - begin), 0.0, np.pi))
    return pd.DataFrame({"angle [rad]": angle.round(4), "torque [N m]": (top * rising).round(3)})


def style_of(rng: Rng, *, typical: bool) -> ShoulderStyle:
    """How somebody works."""
    if typical:
        return ShoulderStyle("raise", 0.25, 1.5, 0.8, 8.2, 0.01, LEVELS[0])
    kind = str(rng.choice(["raise", "heights", "cycle"]))
    step = float(rng.choice([0.01, 0.02]))
    hanging, raised = rng.uniform(0.15, 0.4), rng.uniform(1.2, 2.0)
    pace = float(np.exp(rng.uniform(np.log(1.4 if kind == "cycle" else 0.7), np.log(2.0))))
    return ShoulderStyle(
        kind, hanging, raised, pace, rng.uniform(6.0, 9.0), step, LEVELS[int(rng.integers(len(LEVELS)))]
    )


def other_style(rng: Rng, style: ShoulderStyle) -> ShoulderStyle:
    """Faster, or higher."""
    if rng.random() < 0.5:
        return replace(style, pace=style.pace * rng.uniform(1.4, 1.9))
    return replace(style, raised=style.raised + rng.uniform(0.25, 0.45))
