"""The samples of the start page: one call of each analysis on synthetic files that come with the package.

`{m}` is the folder of the shipped samples, `{f}` that of the files below, `{elbow simulate}` the results of that
sample, which is run before. All of it is synthetic.
"""

from __future__ import annotations

import math
import re
import shlex
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from geocontact.cli.demo import sample_folder

Columns = Mapping[str, Sequence[float]]
KNEE = "{m}/femoral_component_right_coarse.stl {m}/tibial_insert_right_coarse.stl --unit mm"
THIGH = "{m}/mat_thigh_16x8/frames.csv --layout {m}/mat_thigh_16x8/layout.toml --surface {m}/thigh.stl --unit mm"
STANCE = "{m}/gait_P1_medium_1/walking.trc --static {m}/gait_P1_medium_1/standing.trc --mass 77.3"
PLATES = "--plates {m}/gait_P1_medium_1/plates.mot --plate own_force"
AMPUTEE = "--static {m}/amputee_P1/standing.trc --functional {m}/amputee_P1/functional.trc --mass 77.3 --height 1.81"
STEPS = "--plates {m}/amputee_P1/plates.mot --plate own_force --other-plate other_force"
OVERHEAD = "{m}/overhead_P1T1S100/markers.trc --upright 0:0.5 --side right"
STANDING = "{m}/standing_up_held_out/study.toml --parameters {m}/standing_up_exoskeleton/truth.csv"
AGAINST = "--against {m}/standing_up_exoskeleton/study.toml"
RISE = "{m}/standing_up_exoskeleton/T1_coordinates.sto --plates {m}/standing_up_exoskeleton/T1_plates.mot"

