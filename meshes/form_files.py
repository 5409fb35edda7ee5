"""Small synthetic inputs of commands for which nothing else here fits: descriptions, a sole, plates, cells."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

Columns = Mapping[str, Sequence[float]]


def _table(columns: Columns) -> str:
    """A .csv with a header row and nine digits."""
    rows = zip(*columns.values(), strict=True)
    return "\n".join([",".join(columns), *(",".join(f"{value:.9g}" for value in row) for row in rows)]) + "\n"


def _sole() -> str:
    """Fifteen spheres from heel to toe."""
    places = [0.22 * k / 14 for k in range(15)]
    rows = [f"{x:.6f},0.012,0.0,0.011,z{1 + k // 5}" for k, x in enumerate(places)]
    return "\n".join(["px [m],py [m],pz [m],radius [m],zone", *rows]) + "\n"


def _stance(phase: float, depth: float) -> tuple[float, float]:
    """Pitch [rad] and height [m] of a foot from heel strike to heel rise; the sole sinks up to `depth` [m]."""
    pitch = 0.25 - 0.7 * phase**2 + 0.06 * math.sin(3.0 * math.pi * phase)
    lowest = min(0.22 * k / 14 * math.sin(pitch) + 0.012 * math.cos(pitch) - 0.011 for k in range(15))
    return pitch, -lowest - depth * math.sin(math.pi * (0.05 + 0.9 * phase))


def _foot() -> str:
    """A stance of 0.8 s in the sagittal plane, as poses."""
    rows = []
    for phase in (k / 80 for k in range(81)):
        pitch, height = _stance(phase, 0.004)
        place = (0.8 * phase, 0.02 * phase, height, 0.0)
        rows.append((*place, math.cos(pitch / 2), 0.0, 0.0, math.sin(pitch / 2)))
    names = ("time [s]", "tx [m]", "ty [m]", "tz [m]", "qw", "qx", "qy", "qz")
    return _table(dict(zip(names, zip(*rows, strict=True), strict=True)))


def _tray() -> str:
    """Four load cells [N] over four strides of 1.1 s, loaded for 60 % of each."""
    time = [0.01 * k for k in range(500)]
    phase = [((each - 0.2) / 1.1) % 1.0 for each in time]
    wave = [math.sin(math.pi * each / 0.6) if each < 0.6 else 0.0 for each in phase]
    cells = {"PM": (500.0, 3), "AM": (400.0, 1), "AL": (150.0, 1), "PL": (200.0, 3)}
    loads = {name: [20.0 + size * each**power for each in wave] for name, (size, power) in cells.items()}
    return _table({"time [s]": time, **loads})


LEVELS = (1.0, 2.0, 3.0, 4.0, 5.0)
"""Thresholds of the areas of a step [mm]."""


def _step() -> tuple[list[float], list[list[float]], list[float]]:
    """Times [s], areas at each threshold [mm^2] and the force of a law with E* = 6.8 MPa and R = 37 mm [N]."""
    time = [1.1 * k / 44 for k in range(45)]
    areas, forces = [], []
    for each in time:
        phase = math.pi * each / 1.1
        base = 600.0 + 500.0 * math.sin(phase) ** 2 + 150.0 * math.sin(3.0 * phase)
        areas.append([base + 250.0 * level + 30.0 * math.sin(phase) * level for level in LEVELS])
        law = 4.0 / 3.0 * 6.8e6 * (1e-6 * areas[-1][3] / math.pi) ** 1.5 / 0.037
        forces.append(law + 20.0 * math.sin(40.0 * each))
    return time, areas, forces


def _step_area() -> str:
    time, areas, _ = _step()
    flat = [area for row in areas for area in row]
    columns = {"time [s]": [each for each in time for _ in LEVELS], "threshold [mm]": list(LEVELS) * len(time)}
    return _table({**columns, "area_fixed [mm^2]": flat})


def _step_force() -> str:
    time, _, forces = _step()
    return _table({"time [s]": time, "total [N]": forces})


STUDY = """analysis = "area"
files = "gait_{frames}.csv"
[options]
moving = "../femoral_component_right_coarse.stl"
fixed = "../tibial_insert_right_coarse.stl"
unit = "mm"
motion = "{file}"
[sweep]
threshold = [2, 4]
"""
PEOPLE = """[k]
unit = "N/m"
normal = { mean = 222, sd = 40, lower = 50 }
[l]
unit = "mm"
uniform = { lower = 160, upper = 210 }
[z]
unit = "mm"
uniform = { lower = 60, upper = 130 }
[x]
unit = "mm"
normal = { mean = 0, sd = 15 }
[y]
unit = "mm"
normal = { mean = 0, sd = 20 }
"""


def _walks() -> str:
    """A person on three settings of a prosthetic foot."""
    person = '[persons.P1]\nmass = { value = 77.3, unit = "kg" }\nstatic = "../gait_P1_medium_1/standing.trc"\n'
    trial = """
