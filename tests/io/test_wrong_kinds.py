"""Every key of every description in TOML with a value of another kind: refused in one line that names the key."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from contextlib import chdir
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any

import pytest

from geocontact.analyses.catalogue import ENTRIES, job_named
from geocontact.analyses.frame.options import declared
from geocontact.analyses.misalignment.population.drawn import UNITS as OFFSETS
from geocontact.analyses.shoulder.devices import CONTROLLER_UNITS, HINGE_UNITS
from geocontact.analyses.shoulder.devices import UNITS as DEVICE_UNITS
from geocontact.data.errors import InputError
from geocontact.data.parameter import SOURCES
from geocontact.io.cases.case_settings import read_settings
from geocontact.io.cases.gathering import read_gathering
from geocontact.io.mats.layout import read_layout
from geocontact.io.recordings.contact_pairs import read_pairs
from geocontact.io.recordings.exoskeleton_description import read_exoskeleton
from geocontact.io.recordings.foot_description import read_foot_description
from geocontact.io.recordings.gait_study import read_gait_study
from geocontact.io.recordings.load_cells import read_regression
from geocontact.io.recordings.overhead_study import read_overhead_study
from geocontact.io.recordings.population import read_population
from geocontact.io.recordings.shoulder_device import read_device_file, read_person_file
from geocontact.io.recordings.socket_description import read_socket
from geocontact.io.recordings.spheres import read_law
from geocontact.io.recordings.standing_study import read_standing_study
from geocontact.study.address import as_typed, options_of
from geocontact.study.description import read_study_file
from geocontact.study.steps import runs_of

Place = tuple[str | int, ...]


def cohort(path: Path) -> None:
    """Trials of a study and their options, as they are read before any is evaluated."""
    study = read_study_file(path)
    for one in runs_of(study):
        with chdir(study.home):
            options_of(job_named(one.analysis).options, one.trial.options)


CASE = """format = 1
system = "elbow"
calibration = ["t01"]
evaluation = ["t02"]
spheres = "spheres.csv"
noise = { force = 0.5 }
constants = { l = 0.2 }
trial = { t01 = { level = 0.5, where = "left" } }
[parameters.k]
start = 300.0
lower = 100.0
upper = 900.0
unit = "N/m"
fixed = false
"""


@dataclass(frozen=True)
class Description:
    """One kind of description.

    Parameters
    ----------
    read
        Its reader.
    text
        With every key that it can have.
    takes
        Kinds that a key may also have, by a pattern of its place: a number as a name, one file or a list of them.
    """

    read: Callable[[Path], Any]
    text: str
    takes: Mapping[str, tuple[str, ...]]


WORD = ("number",)
FREE = ("number", "text", "bool")
SITES = ("text",)
DESCRIPTIONS: dict[str, Description] = {
    "study": Description(
        cohort,
        """analysis = "area"
title = "Knees"
files = "{subject}_{condition}.csv"
table = "people.csv"
trials = [{ subject = "P1", walk = 3, options = { split = "z", side = "left" } }, { subject = "P2", walk = 4 }]
leave_out = [{ subject = "P2", condition = "fast" }]
per = ["subject", "condition", "threshold"]
where = { condition = ["slow"] }
needs = ["a.stl"]
pages = false
figures = false
steps.ik.analysis = "ik"
steps.ik.per = ["subject"]
steps.ik.where = { condition = ["slow"] }
steps.ik.needs = ["a.osim"]
steps.ik.options = { markers = "a.csv", model = "a.osim" }
steps.ik.limits = { time = { value = 60, unit = "s" }, memory = "1GB", cores = 2 }
[options]
moving = "a.stl"
fixed = "a.stl"
unit = "mm"
motion = "{file}"
save_map = true
[vary]
condition = ["slow", "fast"]
[sweep]
threshold = [1, 4]
[summary]
table = "area"
columns = ["area_fixed [mm^2]"]
over = "time [s]"
where = { "threshold [mm]" = 4 }
subject = "subject"
condition = "condition"
[surface]
particles = "a.particles"
unit = "mm"
body = "fixed"
at = [0, 50, 100]
[limits]
time = { value = 600, unit = "s" }
memory = "4GB"
cores = 1
[cluster]
jobs = 10
cores = 4
memory = "32GB"
walltime = "04:00:00"
queue = "short"
account = "knees"
""",
        {
            r"trials \d+ (subject|walk)": FREE,
            r"leave_out \d+ \w+": FREE,
            r"(vary|sweep) \w+ \d+": FREE,
            r"(steps ik )?where \w+ \d+": FREE,
            "summary where .*": FREE,
            "cluster (queue|account)": ("number",),
            r"(options|trials \d+ options|steps ik options) \w+": (*FREE, "list", "table", "date"),
            r"options motion": (*FREE, "list"),
        },
    ),
    "population": Description(
        lambda path: read_population(path, OFFSETS),
        """[k]
