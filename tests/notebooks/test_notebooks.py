"""Every notebook runs from top to bottom, and is kept with what it shows: small, and of the code beside it."""

from __future__ import annotations

import ast
import base64
import copy
import hashlib
import inspect
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

import geocontact as gc
from tests.cli.calls import FEMUR, INSERT, MESHES, Call, call, done, unpictured
from tests.unchecked import unchecked
from website.kept_outputs import kept

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
SHOWS = re.compile(r"(\.figures?\(.*\)(\[.*\])?|\.plot\(.*\);?|\.legend\(\);|aspect=.*\);)\s*\Z")
"""End of a cell below which a picture is meant."""

NO_PICTURE = re.compile(r"<\w+ size [\d.]+x[\d.]+ with \d+ Axes>")


def pictures(cell) -> int:
    """How many pictures stand below a cell; none stands there as text."""
    shown = [output.get("data", {}) for output in cell.outputs]
    for data in shown:
        assert "image/png" in data or not NO_PICTURE.search(data.get("text/plain", "")), cell.source
    return sum("image/png" in data or "<img src" in data.get("text/html", "") for data in shown)


LARGEST = 2_500_000
"""Bytes of what one cell shows: a page of 2 MB, and what its quotation marks become inside a frame."""


BLANK = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg=="
)
"""A picture of one pixel."""

NUMBER = re.compile(r"[-−]?\d[\d.]*(?:e[+-]?\d+)?")


def said_by(cells) -> list[str]:
    """What each cell prints, without the numbers' digits and the width of columns."""
    outputs = [[one for one in cell.get("outputs", ()) if one.get("name") == "stdout"] for cell in cells]
    printed = ["".join("".join(one["text"]) for one in each) for each in outputs]
    return [" ".join(NUMBER.sub("#", each).split()) for each in printed]


