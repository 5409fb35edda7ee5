"""The samples of the start page: one call of each analysis on synthetic files that come with the package.

`{m}` is the folder of the shipped samples, `{f}` that of `sample_files`, `{elbow simulate}` the results of that
sample, which is run before. All of it is synthetic.
"""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

from geocontact.app.sample_files import write_files
from geocontact.cli.demo import sample_folder

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