unit = "N/m"
value = 200
[l]
unit = "mm"
normal = { mean = 180, sd = 10, lower = 100, upper = 250 }
[z]
unit = "mm"
uniform = { lower = 80, upper = 120 }
[x]
table = "offsets.csv"
[y]
unit = "mm"
normal = { mean = 0, sd = 5 }
[correlation]
l_y = 0.4
""",
        {},
    ),
    "gathering": Description(
        read_gathering,
        CASE
        + """[columns]
"angle [deg]" = "knee_angle_r"
[from.t01]
inputs = "t01.mot"
outputs = "t01.sto"
plates = "grf.mot"
plate = "right"
belt = 1.1
areas = "area.csv"
threshold = 0.004
forces = "forces.csv"
force_unit = "lbf"
thigh = "t01_thigh"
[from.t02]
inputs = "t02.csv"
thigh = "t02_thigh"
""",
        {r"trial t01 \w+": ("number", "text"), r"from \w+ plate": WORD, "spheres": ()},
    ),
    "standing": Description(
        read_standing_study,
        """height = { value = 1.75, unit = "m" }
exoskeleton = true
device = "a.csv"
free = ["a"]
tracks = ["b"]
[person]
mass = { value = 70, unit = "kg", source = "scale", note = "with shoes" }
sex = "female"
age = { value = 9, unit = "years" }
foot = { gyration = { value = 5, unit = "cm" } }
segments.shank = { centre = { value = 5, unit = "cm" } }
[masses]
shank = { value = 3, unit = "kg" }
[straps]
damping = 10.0
[weights]
torques = 1e-6
[noise]
shear = { value = 1, unit = "N" }
angle = { value = 0.3, unit = "deg" }
[[trials]]
name = "T1"
coordinates = "a.csv"
rates = "a.csv"
plates = "a.csv"
torques = "a.csv"
motors = "a.csv"
mode = "passive"
task = "sitting down"
strap = ["a.csv", "a.csv"]
strap_shank = "a.csv"
strap_pelvis = "a.csv"
feet = "feet"
chair = 2
sitting = true
start = { value = 0.5, unit = "s" }
end = 2.5
[[trials]]
name = "T2"
coordinates = "a.csv"
movement = 2
""",
        {
            r"(straps damping|weights torques)": ("number", "table"),
            r"trials \d+ (name|feet|chair)": ("number", "text"),
            r"trials \d+ strap\w*": ("list", "text"),
            r"trials \d+ (start|end)": ("number", "table"),
            ".* (source|note)": ("number", "bool", "list", "table", "date"),
        },
    ),
    "socket": Description(
        read_socket,
        """turn_stiffness = { value = 10, unit = "N m/deg" }
turn_damping = { value = 5, unit = "N m s/deg" }
shift_stiffness = { value = 20, unit = "N/mm" }
shift_damping = { value = 10, unit = "N s/mm" }
piston_stiffness = { value = 35, unit = "N/mm" }
piston_damping = { value = 10, unit = "N s/mm" }
""",
        {".* (source|note)": ("number", "bool", "list", "table", "date")},
    ),
    "foot": Description(
        read_foot_description,
        """name = "bench"