def shown_bytes(cell) -> int:
    """Of the outputs of a cell, as they stand in the file."""
    return len(json.dumps(cell.outputs))


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Execute a notebook with a folder of its own as the place where it writes; returns what its cells said."""

    def executed(notebook: Path, **environment: str) -> str:
        for name, value in environment.items():
            monkeypatch.setenv(name, value)
        os.symlink(ROOT / "meshes", tmp_path / "meshes")
        book = nbformat.read(notebook, as_version=4)
        NotebookClient(book, timeout=600, resources={"metadata": {"path": str(tmp_path)}}).execute()
        of_the_file = said_by(json.loads(notebook.read_text(encoding="utf-8"))["cells"])
        now = said_by(kept(copy.deepcopy(book), str(tmp_path), lambda page: BLANK)["cells"])
        assert now == of_the_file, f"run python -m website.notebooks {notebook.stem}"
        cells = [cell for cell in book.cells if cell.cell_type == "code"]
        for cell in cells:
            assert shown_bytes(cell) < LARGEST, f"{shown_bytes(cell)} bytes below {cell.source}"
            assert ("<iframe srcdoc=" in str(cell.outputs)) == cell.source.endswith(".embedded()"), cell.source
            assert pictures(cell) >= (SHOWS.search(cell.source) is not None), f"no picture below {cell.source}"
        outputs = [output for cell in cells for output in cell.outputs]
        return "".join(output.get("text", "") for output in outputs)

    return executed


def test_there_is_one_for_each_part():
    named = ("contact_area", "gap", "gap_own_model", "knee", "mat", "elbow", "motion", "prosthesis", "shoulder")
    assert {*named, "sit_to_stand"} <= {notebook.stem for notebook in NOTEBOOKS}


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_kept_for_any_python(notebook):
    book = json.loads(notebook.read_text(encoding="utf-8"))
    nbformat.validate(nbformat.from_dict(book))
    assert book["metadata"]["kernelspec"]["name"] == "python3"
    assert book["metadata"]["language_info"] == {"name": "python"}
    assert {key for cell in book["cells"] for key in cell["metadata"]} <= {"mystnb"}, "no times of execution"


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_outputs_are_of_the_code_beside_them(notebook):
    """The hash of all code when it was run; every cell that ends with a value or prints has something below it."""
    book = json.loads(notebook.read_text(encoding="utf-8"))
    cells = [cell for cell in book["cells"] if cell["cell_type"] == "code"]
    sources = ["".join(cell["source"]) for cell in cells]
    code = hashlib.sha256(json.dumps(sources, ensure_ascii=False).encode()).hexdigest()
    assert book["metadata"]["geocontact"]["code_sha256"] == code, f"run python -m website.notebooks {notebook.stem}"
    assert [cell["execution_count"] for cell in cells] == list(range(1, len(cells) + 1))
    for cell, source in zip(cells, sources, strict=True):
        *_, last = ast.parse(source.partition("\n")[2] if source.startswith("%%") else source).body
        shows = isinstance(last, ast.Expr) and not source.endswith(";")
        assert cell["outputs"] or not (shows or "print(" in source), source
        assert SHOWS.search(source) is None or any("image/png" in one.get("data", ()) for one in cell["outputs"]), (
            source
        )


PLACE = re.compile(r"(?<![\w.])/(?:tmp|home|root|work|usr|var|mnt|opt|Users)/|\b[A-Z]:\\\\")
MOMENT = re.compile(r"\b\d\d?:\d\d:\d\d\b|\b\d{4}-\d\d-\d\d[T ]\d\d")
LARGEST_PICTURE, LARGEST_BOOK, LARGEST_FOLDER = 100_000, 1_000_000, 6_000_000


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_outputs_are_small_and_name_no_machine(notebook):
    assert notebook.stat().st_size <= LARGEST_BOOK
    assert sum(each.stat().st_size for each in NOTEBOOKS) <= LARGEST_FOLDER
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    for output in (one for cell in cells for one in cell.get("outputs", ())):
        data = output.get("data", {})
        assert output["output_type"] != "error" and set(data) <= {"text/plain", "text/html", "image/png"}
        words = "".join("".join(each) for each in (output.get("text", ""), *map(data.get, data.keys() - {"image/png"})))
        for odd in ("Traceback", "<script", "<iframe", "data:image", "ipykernel"):
            assert odd not in words
        assert PLACE.search(words) is None and MOMENT.search(words) is None, words
        if "image/png" in data:
            picture = base64.b64decode("".join(data["image/png"]))
            assert picture[:4] == b"\x89PNG" and len(picture) <= LARGEST_PICTURE and b"tEXt" not in picture


WITH_BODIES = sorted({notebook.stem for notebook in NOTEBOOKS} - {"elbow", "gap", "gap_own_model"})
PICTURE = re.compile(r"!\[[^\]]+\]\((\.\./docs/pictures/\w+\.webp)\)")


@pytest.mark.parametrize("name", WITH_BODIES)
def test_bodies_are_seen_where_nothing_was_run(name):
    """The page in 3-D, as the gallery has it."""
    book = json.loads((ROOT / "notebooks" / f"{name}.ipynb").read_text(encoding="utf-8"))
    files = PICTURE.findall("".join(book["cells"][0]["source"]))
    assert len(files) == 1
    picture = ROOT / "notebooks" / files[0]
    assert picture.stat().st_size < 100_000 and picture.read_bytes()[8:12] == b"WEBP"
    assert picture.name in (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", WITH_BODIES)
def test_bodies_are_shown_live_once(name):
    book = json.loads((ROOT / "notebooks" / f"{name}.ipynb").read_text(encoding="utf-8"))
    cells = ["".join(cell["source"]) for cell in book["cells"]]
    assert sum(cell.endswith(".embedded()") for cell in cells) == 1


@pytest.mark.parametrize("name", sorted(WITH_BODIES))
def test_a_picture_of_the_page_stands_where_nothing_runs(name):
    """A viewer of repositories leaves the live page out: the first screen of it is kept in its place."""
    book = json.loads((ROOT / "notebooks" / f"{name}.ipynb").read_text(encoding="utf-8"))
    (live,) = (cell for cell in book["cells"] if "".join(cell["source"]).endswith(".embedded()"))
    (output,) = live["outputs"]
    picture = base64.b64decode("".join(output["data"]["image/png"]))
    assert "text/html" not in output["data"] and len(picture) > 20_000
    assert int.from_bytes(picture[16:20]) >= 640, "pixels wide"


WITHOUT_PYPLOT = """
import sys
import geocontact as gc
from IPython.core.formatters import DisplayFormatter