SAMPLES = {
    "area": f"{KNEE} --motion {{f}}/gait_11.csv --threshold 4 --split z --side right",
    "pairs": "{f}/knee_pairs.toml --rule clip",
    "settle-pairs": "{f}/resting_knee.toml",
    "cohort": "{f}/study.toml --workers 1",
    "cop": "{f}/sole.csv --motion {f}/foot.csv",
    "elbow simulate": "--seconds 20 --rate 50 --noise 0.2 --trials 4 --seed 3 --case",
    "elbow fit": "{elbow simulate}/locked_1.csv {elbow simulate}/locked_2.csv {elbow simulate}/locked_3.csv"
    " --known l=169,z=127 --bootstrap 0",
    "elbow compare": "{elbow simulate}/locked_4.csv --fit {elbow fit}/elbow.json",
    "elbow design": "--k 222.43 --l-mm 169 --z-mm 127 --range 0:120deg --limit 5 --offset-mm 48,59 --stroke-mm 0:60",
    "elbow population": "{f}/people.toml --range 0:120deg --limit 10 --samples 2000 --seed 1",
    "fit": "{m}/cup_r24.stl --shape sphere --unit mm",
    "gap diagnose": "{elbow simulate}/case",
    "gap discriminability": "{elbow simulate}/case --effects damping,time_shift,sensor_gain",
    "gap gather": "{f}/plan.toml",
    "gap init": "--simulator {f}/strut.py --data {f}/trials --number k=60 --number neutral=0.05",
    "gap inject": "{elbow simulate}/case --effect stiffening --size 2",
    "gap benchmark": "--system elbow --cases 1 --kinds single --seed 7 --again 0 --jobs 1",
    "id": "{m}/leg_swing.mot --model {m}/leg.osim",
    "ik": "{markers}/markers.trc --model {m}/leg.osim",
    "joint": "{markers}/markers.trc --axis --first femur_r0,femur_r1,femur_r2 --second tibia_r0,tibia_r1,tibia_r2",
    "knee settle": f"{KNEE} --motion {{f}}/gait_11.csv --side right --load 2000 --modulus 463MPa --poisson 0.46"
    ' --region "ny>0.25" --free adduction,rotation --springs rotation=0.36',
    "loadcells": "{f}/tray.csv --unit N",
    "markers": "{m}/leg_swing.mot --model {m}/leg.osim",
    "mat": f"{THIGH} --landmarks {{m}}/mat_thigh_16x8/landmarks.csv --cutoff 0",
    "modulus": "--area {f}/step_area.csv --force {f}/step_force.csv --radius-mm 37 --bootstrap 0",
    "prosthesis calibrate": f"{STANCE} {PLATES} --starts 0",
    "prosthesis compare": "{f}/walks.toml --workers 1",
    "prosthesis design": f"{STANCE} {PLATES} --feet 6 --walks 2",
    "prosthesis keel": "{m}/foot_bench/foot.toml",
    "prosthesis scale": "{m}/amputee_P1/standing.trc --functional {m}/amputee_P1/functional.trc --mass 77.3"
    " --height 1.81",
    "prosthesis simulate": f"{STANCE} {PLATES} --other-plate other_force",
    "prosthesis walk": f"{{m}}/amputee_P1/walking.trc {AMPUTEE} {STEPS}",
    "scale": "{markers}/markers.trc --model {m}/leg.osim --mass 30 --time 0:0.02"
    " --scale femur_r=femur_r0/femur_r2 --scale tibia_r=tibia_r0/tibia_r2",
    "shoulder simulate": f"{OVERHEAD} --tool {{m}}/overhead_P1T1S100/tool.csv",
    "shoulder compare": "{shoulder simulate}/right.csv {shoulder simulate}/plane/right_simulated.csv"
    " --map elevation=exo",
    "shoulder study": "{f}/overhead.toml",
    "shoulder optimise": "",
    "sit-to-stand calibrate": "{m}/standing_up/study.toml --nodes 25 --resamples 0",
    "sit-to-stand predict": f"{STANDING} {AGAINST} --nodes 30",
    "sit-to-stand design": f"{STANDING} --nodes 12 --front 1",
    "sit-to-stand compare": f"{STANDING} {AGAINST} --nodes 30",
    "sit-to-stand coordinates": "{m}/whole_body/ik.mot --model {m}/whole_body/body.osim --plates"
    " {m}/whole_body/plates.mot --feet right_force,left_force --chair chair_force",
    "sit-to-stand movements": f"{RISE} --chair chair_force --feet feet_force",
    "sit-to-stand device": "{m}/standing_up_exoskeleton/unloaded_coordinates.sto"
    " --motors {m}/standing_up_exoskeleton/unloaded_motors.sto",
}
"""Words of a call of each analysis, without the folder of its results."""

START = {
    "two surfaces and a motion": ("area", "pairs", "knee settle", "settle-pairs", "fit"),
    "markers and force plates": ("scale", "ik", "id", "joint", "markers", "cop"),
    "a pressure mat": ("mat",),
    "load cells, or areas and forces": ("loadcells", "modulus"),
    "an exoskeleton at the elbow": ("elbow simulate", "elbow fit", "elbow compare", "elbow design", "elbow population"),
    "an exoskeleton at the shoulder": (
        "shoulder simulate",
        "shoulder compare",
        "shoulder study",
        "shoulder optimise",
    ),
    "somebody who stands up, with a device or without": (
        "sit-to-stand coordinates",
        "sit-to-stand movements",
        "sit-to-stand calibrate",
        "sit-to-stand predict",
        "sit-to-stand compare",
        "sit-to-stand design",
        "sit-to-stand device",
    ),
    "a prosthesis": (
        "prosthesis scale",
        "prosthesis simulate",
        "prosthesis walk",
        "prosthesis calibrate",
        "prosthesis compare",
        "prosthesis design",
        "prosthesis keel",
    ),
    "a simulation that misses the measurement": (
        "gap init",
        "gap gather",
        "gap diagnose",
        "gap discriminability",
        "gap inject",
        "gap benchmark",
    ),
    "many subjects and trials": ("cohort",),
}
"""What somebody has, and the analyses for it."""


