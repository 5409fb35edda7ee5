"""The intact foot's spheres on real walks: `python -m benchmarks.prosthesis.intact [--data FOLDER]`.

Steps over force plates of three able-bodied recordings: overground and on a treadmill (`opensim_walk`), and one of
another laboratory (`bmclab_gait_c3d`). A rigid foot in the sagittal plane carries a row of spheres with the law of the
prosthetic foot's, as in `benchmarks.prosthesis.real_foot`; stiffness and damping of the rows are fitted to some steps
(`below_knee_prosthesis.foot_in_plane.row_numbers`), the others are predicted by `loads.sphere_set`. Beside each
figure stands what needs no model: the mean curve of the steps that were fitted to. What nobody measured: how deep the
spheres are in a foot that stands flat, friction, and which part of the foot is rigid. Answers go to
benchmarks/results/prosthesis_intact.json.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from benchmarks.machine import write_results
from benchmarks.prosthesis import real_foot
from geocontact.below_knee_prosthesis.both_sides.intact_leg import KINETIC, STATIC
from geocontact.below_knee_prosthesis.foot_in_plane import FootInPlane, row_numbers
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.contact.sphere_foot import normal_force
from geocontact.data.multibody.force_plate import ForcePlate
from geocontact.geometry.shapes import HalfSpace
from geocontact.identify.signals.agreement import agreement
from geocontact.identify.signals.filters import zero_lag
from geocontact.io.mocap.force_plates import plate_named, read_force_plates
from geocontact.io.mocap.markers import read_markers
from geocontact.loads.centre_of_pressure import centre_of_pressure
from geocontact.loads.resultant import pose_rate
from geocontact.loads.sphere_set import SoleLaw, SphereSet, sphere_loads

MASS = {"overground": 75.3, "treadmill": 72.6}
"""kg; of the recordings' own models."""
LAB = Path("bmclab_gait_c3d") / "Gait.c3d"
FEET = {"right": ("RHEE", "RTOE", 1), "left": ("LHEE", "LTOE", 0)}
"""Markers and place of the plate, in that laboratory: x backwards along the walk, z up."""
FULL_DEPTH, THRESHOLD, SOFTEST, SINK = 2e-3, 0.25, 1.0, 0.010
"""m, m/s, N/m and m: depth of full damping, speed from which friction is that of sliding, least stiffness of a sphere,
depth in a foot that stands flat, which was taken after 5, 10, 15 and 20 mm had been looked at."""
FRONT = "toe"
"""Marker that the row of spheres ends at; where it ends at the metatarsal the last of the path is missing."""
REACH, TURN, HALVINGS = 0.03, np.radians(15.0), 30
"""m and rad; within which corrections of height and pitch are sought, and how often the interval is halved."""
GATE, CUTOFF, SHARES = 60.0, 15.0, np.linspace(0.0, 1.0, 101)
"""N; below it a centre of pressure is not compared. Hz; of the markers."""


@dataclass(frozen=True, eq=False)
class OnPlate:
    """One step: where the foot is, the plate's force forwards and upwards [N], and its centre in the foot [m]."""

    foot: FootInPlane
    force: np.ndarray
    centre: np.ndarray
    weight: float
    length: float

    def at_shares(self, values: np.ndarray) -> np.ndarray:
        """Over the stance on the plate."""
        on = np.flatnonzero(self.force[:, 1] >= real_foot.LOADED)
        time = self.foot.time
        return np.interp(time[on[0]] + SHARES * (time[on[-1]] - time[on[0]]), time, values)


def on_plate(pose: Any, force: np.ndarray, centre: np.ndarray, weight: float, length: float) -> OnPlate:
    """Of a table of `real_foot.pose` and the plate's force and centre at its times."""
    time, x, y, pitch = (pose[name].to_numpy() for name in pose)
    foot = FootInPlane(time, x, y, pitch, np.array([1.0, 0.0, 0.0]))
    place = np.column_stack([centre, 0.0 * centre, 0.0 * centre])
    _, _, own = foot.reaction(np.column_stack([force, 0.0 * centre]), place)
    return OnPlate(foot, force, np.where(force[:, 1] >= GATE, own, np.nan), weight, length)