[[trials]]
name = "P1_{setting}_1"
person = "P1"
setting = "{setting}"
markers = "../gait_P1_{setting}_1/walking.trc"
plates = "../gait_P1_{setting}_1/plates.mot"
plate = "own_force"
other_plate = "other_force"
"""
    return person + "".join(trial.format(setting=each) for each in ("low", "medium", "high"))


def _overhead() -> str:
    """A trial of overhead work with the device and without it."""
    folder = "../overhead_P1T1S100"
    files = f'person = "P1"\ntask = "T1"\nmarkers = "{folder}/markers.trc"\ntool = "{folder}/tool.csv"\n'
    person = '[persons.P1]\nmass = { value = 82, unit = "kg" }\nsex = "male"\ndominant = "right"\n'
    person += 'upper_arm = { value = 296, unit = "mm" }\n'
    task = '[tasks.T1]\ntool = { value = 1.3, unit = "kg" }\npush = { value = 35, unit = "N" }\n'
    trials = (
        f'[[trials]]\nname = "bare"\n{files}[[trials]]\nname = "supported"\n{files}level = "50%"\nwithout = "bare"\n'
    )
    return task + person + trials


def _plan() -> str:
    """A case of a foot on two plates, from a motion and reactions."""
    trials = "\n".join(
        f'[from.t0{k}]\ninputs = "foot_{k}.csv"\nplates = "plates.mot"\nplate = "ground_force_r"' for k in (1, 2, 3)
    )
    free = "".join(
        f'[parameters.k_z{i}]\nstart = 8e4\nlower = 8e3\nupper = 1e6\nunit = "N/m^n"\n'
        f'[parameters.b_z{i}]\nstart = 100.0\nlower = 0.0\nupper = 3000.0\nunit = "N s/m"\n'
        for i in (1, 2, 3)
    )
    head = 'format = 1\nsystem = "foot"\ncalibration = ["t01", "t02"]\nevaluation = ["t03"]\nspheres = "sole.csv"\n'
    numbers = "[constants]\nn = 1.2\ndelta_full = 0.002\nmu_s = 0.9\nmu_k = 0.7\nv_th = 0.25\n"
    return f"{head}{numbers}{free}{trials}\n"


def _steps(k: int) -> str:
    """x, y [m] and pitch [rad] of a foot that sinks a little deeper in each trial, which begins a sample later."""
    phases = [i / 80 for i in range(k, 81)]
    pitch, height = zip(*(_stance(phase, 0.004 + 0.0005 * k) for phase in phases), strict=True)
    columns = {"time [s]": [0.8 * phase for phase in phases], "x [m]": [0.02 * phase for phase in phases]}
    return _table({**columns, "y [m]": height, "pitch [rad]": pitch})


def _plates() -> str:
    """Reactions of two plates [N, m, N m] over 0.8 s, a table of OpenSim."""
    names = [("force", f"{part}{axis}") for part in "vp" for axis in "xyz"]
    names += [("torque", axis) for axis in "xyz"]
    heads = [f"ground_{kind}_{side}_{name}" for side in "rl" for kind, name in names]
    rows = []
    for i in range(81):
        phase = i / 80
        force = (30.0 * math.cos(math.pi * phase), 700.0 * math.sin(math.pi * phase), 5.0 * math.sin(math.pi * phase))
        side = (*force, 0.02 + 0.2 * phase, 0.0, 0.01, 0.0, 0.0, 0.0)
        rows.append("\t".join(f"{value:.9g}" for value in (0.8 * phase, *side, *side)))
    head = f"plates\nversion=1\nnRows=81\nnColumns={1 + len(heads)}\ninDegrees=no\nendheader\n"
    return head + "\n".join(["\t".join(["time", *heads]), *rows]) + "\n"


def form_files(gait: str) -> dict[str, bytes]:
    """Files of the folder `forms`; `gait` is the table of the gait cycle, of which every tenth frame is taken."""
    head, *rows = gait.splitlines()
    texts = {
        "gait_11.csv": "\n".join([head, *rows[::10]]) + "\n",
        "study.toml": STUDY,
        "sole.csv": _sole(),
        "foot.csv": _foot(),
        "people.toml": PEOPLE,
        "tray.csv": _tray(),
        "step_area.csv": _step_area(),
        "step_force.csv": _step_force(),
        "walks.toml": _walks(),
        "overhead.toml": _overhead(),
        "plan.toml": _plan(),
        **{f"foot_{k}.csv": _steps(k) for k in (1, 2, 3)},
        "plates.mot": _plates(),
    }
    return {f"forms/{name}": text.encode("ascii") for name, text in texts.items()}