[keel]
length = { value = 240, unit = "mm", source = "paper", note = "table 1" }
posterior = { value = 66, unit = "mm" }
joints = 8
lowest = { value = 66, unit = "mm" }
highest = { value = 170, unit = "mm" }
width = { value = 58, unit = "mm" }
density = { value = 1600, unit = "kg/m^3" }
thickness = { value = 7, unit = "mm" }
bending = { value = 28, unit = "N m^2" }
modulus = { value = 20, unit = "GPa" }
shear_modulus = { value = 7, unit = "GPa" }
torsional = { value = 30, unit = "N m^2" }
twists = true
retardation = { value = 0.002, unit = "s" }
support = "pinned"
[[keel.sections]]
to = { value = 100, unit = "mm" }
bending = { value = 28, unit = "N m^2" }
[[keel.sections]]
to = { value = 240, unit = "mm" }
thickness = { value = 7, unit = "mm" }
width = { value = 50, unit = "mm" }
[settings]
soft = { value = 70, unit = "mm" }
[sole]
spheres = "a.csv"
source = "invented"
below = { value = 28, unit = "mm" }
exponent = { value = 1, unit = "-" }
full_depth = { value = 2, unit = "mm" }
threshold_speed = { value = 0.01, unit = "m/s" }
[sole.zones.heel]
stiffness = { value = 22, unit = "N/mm" }
damping = { value = 300, unit = "N s/m" }
static = { value = 0.8, unit = "-" }
kinetic = { value = 0.7, unit = "-" }
[actuator]
speed = { value = 200, unit = "mm/s" }
[bench]
at = { value = 235, unit = "mm" }
noise = { value = 0.03, unit = "mm" }
series = { value = 120, unit = "N/mm" }
tilt = { value = 20, unit = "deg" }
travel = { value = 5, unit = "mm" }
[[compressions]]
name = "A"
setting = "soft"
sought = true
curve = "a.csv"
[[compressions]]
fulcrum = { value = 100, unit = "mm" }
stiffness = { value = 12, unit = "N/mm" }
sd = { value = 0.3, unit = "N/mm" }
""",
        {
            "name": WORD,
            r"compressions \d+ (name|setting)": ("number", "text"),
            "keel joints": ("number", "table"),
            "keel sections": ("list",),
            ".* (source|note)": ("number", "bool", "list", "table", "date"),
        },
    ),
    "foot on foam": Description(
        read_foot_description,
        """[keel]
length = { value = 240, unit = "mm" }
posterior = { value = 66, unit = "mm" }
lowest = { value = 66, unit = "mm" }
highest = { value = 170, unit = "mm" }
width = { value = 58, unit = "mm" }
density = { value = 1600, unit = "kg/m^3" }
[foam]
below = { value = 28, unit = "mm" }
breadth = { value = 58, unit = "mm" }
column = { value = 4, unit = "mm" }
across = 2
exponent = { value = 1, unit = "-" }
full_depth = { value = 2, unit = "mm" }
threshold_speed = { value = 0.01, unit = "m/s" }
[foam.zones.heel]
to = { value = 240, unit = "mm" }
thickness = { value = 20, unit = "mm", source = "paper", note = "table 1" }
modulus = { value = 0.5, unit = "MPa" }
retardation = { value = 10, unit = "ms" }
static = { value = 0.8, unit = "-" }
kinetic = { value = 0.7, unit = "-" }
""",
        {
            "foam across": ("number", "table"),
            ".* (source|note)": ("number", "bool", "list", "table", "date"),
        },
    ),
    "pairs": Description(
        read_pairs,
        """unit = "mm"