def read_at(time: np.ndarray, plate: ForcePlate, turn: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Force forwards and upwards and the centre along the walk, at the markers' times; `turn` makes x and y of them."""
    force, centre = plate.wrench.force @ turn.T, plate.centre_of_pressure(real_foot.LOADED) @ turn.T
    columns = [np.interp(time, plate.time, np.nan_to_num(each)) for each in (*force[:, :2].T, centre[:, 0])]
    return np.column_stack(columns[:2]), columns[2]


def opensim_steps(data: Path, name: str) -> dict[str, OnPlate]:
    """Of one of the walks of `benchmarks.prosthesis.real_foot`."""
    walk, home = real_foot.WALKS[name], data / real_foot.HOME
    time, points = real_foot.markers(home / walk.markers)
    plates = read_force_plates(home / walk.plates)
    steps = real_foot.steps_of(walk, FRONT, time, points, plates)
    belt = real_foot.belt_speed(list(steps.values())) if walk.belt else 0.0
    found = {}
    for key, step in steps.items():
        standing = real_foot.Standing.of([each for each in steps.values() if each.foot == step.foot])
        pose = real_foot.pose(step, standing)
        force, centre = read_at(step.time, plate_named(plates, walk.feet[step.foot].plate, home, "plate"), np.eye(3))
        one = on_plate(pose, force, centre, MASS[name] * GRAVITY, standing.length)
        found[key] = OnPlate(moved(one.foot, belt), one.force, one.centre, one.weight, one.length)
    return found


def moved(foot: FootInPlane, belt: float) -> FootInPlane:
    """As the belt sees it."""
    return FootInPlane(foot.time, foot.x + belt * (foot.time - foot.time[0]), foot.y, foot.pitch, foot.forward)


def lab_steps(data: Path) -> dict[str, OnPlate]:
    """One step of each foot; the weight is a stance's impulse over the time between the feet's landings."""
    seen, plates = read_markers(data / LAB), read_force_plates(data / LAB)
    turn = np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
    spans = {side: real_foot.stances(plates[k].time, plates[k].wrench.force[:, 2])[0] for side, (*_, k) in FEET.items()}
    landing = abs(spans["right"][0] - spans["left"][0])
    impulse = [np.trapezoid(np.nan_to_num(plates[k].wrench.force[:, 2]), plates[k].time) for *_, k in FEET.values()]
    weight, found = float(np.mean(impulse)) / landing, {}
    for side, (heel, front, k) in FEET.items():
        begin, end = spans[side]
        known = np.isfinite(seen.of((heel, front))).all(axis=(1, 2))
        time = seen.time[known]
        rate = float(np.median(np.diff(time)))
        places = [zero_lag(seen.of((name,))[known, 0] @ turn.T, rate, CUTOFF)[:, :2] for name in (heel, front)]
        kept = (time >= begin - real_foot.AROUND) & (time <= end + real_foot.AROUND)
        share = (time[kept] - begin) / (end - begin)
        flat = (share >= real_foot.FLAT[0]) & (share <= real_foot.FLAT[1])
        step = real_foot.Step(side, time[kept], *(each[kept] for each in places), flat)
        standing = real_foot.Standing.of([step])
        force, centre = read_at(step.time, plates[k], turn)
        found[f"{side}_1"] = on_plate(real_foot.pose(step, standing), force, centre, weight, standing.length)
    return found


def sole(length: float) -> SphereSet:
    """`real_foot.SPHERES` in a row, a zone each."""
    table = real_foot.spheres(length, SINK)
    places = np.column_stack([table["px [m]"], table["py [m]"], 0.0 * table["px [m]"]])
    return SphereSet(places, table["radius [m]"].to_numpy(), tuple(f"row_{k:02d}" for k in range(len(places))))


def law_of(stiffness: np.ndarray, damping: np.ndarray) -> SoleLaw:
    """Linear, as that of the prosthetic foot."""
    rub = [np.full(len(stiffness), each) for each in (STATIC, KINETIC)]
    return SoleLaw(stiffness, damping, 1.0, FULL_DEPTH, rub[0], rub[1], THRESHOLD)


def fitted(steps: Sequence[OnPlate]) -> tuple[SphereSet, SoleLaw]:
    """Of some steps, one after the other."""
    length, start, parts = float(np.median([each.length for each in steps])), 0.0, []
    for each in steps:
        parts.append((each.foot.time - each.foot.time[0] + start, each.foot.x, each.foot.y, each.foot.pitch))
        start = float(parts[-1][0][-1]) + 0.01
    whole = FootInPlane(*(np.concatenate(column) for column in zip(*parts, strict=True)), steps[0].foot.forward)
    force, centre = (np.concatenate(each) for each in zip(*((s.force[:, 1], s.centre) for s in steps), strict=True))
    spheres, unit = sole(length), np.ones(real_foot.SPHERES)
    found = row_numbers(whole, spheres, law_of(unit, unit), force, centre)
    numbers = [np.array([of[zone] for zone in spheres.zone]) for of in (found.stiffness, found.damping)]
    return spheres, law_of(np.maximum(numbers[0], SOFTEST), numbers[1])


def predicted(one: OnPlate, spheres: SphereSet, law: SoleLaw) -> tuple[np.ndarray, np.ndarray]:
    """Force forwards and upwards [N], and the centre in the foot [m]."""
    foot = one.foot
    place = np.column_stack([foot.x, foot.y, 0.0 * foot.x])
    poses = RigidTransform.from_components(place, Rotation.from_euler("z", foot.pitch[:, None]))
    loads = sphere_loads(spheres, law, poses, pose_rate(foot.time, poses), HalfSpace())
    centre = centre_of_pressure(loads, "ground", GATE).centre
    _, _, own = foot.reaction(loads.force.sum(axis=1), np.nan_to_num(centre))
    return loads.force.sum(axis=1)[:, :2], own


def beside(one: OnPlate, model: np.ndarray, measured: np.ndarray, scale: float) -> tuple[float, float]:
    """R² and error over `scale`, where both are known."""
    known = np.isfinite(model) & np.isfinite(measured)
    if not known.any():
        return float("nan"), float("nan")
    told = agreement(model[known] / scale, measured[known] / scale, 1.0, 0.0)
    return told.r2, told.rmsd


def corrected(one: OnPlate, spheres: SphereSet, law: SoleLaw, *, turned: bool) -> dict[str, float]:
    """By how much the foot is higher or lower, frame by frame, than with which the model has the plate's upward force.

    With `turned` its pitch about the middle is free as well, so that the centre is the plate's too. Root mean squares
    of both corrections, of the height about its mean over the step, and of what is left of the centre over the length.
    """
    foot = one.foot
    px, py, radius = spheres.centre[:, 0], spheres.centre[:, 1], spheres.radius
    middle = 0.5 * one.length

    def pressed(raised: np.ndarray, tilt: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        pitch = foot.pitch + tilt
        s, c = np.sin(pitch)[:, None], np.cos(pitch)[:, None]
        y = foot.y + raised + middle * (np.sin(foot.pitch) - np.sin(pitch))
        depth = radius - (y[:, None] + px * s + py * c)
        rate = np.gradient(radius - (foot.y[:, None] + px * np.sin(foot.pitch)[:, None] + py * c), foot.time, axis=0)
        force = normal_force(depth, rate, law.stiffness, law.exponent, law.damping, law.full_depth)
        up = force.sum(axis=1)
        return up, (force * (px - s * radius)).sum(axis=1) / np.maximum(up, 1.0)

    on = np.isfinite(one.centre)
    low, high = (np.full(len(foot.time), each) for each in (-REACH, REACH))
    tilt = np.zeros(len(foot.time))
    turns = (np.full(len(tilt), -TURN), np.full(len(tilt), TURN))
    for _ in range(HALVINGS if turned else 1):
        tilt = 0.5 * (turns[0] + turns[1]) if turned else tilt
        low, high = (np.full(len(foot.time), each) for each in (-REACH, REACH))
        for _ in range(HALVINGS):
            raised = 0.5 * (low + high)
            more = pressed(raised, tilt)[0] > one.force[:, 1]
            low, high = np.where(more, raised, low), np.where(more, high, raised)
        ahead = pressed(raised, tilt)[1] > one.centre
        turns = np.where(ahead, tilt, turns[0]), np.where(ahead, turns[1], tilt)
    up, centre = pressed(raised, tilt)
    met = on & (np.abs(up - one.force[:, 1]) < 0.01 * one.weight)
    return {
        "height rms [mm]": 1e3 * float(np.sqrt(np.mean(raised[met] ** 2))),
        "height about its mean [mm]": 1e3 * float(np.std(raised[met])),
        "pitch rms [deg]": float(np.degrees(np.sqrt(np.mean(tilt[met] ** 2)))),
        "centre left": float(np.sqrt(np.mean((centre - one.centre)[met] ** 2))) / one.length,
        "share met": float(met.sum() / on.sum()),
    }


MEASURED: dict[str, Callable[[OnPlate], np.ndarray]] = {
    "vertical": lambda one: one.force[:, 1],
    "fore_aft": lambda one: one.force[:, 0],
    "centre": lambda one: one.centre,
}


def judged(steps: dict[str, OnPlate], calibration: Sequence[str]) -> dict[str, dict[str, float]]:
    """Errors of every step, and of the mean of those fitted to."""
    chosen = [steps[name] for name in calibration]
    spheres, law = fitted(chosen)
    found = {}
    for name, one in steps.items():
        force, centre = predicted(one, spheres, law)
        models = {"vertical": force[:, 1], "fore_aft": force[:, 0], "centre": centre}
        row: dict[str, Any] = {"calibrated": name in calibration}
        row["with another height"] = corrected(one, spheres, law, turned=False)
        row["with another height and pitch"] = corrected(one, spheres, law, turned=True)
        for key, model in models.items():
            measured, scale = MEASURED[key](one), one.length if key == "centre" else one.weight
            row[f"{key} r2"], row[f"{key} rmse"] = beside(one, model, measured, scale)
            others = [each.at_shares(MEASURED[key](each)) for each in chosen if each is not one]
            plain = np.mean(others, axis=0) if others else np.full(len(SHARES), np.nan)
            told = one.at_shares(measured)
            row[f"{key} plain rmse"] = beside(one, plain, told, scale)[1]
        found[name] = row
    return found


def figures(data: Path) -> dict[str, dict[str, dict[str, float]]]:
    """By recording and step."""
    found = {}
    for name, walk in real_foot.WALKS.items():
        found[name] = judged(opensim_steps(data, name), walk.calibration)
    found["bmclab"] = judged(lab_steps(data), ("right_1",))
    return found


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    default = Path(os.environ.get("GEOCONTACT_DATA") or Path(__file__).resolve().parents[3] / "shared" / "data")
    parser.add_argument("--data", type=Path, default=default)
    asked = parser.parse_args()
    told = figures(asked.data)
    for name, steps in told.items():
        for step, row in steps.items():
            words = [
                f"{key} R² {row[f'{key} r2']:.2f}, {row[f'{key} rmse']:.1%} (plain {row[f'{key} plain rmse']:.1%})"
                for key in ("vertical", "fore_aft", "centre")
            ]
            print(f"{name:11}{step:9}{'fitted   ' if row['calibrated'] else 'predicted'} {'; '.join(words)}")
            for key in ("with another height", "with another height and pitch"):
                print(f"    {key}: " + ", ".join(f"{what} {value:.3g}" for what, value in row[key].items()))
    write_results("prosthesis_intact", {}, told)


if __name__ == "__main__":
    main()