found = gc.virtual_markers("meshes/leg_swing.mot", model="meshes/leg.osim").figure()
assert "matplotlib.pyplot" not in sys.modules
data, _ = DisplayFormatter().format(found)
assert data["image/png"][:4] == b"\\x89PNG", data
"""


def test_a_figure_is_a_picture_where_pyplot_was_never_imported():
    told = subprocess.run([sys.executable, "-c", WITHOUT_PYPLOT], cwd=ROOT, capture_output=True, text=True)
    assert told.returncode == 0, told.stderr


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_contact_area_writes_what_the_command_writes(run, tmp_path):
    said = run(ROOT / "notebooks" / "contact_area.ipynb", GEOCONTACT_DATA=str(tmp_path / "none"))
    assert "101 frames, signed: both" in said and "no real data here; everything above is synthetic" in said
    given = ("--unit", "mm", "--motion", MESHES / "gait.csv", "--threshold", "1,4", "--split", "z", "--side", "right")
    with unpictured():
        assert call("area", FEMUR, INSERT, *given, "--out", tmp_path / "out").code == 0
    notebook = tmp_path / "contact-area-result"
    assert (notebook / "area.csv").read_bytes() == (tmp_path / "out/area.csv").read_bytes()
    page = (notebook / "report.html").read_text(encoding="utf-8")
    assert f"MOVING {FEMUR.name} on FIXED {INSERT.name}" in page


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_mat_writes_what_the_command_writes(run, tmp_path):
    said = run(ROOT / "notebooks" / "mat.ipynb")
    assert "151 frames of 16 x 8 cells" in said
    found, exact = re.findall(r"force \((.*)\) N, exactly \((.*)\) N", said)[0]
    for one, other in zip(found.split(","), exact.split(","), strict=True):
        assert float(one) == pytest.approx(float(other), abs=0.2)
    given, out = ROOT / "meshes" / "mat_thigh_16x8", tmp_path / "command"
    files = ("--layout", given / "layout.toml", "--landmarks", given / "landmarks.csv")
    scan = ("--surface", ROOT / "meshes" / "thigh.stl", "--unit", "mm")
    done(call("mat", given / "frames.csv", *files, *scan, "--cutoff", "0", "--out", out, folder=out))
    tables = sorted(file.name for file in out.glob("*.csv"))
    assert len(tables) == 4
    for name in tables:
        assert (tmp_path / "mat-result" / name).read_bytes() == (out / name).read_bytes(), name


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_elbow_shows_the_line_and_finds_what_the_command_finds(run, tmp_path):
    said = run(ROOT / "notebooks" / "elbow.ipynb")
    assert "d_lin 153 mm, d_tot 109 mm" in said
    assert "least identified direction: [-1.0, 1.0, 1.0, 1.0, 1.0]" in said
    low, high = map(float, re.findall(r"R² along the line ([\d.]+) to ([\d.]+)", said)[0])
    assert low == high > 0.98
    leaves = float(re.findall(r"slides from (\d+)°", said)[-1])
    assert 60.0 <= leaves <= 68.0
    assert 190.0 < float(re.findall(r"k by displacement (\d+) N/m", said)[0]) < 255.0
    lengths = [float(value) for value in re.findall(r"locked, stroke ([\d.]+) mm", said)]
    assert [value / lengths[1] for value in lengths] == pytest.approx([0.8, 1.0, 1.25], abs=0.01)
    trials, out = tmp_path / "elbow-trials", tmp_path / "command"
    locked, free = (sorted(trials.glob(f"{kind}_*.csv")) for kind in ("locked", "free"))
    unlocked = [part for file in free for part in ("--unlocked", file)]
    options = ("--held-out", locked[5], "--known", "l=169,z=127", "--bootstrap", 100, *unlocked, "--out", out)
    done(call("elbow", "fit", *locked[:5], *options, folder=out))
    tables = sorted(file.name for file in out.glob("*.csv"))
    assert len(tables) == 7
    for name in (*tables, "elbow.json"):
        assert (tmp_path / "elbow-result" / name).read_bytes() == (out / name).read_bytes(), name


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_gap_finds_the_damper_and_writes_what_the_command_writes(run, tmp_path):
    said = run(ROOT / "notebooks" / "gap.ipynb")
    assert "damping is missing; it sits in torque" in said
    assert "on fresh trials of this kind the error shrinks by" in said
    planted, found = map(float, re.findall(r"planted: damping of ([\d.]+) N m s/rad; found: ([\d.]+)", said)[0])
    out = tmp_path / "command"
    with unchecked():
        done(call("gap", "diagnose", tmp_path / "gap-case", "--bare", "--out", out))
    tables = sorted(file.name for file in out.glob("*.csv"))
    assert tables == ["gap_map.csv", "held_out.csv", "ranking.csv", "trials.csv"]
    for name in tables:
        assert (tmp_path / "gap-result" / name).read_bytes() == (out / name).read_bytes(), name
    assert found == pytest.approx(planted, rel=0.05)


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_gap_own_model_finds_what_it_plants_and_nothing_where_nothing_is(run):
    """The angle's noise went through no filter."""
    said = run(ROOT / "notebooks" / "gap_own_model.ipynb")
    assert "as measured: no_gap" in said
    assert "not to be seen at any plausible size: sensor_gain.torque" in said
    assert "not separable (less than 5 nats between any two): time_shift and filter_lag" in said
    planted, found = map(float, re.findall(r"damping\.b = ([\d.]+)", said)[-2:])
    assert found == pytest.approx(planted, rel=0.1)
    assert re.search(r"known load of .* N m .*: tells .*sensor_gain.* nats more", said)


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_knee_goes_from_meshes_to_a_modulus_that_was_planted(run, tmp_path):
    said = run(ROOT / "notebooks" / "knee.ipynb", GEOCONTACT_DATA=str(tmp_path / "none"))
    assert "no real data here; everything above is synthetic" in said
    assert "sagittal radius 33.9 mm at 0°, 22.0 mm at 80° of flexion" in said
    peaks = [float(value) for value in re.findall(r"largest pressure ([\d.]+) MPa", said)]
    assert len(peaks) == 2 and 1.0 < peaks[0] < 0.5 * peaks[1] < 50.0, "0.05 mm make more than twice the pressure"
    modulus = [float(value) for value in re.findall(r"^(?:medial|lateral): E\* ([\d.]+) MPa", said, re.MULTILINE)]
    assert modulus[:2] == pytest.approx([6.8, 6.8], rel=0.02), "R follows flexion"
    assert abs(modulus[2] - 6.8) > 0.3, "one radius does not"
    explained = [float(value) for value in re.findall(r"(?:medial|lateral), trial not used: .* R² ([\d.]+)", said)]
    assert len(explained) == 2 and min(explained) > 0.8
    for line in by_commands(tmp_path / "knee-result", tmp_path / "commands"):
        assert line in said, "the command says something else"