merge_tolerance = { value = 0.001, unit = "mm" }
model = "a.osim"
coordinates = "a.csv"
angles = "deg"
order = "XYZ"
rate = { value = 100, unit = "Hz" }
[[bodies]]
name = "femur"
mesh = "a.stl"
motion = "a.csv"
unit = "cm"
place = "a.csv"
closed = true
[[bodies]]
name = "insert"
mesh = "a.stl"
segment = "tibia_r"
[[bodies]]
name = "shank"
mesh = "a.stl"
[[pairs]]
name = "medial"
moving = "femur"
fixed = "insert"
region = "z < 0"
region_moving = "ny < 0"
[pairs.layer]
modulus = { value = 500, unit = "MPa" }
poisson = 0.46
thickness = { value = 8, unit = "mm" }
piece = { value = 1, unit = "mm" }
foundation = "logarithmic"
[[free]]
body = "femur"
axes = "shank"
settles = ["tx", "ty", "tz", "rx", "ry", "rz"]
fx = { value = 10, unit = "N" }
fy = { value = -2, unit = "kN" }
fz = { value = 20, unit = "N" }
px = { value = 1, unit = "mm" }
py = { value = 2, unit = "mm" }
pz = { value = 3, unit = "mm" }
[free.springs]
tx = { value = 30, unit = "N/mm" }
ty = { value = 30, unit = "N/mm" }
tz = { value = 30, unit = "N/mm" }
rx = { value = 0.4, unit = "N m/deg" }
ry = { value = 0.4, unit = "N m/deg" }
rz = { value = 0.4, unit = "N m/deg" }
[[free]]
body = "insert"
settles = ["ty"]
forces = "a.csv"
""",
        {
            r"(bodies|pairs) \d+ name": ("number", "text"),
            r"bodies \d+ (place|segment)": ("number", "text"),
            r"pairs \d+ (moving|fixed)": ("number", "text"),
            r"free \d+ (body|axes)": ("number", "text"),
            r"pairs \d+ region(_moving)?": ("text",),
            "order": ("number", "text"),
            ".* (source|note)": ("number", "bool", "list", "table", "date"),
        },
    ),
    "gait": Description(
        read_gait_study,
        """[persons.P1]
mass = { value = 77.3, unit = "kg" }
static = "a.csv"
side = "right"
sex = "male"
age = { value = 9, unit = "years" }
height = { value = 1.36, unit = "m" }
segments.thigh = { mass = { value = 3, unit = "kg" }, length = { value = 32, unit = "cm" } }
segments.shank = { centre = { value = 13, unit = "cm" }, gyration = { value = 9, unit = "cm" } }
residual = { value = 45, unit = "%" }
residual_length = { value = 150, unit = "mm" }
residual_markers = "RKNE,RSO3"
socket = "a.csv"
foot = "a.csv"
functional = "a.csv"
law = "a.csv"
[[trials]]
name = "T1"
person = "P1"
setting = "medium"
markers = "a.csv"
plates = "a.csv"
plate = "own"
other_plate = 2
calibrated = true
law = "a.csv"
ground = "plane:0,1,0,0"
[[trials]]
person = "P1"
fulcrum = { value = 100, unit = "mm" }
markers = "a.csv"
plates = "a.csv"
plate = "own"
other_plate = 2
""",
        {
            r"trials \d+ (name|plate|other_plate|ground|setting)": ("number", "text"),
            r"persons \w+ residual_markers": ("number", "text"),
        },
    ),
    "overhead": Description(
        read_overhead_study,
        """[tasks.T1]
tool = { value = 1.3, unit = "kg" }
push = { value = 35, unit = "N" }
push_direction = [0, 0.5, 1.0]
dominant_share = 0.5
[persons.P1]
mass = { value = 82, unit = "kg" }
sex = "male"
age = { value = 9, unit = "years" }
height = { value = 1.36, unit = "m" }
segments.upper_arm = { mass = { value = 0.9, unit = "kg" }, length = { value = 30, unit = "cm" } }
segments.head = { centre = { value = 13, unit = "cm" }, gyration = { value = 9, unit = "cm" } }
dominant = "right"
upper_arm = { value = 296, unit = "mm" }
shoulder_width = { value = 390, unit = "mm" }
torso = { value = 500, unit = "mm" }
[[trials]]
name = "A"
person = "P1"
task = "T1"
markers = "a.csv"
tool = "a.csv"
upright = [0.0, 0.5]
[[trials]]
person = "P1"
task = "T1"
markers = "a.csv"
tool = "a.csv"
level = "100%"
recorded = "a.csv"
recorded_other = "a.csv"
without = "A"
""",
        {r"trials \d+ (name|level)": ("number", "text")},
    ),
    "device": Description(
        lambda path: read_device_file(path, DEVICE_UNITS, CONTROLLER_UNITS, SOURCES, HINGE_UNITS),
        """name = "wide"