@dataclass(frozen=True)
class Sample:
    """A call that can be run.

    Parameters
    ----------
    command
        Its analysis.
    words
        All words but the folder of the results; files as paths.
    before
        Analyses whose samples are run before, in this order; their results lie in `results_of`.
    """

    command: str
    words: tuple[str, ...]
    before: tuple[str, ...]


def sample(command: str, home: Path) -> Sample:
    """The sample of an analysis, whose own files are written below `home`."""
    text = SAMPLES[command]
    before = before_of(command)
    places = {"m": sample_folder(), "f": home / "sample-files"}
    places |= {each: results_of(each, home) for each in before}
    if "{f}" in text:
        write_files(places["f"])
    named = {name: f"{{{k}}}" for k, name in enumerate(places)}  # a name may have a blank
    for name, short in named.items():
        text = text.replace(f"{{{name}}}", short)
    words = [
        re.sub(r"\{(\d+)\}", lambda found: str(list(places.values())[int(found[1])]), w) for w in shlex.split(text)
    ]
    return Sample(command, (*command.split(), *words), before)


def before_of(command: str) -> tuple[str, ...]:
    """Analyses whose results a sample reads, the first ones first."""
    found: dict[str, None] = {}
    for each in re.findall(r"\{([^}]+)\}", SAMPLES[command]):
        if each in SAMPLES:
            found |= dict.fromkeys((*before_of(each), each))
    return tuple(found)


def results_of(command: str, home: Path) -> Path:
    """Folder for the results of a sample that others read."""
    return home / f"sample-{command.replace(' ', '-')}"


def write_files(folder: Path) -> None:
    """Files of samples that do not lie in the shipped folder; the same bytes each time."""
    for name, make in FILES.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(make(), encoding="utf-8")


def _table(columns: Columns) -> str:
    """A .csv with a header row and nine digits."""
    rows = zip(*columns.values(), strict=True)
    return "\n".join([",".join(columns), *(",".join(f"{value:.9g}" for value in row) for row in rows)]) + "\n"


def _gait(name: str) -> str:
    """Every tenth frame of a shipped gait cycle."""
    head, *rows = (sample_folder() / name).read_text("utf-8").splitlines()
    return "\n".join([head, *rows[::10]]) + "\n"


def _bodies(name: str) -> str:
    """A shipped description of bodies, with every tenth frame of their motions."""
    described = (sample_folder() / name).read_text("utf-8")
    described = re.sub(r'motion = "(\w+)\.csv"', r'motion = "\1_11.csv"', described)
    return described.replace('mesh = "', f'mesh = "{sample_folder().as_posix()}/')


def _study() -> str:
    meshes = sample_folder().as_posix()
    return f"""analysis = "area"
files = "gait_{{frames}}.csv"
[options]
moving = "{meshes}/femoral_component_right_coarse.stl"
fixed = "{meshes}/tibial_insert_right_coarse.stl"
unit = "mm"
motion = "{{file}}"
[sweep]
threshold = [2, 4]
"""


def _sole() -> str:
    """Fifteen spheres from heel to toe."""
    places = [0.22 * k / 14 for k in range(15)]
    rows = [f"{x:.6f},0.012,0.0,0.011,z{1 + k // 5}" for k, x in enumerate(places)]
    return "\n".join(["px [m],py [m],pz [m],radius [m],zone", *rows]) + "\n"


def _foot() -> str:
    """Heel strike, flat foot, heel rise in the sagittal plane, in 0.8 s; the sole sinks up to 4 mm."""
    columns: dict[str, list[float]] = {name: [] for name in ("time [s]", "tx [m]", "ty [m]", "tz [m]")}
    columns |= {name: [] for name in ("qw", "qx", "qy", "qz")}
    for k in range(81):
        phase = k / 80
        pitch = 0.25 - 0.7 * phase**2 + 0.06 * math.sin(3.0 * math.pi * phase)
        lowest = min(0.22 * i / 14 * math.sin(pitch) + 0.012 * math.cos(pitch) - 0.011 for i in range(15))
        height = -lowest - 0.004 * math.sin(math.pi * (0.05 + 0.9 * phase))
        row = (0.8 * phase, 0.02 * phase, height, 0.0, math.cos(pitch / 2), 0.0, 0.0, math.sin(pitch / 2))
        for name, value in zip(columns, row, strict=True):
            columns[name].append(value)
    return _table(columns)


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