def by_commands(made: Path, out: Path) -> list[str]:
    """What the commands say of the files that the knee's notebook made: a sentence a line."""
    femoral, coarse, insert = (
        ROOT / "meshes" / f"{name}.stl"
        for name in ("femoral_component_right_medium", "femoral_component_right_coarse", "tibial_insert_right_coarse")
    )
    how = ("--unit", "mm", "--motion", made / "gait.csv", "--split", "z", "--side", "right", "--rule", "clip")
    patch = ("--axis", "0,0,0,0,0,1", "--sagittal=-y,-x", "--region", "outward>0.5", "--split", "z", "--side", "right")
    layer = ("--pressure", "--modulus", "500MPa", "--poisson", "0.46", "--piece", "1mm", "--region", "ny>0.25")
    bent = ("--profile", made / "radii" / "profile.csv", "--flexion", ROOT / "meshes" / "gait.mot")
    given = ("--area", made / "area.csv", "--force", made / "forces.csv", "--threshold", "1", "--poisson", "0.25,0.46")
    commands = (
        ("fit", femoral, "--shape", "cylinder", "--unit", "mm", *patch, "--profile=-20:100:5", "--window", "30"),
        ("area", coarse, insert, *how, "--threshold", "0.5,1,2,4"),
        ("loadcells", made / "cells.csv"),
        ("area", coarse, insert, *how, *layer),
        ("modulus", *given, *bent, "--map", "flexion=knee_flexion"),
    )
    with unpictured():
        calls = [done(call(*command, "--out", out / str(k))) for k, command in enumerate(commands)]
    return said_of(calls)