based_on = "lucy"
[numbers]
cuff_length = { value = 160, unit = "mm", source = "invented", note = "longer" }
[hinges]
rod_y = { value = -20, unit = "mm", source = "invented", note = "drawing" }
[controller]
delay = { value = 0.05, unit = "s", source = "invented", note = "slow" }
""",
        {"name|based_on": WORD, "(numbers|hinges|controller) .* note": ("number", "bool", "list", "table", "date")},
    ),
    "exoskeleton": Description(
        lambda path: read_exoskeleton(path, SOURCES, {"exo_hip Coulomb friction": "N m"}),
        """name = "prototype"
[numbers]
module_mass = { value = 5.2, unit = "kg", source = "derived", note = "weighed" }
[identified]
shank_length = { value = 452, unit = "mm" }
thigh_length = { value = 0.41, unit = "m" }
by_itself = ["exo_hip Coulomb friction"]
[identified.parameters]
"exo_hip Coulomb friction" = { value = 2, unit = "N m" }
""",
        {"name": WORD, "numbers .* note": ("number", "bool", "list", "table", "date")},
    ),
    "person": Description(
        lambda path: read_person_file(path, ("upper_arm", "torso")), 'upper_arm = { value = 310, unit = "mm" }\n', {}
    ),
    "case": Description(read_settings, CASE, {r"trial t01 \w+": ("number", "text")}),
    "layout": Description(
        read_layout,
        """rows = 16
columns = 8
pitch_mm = [20, 20.0]
cell_area_mm2 = 380
order = "row"
serpentine = true
first_id = 1
origin = "top-left"
mirrored = "rows"
masked = [[0, 0]]
dead = [[1, 0]]
unit = "kPa"
saturation_kPa = 100
rate_Hz = 50
delimiter = ","
decimal = "."
[sensors]
mat = [[0, 1]]
""",
        {"pitch_mm|cell_area_mm2": ("number", "list"), "mirrored": ("bool", "text")},
    ),
    "law": Description(
        read_law,
        f"""k = 8e6
b = 100.0
n = 1.2
delta_full = 0.001
mu_s = 0.8
mu_k = 0.7
v_th = 0.01
[zone.heel]
k = 1e6
b = 10.0
mu_s = 0.8
mu_k = 0.7
[foot]
height = 0.001
height_sd = 0.001
pitch = 0.01
pitch_sd = 0.01
standing = "{"0" * 64}"
""",
        {},
    ),
    "weights": Description(
        read_regression,
        """name = "tray"
source = "paper"
cells = ["AL", "PM"]
medial = [0.2, 0.9]
lateral = [0.8, 0.1]
""",
        {},
    ),
}
WRONG: dict[str, tuple[Any, ...]] = {
    "list": ([], [1], ["a"], [{}]),
    "table": ({}, {"a": 1}),
    "bool": (True, False),
    "number": (3, 2.5, float("nan")),
    "text": ("", "text"),
    "date": (date(2020, 1, 1),),
}


def kind_of(value: Any) -> str:
    """Kind of a value in TOML."""
    kinds = {list: "list", dict: "table", bool: "bool", int: "number", float: "number", str: "text", date: "date"}
    return kinds[type(value)]


def toml(value: Any) -> str:
    """A value as TOML writes it."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(key)} = {toml(each)}" for key, each in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return value.isoformat() if isinstance(value, date) else repr(value) if value != value else json.dumps(value)


def written(file: Path, content: Mapping[str, Any]) -> Path:
    file.write_text("".join(f"{json.dumps(key)} = {toml(each)}\n" for key, each in content.items()), encoding="utf-8")
    return file


