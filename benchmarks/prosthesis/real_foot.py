"""Steps over force plates as gap cases of the foot on spheres, from the markers and plates of `opensim_walk`.

A step is a trial. The foot is rigid from the heel marker to a marker in front, and moves in the plane of x (forward)
and y (up). Its frame lies on the sole under the heel marker; pitch and height are counted from where the foot stands
flat: the median over 25 to 50 % of the steps that are fitted to, each foot by itself, since markers do not tell where
the sole is. Spheres stand in a row from under the heel marker to under the one in front, one third of the row a zone;
in a foot that stands flat they are as deep in the ground as `Placement.sink` says. Nobody measured that.

On a treadmill the ground runs backwards at the speed at which the standing heel does.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks.knee.paper_004 import geocontact
from geocontact.data.multibody.force_plate import ForcePlate
from geocontact.io.mocap.force_plates import plate_named, read_force_plates

HOME = "opensim_walk"
LOADED = 20.0  # N, from which the foot is on the plate
SHORTEST = 0.5  # s, on the plate: less is the rest of a step that began before the recording
AROUND = 0.05  # s, before and after a step that belong to its trial: nothing presses there
FLAT = (0.25, 0.5)  # of a step: heel and forefoot are on the ground
SPHERES, RADIUS = 12, 0.02  # m
ZONES = ("heel", "mid", "fore")
STIFFNESS = {"start": "8e4", "lower": "1e3", "upper": "1e7", "unit": '"N/m^n"'}
DAMPING = {"start": "200.0", "lower": "0.0", "upper": "2e4", "unit": '"N s/m"'}
Points = Mapping[str, np.ndarray]


@dataclass(frozen=True)
class Foot:
    """Markers and plate of one foot; of those that may be its front the first is taken unless another is named."""

    heel: str
    front: Mapping[str, str]
    plate: str


@dataclass(frozen=True)
class Walk:
    """A recording of somebody who walks in x; `belt`: on a treadmill."""

    markers: str
    plates: str
    feet: Mapping[str, Foot]
    belt: bool
    calibration: tuple[str, ...]
    evaluation: tuple[str, ...]


@dataclass(frozen=True)
class Placement:
    """What nobody measured.

    Parameters
    ----------
    front
        Marker up to which the foot is rigid; "" for the first of `Foot.front`: the metatarsal where there is one, since
        toes bend behind it.
    sink
        Depth of the spheres [m] in a foot that stands flat.
    threshold_speed
        Constant v_th of the law [m/s].
    """

    front: str = ""
    sink: float = 0.005
    threshold_speed: float = 0.25


WALKS = {
    "overground": Walk(
        "markers_walk.trc",
        "grf_walk.mot",
        {
            "right": Foot("R.Heel", {"metatarsal": "R.MT5", "toe": "R.Toe"}, "ground_force_r"),
            "left": Foot("L.Heel", {"metatarsal": "L.MT5", "toe": "L.Toe"}, "ground_force_l"),
        },
        False,
        ("right_1", "left_1"),
        ("right_2",),
    ),
    "treadmill": Walk(
        "subject01_walk1.trc",
        "subject01_walk1_grf.mot",
        {
            "right": Foot("R.Heel", {"toe": "R.Toe.Tip", "midfoot": "R.Midfoot.Lat"}, "ground_force"),
            "left": Foot("L.Heel", {"toe": "L.Toe.Tip", "midfoot": "L.Midfoot.Lat"}, "1_ground_force"),
        },
        True,
        ("right_1", "left_1"),
        ("right_2", "left_2"),
    ),
}


@dataclass(frozen=True)
class Step:
    """Times of a foot's markers [s] around one step, their places (t, 2) [m], and when it stands flat."""

    foot: str
    time: np.ndarray
    heel: np.ndarray
    front: np.ndarray
    flat: np.ndarray


@dataclass(frozen=True)
class Standing:
    """Of a foot that stands flat: height of the heel marker [m], rise [rad] and distance [m] to the marker in front."""

    height: float
    rise: float
    length: float

    @classmethod
    def of(cls, steps: list[Step]) -> Standing:
        """Medians over the flat part of steps of one foot."""
        heel, front = (np.concatenate([getattr(step, key)[step.flat] for step in steps]) for key in ("heel", "front"))
        way = front - heel
        rise = np.arctan2(way[:, 1], way[:, 0])
        return cls(*(float(np.median(each)) for each in (heel[:, 1], rise, np.hypot(*way.T))))