def said_of(calls: list[Call]) -> list[str]:
    """Sentences of commands, without where their results are."""
    return [line for each in calls for line in each.out.splitlines() if not line.startswith("results in ")]


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_motion_finds_the_angles_and_the_marker_that_is_off(run, tmp_path):
    said = run(ROOT / "notebooks" / "motion.ipynb")
    assert "16 markers in 101 frames" in said
    assert float(re.findall(r"knee: off by at most ([\d.e+-]+) deg", said)[0]) < 1e-4
    every, without = map(float, re.findall(r"knee off by at most ([\d.]+) deg", said))
    assert every > 0.1 and without < 0.01
    carried, weight = map(float, re.findall(r"pelvis: (\d+) N on average, a weight of (\d+) N", said)[0])
    assert carried == pytest.approx(weight, rel=0.05)
    assert "moments.html written" in said
    made, out, leg = tmp_path / "motion-result", tmp_path / "commands", ("--model", MESHES / "leg.osim")
    commands = (
        ("markers", MESHES / "leg_swing.mot"),
        ("ik", made / "virtual" / "markers.trc", "--knee", "right=femur_r,tibia_r"),
        ("id", made / "angles" / "ik.mot"),
    )
    with unpictured():
        calls = [done(call(*command, *leg, "--out", out / command[0])) for command in commands]
    for line in said_of(calls):
        assert line in said, "the command says something else"
    for command, folder, files in (
        ("markers", "virtual", ("markers.trc",)),
        ("ik", "angles", ("ik.mot", "markers.csv", "knees.csv")),
    ):
        for file in files:
            assert (made / folder / file).read_bytes() == (out / command / file).read_bytes(), file


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_shoulder_says_what_the_commands_say(run, tmp_path):
    said = run(ROOT / "notebooks" / "shoulder.ipynb")
    supported, bare = map(float, re.findall(r"screw-in: (-?[\d.]+) N with support, (-?[\d.]+) N without", said)[0])
    assert supported > 10.0 > bare
    assert "arms.html written" in said
    made, out, trial = tmp_path / "shoulder-result", tmp_path / "commands", MESHES / "overhead_P1T1S100"
    given = ("simulate", trial / "markers.trc", "--tool", trial / "tool.csv", "--upright", "0:0.5")
    commands = (given, ("compare", made / "right.csv", made / "logger.csv"), ("optimise",))
    with unpictured():
        calls = [done(call("shoulder", *each, "--out", out / each[0])) for each in commands]
    for line in said_of(calls):
        assert line in said, "the command says something else"
    for name in ("right.csv", "left.csv", "numbers.csv"):
        assert (made / name).read_bytes() == (out / "simulate" / name).read_bytes(), name


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_prosthesis_says_what_the_commands_say(run, tmp_path):
    said = run(ROOT / "notebooks" / "prosthesis.ipynb")
    plain, calibrated = map(float, re.findall(r"resultant: ([\d.]+) built in, ([\d.]+) calibrated", said)[0])
    assert calibrated < plain < 0.12
    low, medium, high = (
        float(re.findall(rf"{name}: \d+ N m, ([\d.]+) J", said)[0]) for name in ("low", "medium", "high")
    )
    assert low > medium > high  # the softer, the more is stored
    made, out, trial = tmp_path / "prosthesis-result" / "model", tmp_path / "command", MESHES / "amputee_P1"
    given = (
        "scale",
        trial / "standing.trc",
        "--functional",
        trial / "functional.trc",
        "--mass",
        77.3,
        "--height",
        1.81,
    )
    with unpictured():
        calls = [done(call("prosthesis", *given, "--out", out))]
    for line in said_of(calls):
        assert line in said, "the command says something else"
    for name in ("segments.csv", "joints.csv", "amputee.osim"):
        assert (made / name).read_bytes() == (out / name).read_bytes(), name


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.filterwarnings("default")  # of the notebook machinery itself
def test_sit_to_stand_says_what_the_command_says(run, tmp_path):
    said = run(ROOT / "notebooks" / "sit_to_stand.ipynb")
    assert "3 of 3 motions certified" in said and "standing_up.html written" in said
    out, worn = tmp_path / "command", MESHES / "standing_up_exoskeleton"
    options = ("--parameters", worn / "truth.csv", "--against", worn / "study.toml", "--nodes", 42, "--out", out)
    with unpictured():
        one = done(call("sit-to-stand", "predict", MESHES / "standing_up_held_out" / "study.toml", *options))
    for line in said_of([one]):
        assert line in said, "the command says something else"
    tables = sorted(file.name for file in out.glob("*.csv"))
    assert len(tables) == 3
    for name in tables:
        assert (tmp_path / "standing-result" / "predicted" / name).read_bytes() == (out / name).read_bytes(), name