def _trial(k: int) -> str:
    """A spring of 60 N m/rad that stiffens, moved by two sines."""
    time = [0.05 * i for i in range(60)]
    angle = [0.3 * math.sin(2.0 * math.pi * (0.5 + 0.2 * k) * t + k) + 0.1 * math.sin(7.0 * t) for t in time]
    turned = [each - 0.05 for each in angle]
    wobble = [0.2 * math.sin(977.0 * t + k) for t in time]
    torque = [60.0 * each * (1.0 + 0.3 * each**2) + more for each, more in zip(turned, wobble, strict=True)]
    return _table({"time [s]": time, "angle [rad]": angle, "torque [N m]": torque})


STRUT = """def run(time, inputs, numbers):
    turned = inputs[0] - numbers["neutral"]
    return numbers["k"] * turned
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
    meshes = sample_folder().as_posix()
    person = (
        f'[persons.P1]\nmass = {{ value = 77.3, unit = "kg" }}\nstatic = "{meshes}/gait_P1_medium_1/standing.trc"\n'
    )
    trial = """
[[trials]]
name = "P1_{setting}_1"
person = "P1"
setting = "{setting}"
markers = "{meshes}/gait_P1_{setting}_1/walking.trc"
plates = "{meshes}/gait_P1_{setting}_1/plates.mot"
plate = "own_force"
other_plate = "other_force"
"""
    return person + "".join(trial.format(setting=each, meshes=meshes) for each in ("low", "medium", "high"))


def _overhead() -> str:
    """A trial of overhead work with the device and without it."""
    folder = (sample_folder() / "overhead_P1T1S100").as_posix()
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
    columns: dict[str, list[float]] = {"time [s]": [], "x [m]": [], "y [m]": [], "pitch [rad]": []}
    for i in range(k, 81):
        phase = i / 80
        pitch = 0.25 - 0.7 * phase**2 + 0.06 * math.sin(3.0 * math.pi * phase)
        lowest = min(0.22 * j / 14 * math.sin(pitch) + 0.012 * math.cos(pitch) - 0.011 for j in range(15))
        height = -lowest - (0.004 + 0.0005 * k) * math.sin(math.pi * (0.05 + 0.9 * phase))
        for name, value in zip(columns, (0.8 * phase, 0.02 * phase, height, pitch), strict=True):
            columns[name].append(value)
    return _table(columns)


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


FILES: dict[str, Callable[[], str]] = {
    "gait_11.csv": lambda: _gait("gait.csv"),
    "gait_patella_11.csv": lambda: _gait("gait_patella.csv"),
    "knee_pairs.toml": lambda: _bodies("knee_pairs.toml"),
    "resting_knee.toml": lambda: _bodies("resting_knee.toml"),
    "study.toml": _study,
    "sole.csv": _sole,
    "foot.csv": _foot,
    "people.toml": lambda: PEOPLE,
    "strut.py": lambda: STRUT,
    "trials/t01.csv": lambda: _trial(0),
    "trials/t02.csv": lambda: _trial(1),
    "trials/t03.csv": lambda: _trial(2),
    "tray.csv": _tray,
    "step_area.csv": _step_area,
    "step_force.csv": _step_force,
    "walks.toml": _walks,
    "overhead.toml": _overhead,
    "plan.toml": _plan,
    "foot_1.csv": lambda: _steps(1),
    "foot_2.csv": lambda: _steps(2),
    "foot_3.csv": lambda: _steps(3),
    "plates.mot": _plates,
}
"""Files below `{f}`, and what writes each of them."""