def markers(file: Path) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Times [s] and places in x and y [m] of the markers of a .trc file in mm."""
    head = file.read_text(encoding="utf-8").splitlines()[:4]
    said = dict(zip(head[1].split(), head[2].split(), strict=False))
    if said["Units"] != "mm":
        raise SystemExit(f"{file}: not in mm")
    names = [name for name in head[3].split("\t")[2:] if name.strip()]
    rows = pd.read_csv(file, sep="\t", skiprows=5, header=None).to_numpy(float)
    return rows[:, 1], {name: 1e-3 * rows[:, 2 + 3 * k : 4 + 3 * k] for k, name in enumerate(names)}


def steps_of(
    walk: Walk, front: str, time: np.ndarray, points: Points, plates: tuple[ForcePlate, ...]
) -> dict[str, Step]:
    """Steps by name, `right_1` the first of the right foot."""
    found = {}
    for name, foot in walk.feet.items():
        plate = plate_named(plates, foot.plate, Path(walk.plates), "plate")
        for k, (begin, end) in enumerate(stances(plate.time, plate.wrench.force[:, 1])):
            inside = (time >= begin - AROUND) & (time <= end + AROUND)
            share = (time[inside] - begin) / (end - begin)
            places = (points[key][inside] for key in (foot.heel, foot.front[front or next(iter(foot.front))]))
            found[f"{name}_{k + 1}"] = Step(name, time[inside], *places, (share >= FLAT[0]) & (share <= FLAT[1]))
    return found


def stances(time: np.ndarray, force: np.ndarray) -> list[tuple[float, float]]:
    """Begin and end of each time on the plate [s], the short ones left out."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], force >= LOADED, [False]]).astype(int)))
    spans = [(float(time[i]), float(time[j - 1])) for i, j in edges.reshape(-1, 2)]
    return [(begin, end) for begin, end in spans if end - begin >= SHORTEST]


def pose(step: Step, standing: Standing) -> pd.DataFrame:
    """Inputs of the foot on spheres: frame on the sole under the heel marker, at height 0 where the foot is flat."""
    way = step.front - step.heel
    pitch = np.arctan2(way[:, 1], way[:, 0]) - standing.rise
    x = step.heel[:, 0] + standing.height * np.sin(pitch)
    y = step.heel[:, 1] - standing.height * np.cos(pitch)
    return pd.DataFrame({"time [s]": step.time, "x [m]": x, "y [m]": y, "pitch [rad]": pitch})


def belt_speed(steps: list[Step]) -> float:
    """At which standing heels run backwards [m/s]."""
    slopes = [np.polyfit(step.time[step.flat], step.heel[step.flat, 0], 1)[0] for step in steps]
    return -float(np.median(slopes))


def spheres(length: float, sink: float) -> pd.DataFrame:
    """A level row of spheres; [m]."""
    px = np.linspace(0.0, length, SPHERES)
    zone = [ZONES[k * len(ZONES) // SPHERES] for k in range(SPHERES)]
    table = {"px [m]": px, "py [m]": RADIUS - sink, "radius [m]": RADIUS, "zone": zone}
    return pd.DataFrame(table)


def write_case(
    data: Path,
    folder: Path,
    walk: Walk,
    placement: Placement = Placement(),
    calibration: tuple[str, ...] = (),
) -> dict[str, object]:
    """A gap case in `folder`, made by `geocontact gap gather`; what was found on the way to it."""
    home = data / HOME
    time, points = markers(home / walk.markers)
    steps = steps_of(walk, placement.front, time, points, read_force_plates(home / walk.plates))
    trials = walk.calibration + walk.evaluation
    calibration = calibration or walk.calibration
    fitted = [steps[name] for name in calibration]
    standing = {foot: Standing.of([step for step in fitted if step.foot == foot]) for foot in walk.feet}
    belt = belt_speed(fitted) if walk.belt else 0.0
    length = float(np.mean([each.length for each in standing.values()]))
    work = folder.parents[1] / "sources" / folder.name
    work.mkdir(parents=True)
    spheres(length, placement.sink).to_csv(work / "spheres.csv", index=False)
    for name in trials:
        pose(steps[name], standing[steps[name].foot]).to_csv(work / f"{name}.csv", index=False, float_format="%.9g")
    sources = {name: (home / walk.plates, walk.feet[steps[name].foot].plate, belt) for name in trials}
    evaluation = [name for name in trials if name not in calibration]
    text = settings(list(calibration), evaluation, placement.threshold_speed, sources)
    (work / "gather.toml").write_text(text, encoding="utf-8")
    geocontact("gap", "gather", work / "gather.toml", "--out", folder)
    return {
        "length_m": length,
        "belt_m_per_s": belt,
        "standing": {foot: vars(each) for foot, each in standing.items()},
        "duration_s": {name: float(np.ptp(steps[name].time)) for name in trials},
        "samples": {name: len(steps[name].time) for name in trials},
    }


def settings(
    calibration: list[str],
    evaluation: list[str],
    threshold_speed: float,
    sources: Mapping[str, tuple[Path, str, float]],
) -> str:
    """gather.toml."""
    parameters = [(f"k_{zone}", STIFFNESS) for zone in ZONES] + [(f"b_{zone}", DAMPING) for zone in ZONES]
    tables = [(f"parameters.{name}", numbers) for name, numbers in parameters]
    tables += [
        (f"from.{name}", {"inputs": f'"{name}.csv"', "plates": f'"{file}"', "plate": f'"{plate}"', "belt": f"{belt!r}"})
        for name, (file, plate, belt) in sources.items()
    ]
    constants = {"n": "1.2", "delta_full": "0.002", "mu_s": "0.9", "mu_k": "0.7", "v_th": f"{threshold_speed!r}"}
    lines = ["format = 1", 'system = "foot"', 'spheres = "spheres.csv"']
    lines += [f"calibration = {calibration}", f"evaluation = {evaluation}"]
    sections = (
        [f"[{name}]", *(f"{k} = {v}" for k, v in own.items())] for name, own in [("constants", constants), *tables]
    )
    return "\n".join([*lines, *chain.from_iterable(sections), ""]).replace("'", '"')