def code_of(notebook: Path) -> str:
    """Its cells of code, with modules that a cell writes."""
    book = json.loads(notebook.read_text(encoding="utf-8"))
    cells = ["".join(cell["source"]) for cell in book["cells"] if cell["cell_type"] == "code"]
    return "\n".join(cell.split("\n", 1)[1] if cell.startswith("%%writefile ") else cell for cell in cells)


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_calls_of_the_package_are_there_with_their_arguments(notebook):
    """Of every notebook, those that `make long` runs too: a name or an option that is gone is seen at once."""
    calls = [node for node in ast.walk(ast.parse(code_of(notebook))) if isinstance(node, ast.Call)]
    seen = 0
    for node in calls:
        words = ast.unparse(node.func).split(".")  # of a method of a result the rest is not a name
        named = re.fullmatch(r"gc(\.\w+)+", ast.unparse(node.func))
        if named is None or any(isinstance(each, ast.Starred) for each in node.args):
            continue
        called, known = gc, {each.arg: None for each in node.keywords if each.arg is not None}
        for word in words[1:]:
            called = getattr(called, word)
        signature = inspect.signature(called)
        whole = len(known) == len(node.keywords)  # without ** of a dictionary
        (signature.bind if whole else signature.bind_partial)(*[None] * len(node.args), **known)
        assert not known or not any(each.kind is each.VAR_KEYWORD for each in signature.parameters.values()), words
        seen += 1
    assert seen > 0


ONLY = {"geocontact", "IPython.display", "pandas", "matplotlib", "matplotlib.pyplot", "pathlib"}


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_only_public_names_are_used(notebook):
    """`import geocontact as gc`, pandas and matplotlib; nothing deeper, in a module that a cell writes as well."""
    source = code_of(notebook)
    code = ast.parse(source)
    imports = [node for node in ast.walk(code) if isinstance(node, (ast.Import, ast.ImportFrom))]
    named = {alias.name for node in imports if isinstance(node, ast.Import) for alias in node.names}
    named |= {node.module for node in imports if isinstance(node, ast.ImportFrom)}
    assert named <= ONLY | set(sys.stdlib_module_names), sorted(named - ONLY)
    assert set(re.findall(r"\bgc\.(\w+)", source)) <= set(gc.__all__)
