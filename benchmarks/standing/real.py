"""Phase A on real steps: the feet's contact from the stance phases of `opensim_walk`, `--data` a folder that holds it.

`python -m benchmarks.standing.real --data DATA`. One leg of three segments in the sagittal plane stands on a heel and a
toe sphere; what the rest of the body does to it is a force and a moment at the hip that are given: the plate's force
less what accelerates the leg, all low-passed alike. So the balance asks the spheres for about the force of the plate,
and phase A finds their parameters and the motion within the markers' error. Right and left steps of the overground walk
calibrate; the second right one is predicted with what was found. The foot is rigid from heel to toe, which it is not
after heel-off. Mass is what the plates say; markers stand for joints: ankle, knee, ASIS.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.one_core import pin
from benchmarks.prosthesis.real_foot import WALKS, markers, stances
from geocontact.io.mocap.force_plates import plate_named, read_force_plates
from geocontact.standing_up.chain import SOUGHT, Subject
from geocontact.standing_up.stance import CUTOFF, JERK, LEAST, MOST_TURN, SIZES, load_of_the_rest, standing_leg
from geocontact.standing_up.trials import CostWeights, StandingNoise, StandingTrial

HERE = Path(__file__).resolve().parents[1]
FEET = {"right": "R", "left": "L"}
CALIBRATION, HELD_OUT = ("right_1", "left_1"), ("right_2",)
NOISE = StandingNoise(**SIZES)
"""Markers on soft tissue, and ankle and hip by one marker each."""
JERKY = CostWeights(**JERK)


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.standing.real", description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--nodes", type=float, default=60.0)
    options = parser.parse_args()
    pin()
    from benchmarks.machine import as_json, machine, versions

    report = {"machine": machine(), "versions": versions({"casadi", "numpy", "scipy"})} | steps(options)
    (HERE / "results" / "standing_real.json").write_text(as_json(report, 2), encoding="utf-8")
    print(json.dumps(report, indent=2))


def steps(options: argparse.Namespace) -> dict[str, Any]:
    """Calibrated on two steps, held on the third."""
    from geocontact.dynamics.collocation.solve import SolverOptions
    from geocontact.standing_up.calibrated_phase import PhaseSearch, calibrated_phase
    from geocontact.standing_up.phase import standing_phase
    from geocontact.standing_up.phases import phase_a

    trials, subject = recorded_steps(options.data)
    model = standing_leg(subject)
    search = PhaseSearch(SolverOptions("radau", 4, 1, 1e-6, 150, 60.0), options.nodes)
    report: dict[str, Any] = {"mass [kg]": subject.mass, "height [m]": subject.height}
    start = None
    for kind, names, free in (("calibrated", CALIBRATION, SOUGHT), ("held out", HELD_OUT, ())):
        began, own = time.process_time(), [trials[name] for name in names]

        def build(these: Any, begin: Any, free: Any = free, at: Any = start) -> Any:
            tracks = ("coordinates", "force", "centre")
            if not free:
                of = {"free": (), "tracks": tracks, "small": {}, "held": at, "start": at, "jerk_sizes": JERKY.jerk}
                return standing_phase(model, subject, these, NOISE, **of)
            return phase_a(model, subject, these, NOISE, free=free, tracks=tracks, start=begin, weights=JERKY)

        one = calibrated_phase("A", model, own, NOISE, build, search)
        start = one.found.p
        report[kind] = told(one, own) | {"cpu seconds": time.process_time() - began}
    return report


def told(one: Any, trials: list[StandingTrial]) -> dict[str, Any]:
    """How it ended, parameters, and what each step is off."""
    from geocontact.standing_up.trials import seen_in

    rows = {}
    for trial, motion, seen in zip(trials, one.found.motions, one.motions, strict=True):
        model = seen_in(one.model, motion, one.found.p, trial.time, trial.name)
        loaded = trial.force[:, 1] > 2.0 * LEAST
        off = np.sqrt(np.mean((model.force - trial.force) ** 2, axis=0))
        rows[trial.name] = {
            "GRF [N]": off.tolist(),
            "GRF, largest measured [N]": trial.force[:, 1].max(),
            "CoP [mm]": 1e3 * float(np.sqrt(np.mean((model.centre - trial.centre)[loaded] ** 2))),
            "foot [mm]": (1e3 * np.sqrt(np.mean((model.q - trial.q)[:, :2] ** 2, axis=0))).tolist(),
            "turns [deg]": np.degrees(np.sqrt(np.mean((model.q - trial.q)[:, 2:] ** 2, axis=0))).tolist(),
            "residual [N, N m]": [float(seen.force.max()), float(seen.moment.max())],
            "certified": seen.certificate is not None and seen.certificate.converged,
        }
    numbers = {n.name: [n.value, n.lower, n.upper, n.verdict] for n in one.numbers.numbers}
    return {"ending": one.found.ending, "iterations": one.found.iterations, "parameters": numbers, "steps": rows}


def recorded_steps(data: Path) -> tuple[dict[str, StandingTrial], Subject]:
    """Steps of the overground walk by name, and whose mass and height they are."""
    from scipy.signal import butter, filtfilt

    walk, home = WALKS["overground"], data / "opensim_walk"
    time, points = markers(home / walk.markers)
    plates = read_force_plates(home / walk.plates)
    low = butter(2, CUTOFF / (0.5 / (time[1] - time[0])))
    smooth = {name: filtfilt(*low, place, axis=0) for name, place in points.items() if np.isfinite(place).all()}
    loads = {name: _plate(plate_named(plates, foot.plate, Path(walk.plates), "plate"), time, low)
             for name, foot in walk.feet.items()}  # fmt: skip
    whole = sum(load[:, 1] for load in loads.values())
    mass = float(np.median(whole[whole > 400.0])) / 9.81
    shank = np.median([np.hypot(*(smooth[f"{s}.Knee"] - smooth[f"{s}.Ankle"]).T) for s in FEET.values()])
    subject = Subject(mass, float(shank) / 0.2529)
    found = {}
    for name, foot in walk.feet.items():
        plate = plate_named(plates, foot.plate, Path(walk.plates), "plate")
        for k, (begin, end) in enumerate(stances(plate.time, plate.wrench.force[:, 1])):
            load = loads[name]
            inside = (time >= begin) & (time <= end) & (load[:, 1] > LEAST)
            if inside.sum() > 30:
                found[f"{name}_{k + 1}"] = _step(f"{name}_{k + 1}", FEET[name], time, smooth, load, inside, subject)
    return found, subject


def _plate(plate: Any, time: np.ndarray, low: Any) -> np.ndarray:
    """Force forwards and up, and moment about the origin, low-passed as the markers are (t, 3)."""
    from scipy.signal import filtfilt

    wrench = plate.at(np.clip(time, *plate.time[[0, -1]]))
    raw = np.nan_to_num(np.column_stack([wrench.force[:, :2], wrench.moment[:, 2]]))
    return np.asarray(filtfilt(*low, raw, axis=0))


def _step(
    name: str, side: str, time: np.ndarray, at: dict[str, np.ndarray], load: np.ndarray, inside: Any, subject: Subject
) -> StandingTrial:
    """Coordinates of the leg, the plate, and the load at the hip that balances both."""
    heel, toe, ankle, knee, hip = (at[f"{side}.{part}"] for part in ("Heel", "MT5", "Ankle", "Knee", "ASIS"))
    flat = inside & (load[:, 1] > 0.8 * 9.81 * subject.mass)
    turn = np.arctan2(*(toe - heel).T[::-1])
    turn = turn - np.median(turn[flat])
    lean = [np.arctan2(*(upper - lower).T) for lower, upper in ((ankle, knee), (knee, hip))]
    # the origin lies where the ankle stands
    start = float(np.median(ankle[flat, 0]))
    load = load - np.outer(start * load[:, 1], [0.0, 0.0, 1.0])
    q = np.column_stack([ankle - [start, 0.0], turn, -lean[0] - turn, -lean[1] + lean[0]])
    u = np.gradient(q, time[1] - time[0], axis=0)
    rest = load_of_the_rest(subject, time, q, load)
    inside = inside & (turn > -MOST_TURN)
    centre = load[inside, 2] / load[inside, 1]
    return StandingTrial(
        time[inside] - time[inside][0], q[inside], u[inside], load[inside, :2], centre, name, chair=rest[inside]
    )


if __name__ == "__main__":
    main()