def places(value: Any, before: Place = ()) -> Iterator[tuple[Place, Any]]:
    """Every key, of tables in tables and of lists too, with what it holds."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, each in items:
        yield (*before, key), each
        yield from places(each, (*before, key))


def changed(value: Any, place: Place, new: Any) -> Any:
    """The same with another value at one place."""
    first, *rest = place
    own = changed(value[first], tuple(rest), new) if rest else new
    if isinstance(value, list):
        return [own if k == first else each for k, each in enumerate(value)]
    return {**value, first: own}


def cases(what: str) -> Iterator[tuple[Place, Any, bool]]:
    """Where a value of another kind is written, the value, and whether it may be read."""
    description = DESCRIPTIONS[what]
    for place, value in places(tomllib.loads(description.text)):
        spelled = " ".join(map(str, place))
        own = [more for pattern, more in description.takes.items() if re.fullmatch(pattern, spelled)]
        taken = {kind_of(value), *(kind for more in own for kind in more)}
        for kind, values in WRONG.items():
            for each in values:
                yield place, each, kind in taken


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with all files that the descriptions name."""
    folder = tmp_path_factory.mktemp("descriptions")
    for name in ("a.csv", "a.stl", "a.osim", "a.particles", "P1_slow.csv", "P1_fast.csv", "P2_slow.csv", "P2_fast.csv"):
        (folder / name).touch()
    (folder / "people.csv").write_text("subject,mass [kg]\nP1,70\nP2,80\n", encoding="utf-8")
    (folder / "offsets.csv").write_text("x [mm]\n1\n2\n", encoding="utf-8")
    return folder


@pytest.mark.parametrize("what", DESCRIPTIONS)
def test_a_description_with_every_key_is_read(home: Path, what: str) -> None:
    DESCRIPTIONS[what].read(written(home / f"{what}.toml", tomllib.loads(DESCRIPTIONS[what].text)))


def outcome(read: Callable[[Path], Any], file: Path, place: Place) -> str:
    """What a reader does: read, refused with the key named, or what is wrong with it."""
    try:
        read(file)
    except InputError as error:
        line = str(error)
        if "\n" in line or not line.isprintable() or len(line) > 1000:
            return f"unclear: {line[:200]!r}"
        named = [str(part) for part in place if isinstance(part, str)]
        lines = line.replace(str(file.parent), "")
        return "refused" if any(part in lines for part in named) else f"elsewhere: {line[:200]}"
    except Exception as error:  # noqa: BLE001 - any other one is the finding
        return f"{type(error).__name__}: {error!s:.80}"
    return "read"


@pytest.mark.filterwarnings("ignore:.* is unusual for ")  # numbers of the right kind: the test gives 3 to each
@pytest.mark.filterwarnings("ignore:.*kinetic friction mu_k .* is larger than the static")
@pytest.mark.parametrize("what", DESCRIPTIONS)
def test_a_value_of_another_kind_is_refused_at_its_key(home: Path, what: str) -> None:
    """One of a kind that the key takes may be read, or contradict another key."""
    content, bad = tomllib.loads(DESCRIPTIONS[what].text), []
    for place, value, may_be_read in cases(what):
        file = written(home / f"{what}.toml", changed(content, place, value))
        said = outcome(DESCRIPTIONS[what].read, file, place)
        if said != "refused" and not (may_be_read and (said == "read" or said.startswith("elsewhere: "))):
            bad.append(f"{' '.join(map(str, place))} = {toml(value)} -> {said}")
    assert not bad, f"{len(bad)}:\n" + "\n".join(bad[:30])


def test_an_option_of_a_study_is_refused_by_its_name() -> None:
    """Of every analysis that a study may name, with every kind of value."""
    bad, seen = [], 0
    for entry in (each for each in ENTRIES if each.of_trials):
        for one in (each for each in declared(entry.load_options()) if each.settable):
            for value in (each for values in WRONG.values() for each in values):
                seen += 1
                try:
                    one.coerced(one.read(as_typed(one, value)))
                except InputError as error:
                    if one.name not in str(error):
                        bad.append(f"{entry.command} {one.name} = {toml(value)}: {error}")
                except Exception as error:  # noqa: BLE001 - any other one is the finding
                    bad.append(f"{entry.command} {one.name} = {toml(value)}: {type(error).__name__}")
    assert not bad and seen > 5000, f"{len(bad)} of {seen}:\n" + "\n".join(bad[:30])
