"""What `geocontact cop` refuses: one line, exit 2, nothing written; and what it only warns of."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from geocontact.io.opensim.osim import bodies_at_rest
from tests.cli.calls import MESHES, ROOT, call, done, poses, written
from tests.cli.test_cop import HEAD, LAW, cop, plate_file, sole

GOOD = "0,0,0,0.02,heel"


@pytest.mark.parametrize(
    ("head", "rows", "words"),
    [
        (
            "px [m], pz [m], radius [m], zone",
            ["0,0,0.02,heel"],
            "spheres.csv line 1: no column py; columns are: px, pz, radius, zone",
        ),
        (HEAD, ["0,0,0,-0.02,heel"], "line 2: radius is -0.02; it must be positive"),
        (HEAD, [GOOD, "0,0,0,0,heel"], "line 3: radius is 0; it must be positive"),
        (HEAD, ["0,0,0,8,heel"], "line 2: radius is 8 m, under a foot it is 0.5 mm to 0.5 m; write radius [mm]"),
        (HEAD, [GOOD, "0,0,0,20,heel"], "line 3: radius is 20 m"),
        (HEAD.replace("radius [m]", "radius [mm]"), ["0,0,0,0.02,heel"], "line 2: radius is 0.02 mm"),
        (HEAD, [GOOD, "0,nan,0,0.02,heel"], "line 3: py is nan; it must be finite"),
        (HEAD, ["0,inf,0,0.02,heel"], "line 2: py is inf; it must be finite"),
        (HEAD, [GOOD, "0,,0,0.02,heel"], "line 3: '' in column 'py' is not a number"),
        (HEAD, ["0,1_0,0,0.02,heel"], "'1_0' in column 'py' is not a number"),
        (HEAD, [GOOD, "0,0,0,0.02"], "line 3: 4 cells where 5 columns are named"),
        (HEAD, ["0,0,0,0.02,"], "line 2: zone '' is not a name"),
        (HEAD, ["0,0,0,0.02,[N]"], "zone '[N]' is not a name"),
        (HEAD, [], "holds no spheres"),
        (HEAD.replace("px [m]", "px"), [GOOD], "column 'px' has no unit; write e.g. `px [m]`"),
        (HEAD.replace("px [m]", "px [furlong]"), [GOOD], "column 'px' is in 'furlong'"),
        (f"{HEAD}, px [m]", [f"{GOOD},0"], "column 'px' occurs 2 times"),
        (f"{HEAD}, k [N/mm]", [f"{GOOD},10"], "column 'k' is in 'N/mm'"),
        (f"{HEAD}, k [N/m^n]", [f"{GOOD},0"], "line 2: k is 0; it must be positive"),
        (f"{HEAD}, b [N s/m]", [f"{GOOD},-1"], "line 2: b is -1; it must not be negative"),
        (f"{HEAD}, b [Ns/mm]", [f"{GOOD},1"], "column 'b' is in 'Ns/mm'"),
        (HEAD.replace(",", "\t"), [GOOD.replace(",", "\t")], "no column px, py, radius"),
    ],
)
def test_tables_of_spheres(tmp_path: Path, head: str, rows: list[str], words: str) -> None:
    spheres = written(tmp_path / "spheres.csv", "\n".join([head, *rows]) + "\n")
    result = cop(tmp_path, spheres=spheres)
    assert (result.code, len(result.complaints), result.folder.exists()) == (2, 1, False)
    assert words in result.complaints[0]


def test_an_exponent_that_the_unit_contradicts(tmp_path: Path) -> None:
    """The unit of k says it; typed otherwise it is refused."""
    table = f"{HEAD}, k [N/m^2]\n{GOOD},10\n"
    spheres = written(tmp_path / "spheres.csv", table)
    assert cop(tmp_path, spheres=spheres).record()["results"]["cop"]["law"]["n"] == 2.0
    other = cop(tmp_path, "--exponent", "1.2", spheres=spheres)
    assert other.code == 2 and "column k is in N/m^2 but the exponent is 1.2; give --exponent 2" in other.err


@pytest.mark.parametrize("content", [b"", b"\0" * 600, b"<html></html>", b"px [m]"])
def test_files_that_are_no_table(tmp_path: Path, content: bytes) -> None:
    result = cop(tmp_path, spheres=written(tmp_path / "spheres.csv", content))
    assert (result.code, len(result.complaints), result.folder.exists()) == (2, 1, False)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--gate", "-1"), "--gate: -1 N cannot be the force"),
        (("--gate", "nan"), "--gate: nan is not a finite number"),
        (("--stiffness", "-1"), "-1 cannot be the stiffness k of a sphere"),
        (("--damping", "-1"), "-1 N s/m cannot be a damping"),
        (("--friction", "0.9"), "--friction: '0.9' is not two numbers"),
        (("--friction", "0.9,x"), "--friction: 'x' is not a finite number"),
        (("--full-depth", "0"), "0 mm cannot be a depth of contact"),
        (("--point", "toe"), "toe"),
        (("--ground", "plane:0,1,0"), "has 3 numbers"),
        (("--ground", "plane:0,0,0,0"), "has no length"),
        (("--ground", "stairs:0,0.3"), "is not a flight of stairs"),
        (("--ground", "stairs:0,0.3:0.1,0.2:0.3"), "increasing edges"),
        (("--ground", "marsh"), "is neither a file nor of a known form"),
        (("--ground", "floor.stl"), "--unit: is missing"),
        (("--ground", "floor.stl", "--unit", "m"), "floor.stl: there is no such file"),
        (("--unit", "mm"), "--unit: has no effect here"),
        (("--plate", "1"), "--plate: has no effect without --compare"),
        (("--plate-pose", "x.txt"), "--plate-pose: has no effect without --compare"),
        (("--compare", str(MESHES / "sphere_r20.stl")), "is not a file of ground reactions"),
        (("--order", "XYZ"), "--order: has no effect here"),
        (("--angles", "deg"), "--angles: has no effect here"),
        (("--moving", "parent"), "--moving: has no effect without --osim"),
        (("--osim", str(MESHES / "leg.osim")), "--joint: is missing"),
        (("--ground", "plane:0,1,0,-1"), "the foot stays 997 mm above the ground in every frame"),
        (("--ground", "plane:0,1,0,0.1"), "deeper under the ground than any radius in frame 1"),
    ],
)
def test_options(tmp_path: Path, options: tuple[str, ...], words: str) -> None:
    result = cop(tmp_path, *options)
    assert (result.code, len(result.complaints), result.folder.exists()) == (2, 1, False), result.err
    assert words in result.complaints[0]


@pytest.mark.parametrize(
    ("law", "options", "words"),
    [
        ("k = 'stiff'", (), "law.toml k: input should be a valid number"),
        ("K = 3.0", (), "law.toml K: is not known here"),
        ("k = ", (), "is not TOML"),
        ("n = nan", (), "law.toml n: input should be a finite number"),
        ("[zone.midfoot]\nk = 1e4", (), "zone.midfoot: no sphere is in that zone; zones are: heel, toe"),
        ("[zone.heel]\nk = 1e4\nv_th = 0.3", (), "zone.heel.v_th: is not known here"),
        ("k = 1e4", ("--stiffness", "2e4"), "--stiffness: is given a second time by k in"),
        ("n = 1.5", ("--exponent", "1.2"), "--exponent: is given a second time by n in"),
        ("n = -1.5", (), "law.toml n: -1.5 is not above 0"),
        ("k = 0.5", (), "law.toml k: 0.5 cannot be the stiffness k of a sphere, in N/m^n"),
    ],
)
def test_law_files(tmp_path: Path, law: str, options: tuple[str, ...], words: str) -> None:
    result = cop(tmp_path, "--law", written(tmp_path / "law.toml", law + "\n"), *options)
    assert (result.code, len(result.complaints), result.folder.exists()) == (2, 1, False), result.err
    assert words in result.complaints[0]


def test_a_number_that_would_do_nothing(tmp_path: Path) -> None:
    spheres = sole(tmp_path, f"{GOOD},1e4", head=f"{HEAD}, k [N/m^n]")
    result = cop(tmp_path, "--stiffness", "2e4", spheres=spheres)
    assert result.code == 2 and "--stiffness: has no effect with the column k" in result.err


def test_force_plates(tmp_path: Path) -> None:
    two = plate_file(tmp_path).read_text().replace("ground_", "1_ground_")
    lines = two.splitlines()
    head, *rows = lines[6:]
    both = [
        f"{head}\t" + head.replace("time\t", "").replace("1_", "2_"),
        *(f"{r}\t{r.split(chr(9), 1)[1]}" for r in rows),
    ]
    file = written(tmp_path / "two.mot", "\n".join([*lines[:6], *both]).replace("nColumns=10", "nColumns=19") + "\n")
    for options, words in (
        ((), "holds 2 plates: 1_ground_force, 2_ground_force; pass --plate"),
        (("--plate", "3"), "no plate '3'"),
        (("--plate", "left"), "plates are: 1_ground_force, 2_ground_force (or 1 to 2)"),
    ):
        result = cop(tmp_path, *LAW, "--compare", file, *options)
        assert (result.code, result.folder.exists()) == (2, False) and words in result.err, result.err
    for name in ("2", "2_ground_force"):
        assert done(cop(tmp_path, *LAW, "--compare", file, "--plate", name)).code == 0
    late = poses(tmp_path, (0, 19, 0), (0, 18, 0), head="time [s], tx [mm], ty [mm], tz [mm], qw, qx, qy, qz")
    late.write_text(late.read_text().replace("\n0.0,", "\n10.0,").replace("\n1.0,", "\n11.0,"))
    result = cop(tmp_path, *LAW, "--compare", plate_file(tmp_path), motion=late)
    assert result.code == 2 and "runs from 0 to 2 s, the motion from 10 to 11 s; shift the clock" in result.err
    nothing = written(tmp_path / "ik.mot", two.replace("force", "angle"))
    assert "no column of the form ground_force_vx" in cop(tmp_path, *LAW, "--compare", nothing).err
    torn = written(tmp_path / "torn.mot", two.replace("1_ground_force_pz", "other"))
    assert "no column '1_ground_force_pz'" in cop(tmp_path, *LAW, "--compare", torn).err
    bad = written(tmp_path / "bad.c3d", b"\x02\x50" + b"\0" * 600)
    result = cop(tmp_path, *LAW, "--compare", bad)
    assert (result.code, len(result.complaints)) == (2, 1)
    assert "not a .c3d" in cop(tmp_path, *LAW, "--compare", written(tmp_path / "no.c3d", b"no" * 600)).err


def test_a_foot_in_the_air_is_a_warning_and_an_empty_column(tmp_path: Path) -> None:
    result = done(cop(tmp_path, *LAW, motion=poses(tmp_path, (0, 25, 0), (0, 30, 0))))
    assert result.warnings == ["no sphere touches the ground; the nearest comes within 5.00 mm"]
    assert result.bytes("cop.csv").decode().splitlines()[1] == "0,0,0,0,,,,,0,0,0"


def test_reservations_are_said_and_kept(tmp_path: Path) -> None:
    planar = sole(tmp_path, "0,0,0.02,1", head="px [m], py [m], radius [m], side", name="planar.csv")
    result = done(cop(tmp_path, spheres=planar, motion=poses(tmp_path, (0, -1, 0))))
    said = ("no column 'pz'", "no column 'zone'", "column 'side' is not used", "no stiffness given")
    for words in (*said, "one frame: the foot is assumed to stand still", "centres of spheres are under the ground"):
        assert any(words in line for line in result.warnings), words
    assert result.record()["warnings"] == result.warnings
    low = done(cop(tmp_path, *LAW, "--gate", "1e4"))
    assert low.warnings == ["no centre of pressure: the normal force stays below the gate of 10000 N"]


@pytest.mark.slow
def test_an_open_mesh_is_a_sheet(tmp_path: Path) -> None:
    text = "v -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3\nf 1 3 4\n"
    sheet = done(cop(tmp_path, *LAW, "--ground", written(tmp_path / "floor.obj", text), "--unit", "m"))
    assert any(
        "taken as a sheet; its upper side is the one to which its faces point on average (0.00, 1.00, 0.00)" in w
        for w in sheet.warnings
    )
    level = done(cop(tmp_path, *LAW))
    assert sheet.bytes("cop.csv") == level.bytes("cop.csv")


def test_time_in_per_cent_is_refused(tmp_path: Path) -> None:
    motion = poses(tmp_path, (0, 19, 0), (0, 18, 0), head="time [%], tx [mm], ty [mm], tz [mm], qw, qx, qy, qz")
    assert "time is in per cent of a cycle" in cop(tmp_path, motion=motion).err


def test_nothing_is_lost_of_an_earlier_result(tmp_path: Path) -> None:
    before = done(cop(tmp_path, *LAW)).bytes("cop.csv")
    failed = cop(tmp_path, "--ground", "plane:0,1,0,0.1")
    assert failed.code == 2 and failed.bytes("cop.csv") == before


def test_help_is_light_and_names_every_option() -> None:
    told = call("cop", "--help").out
    options = "motion out ground unit point gate law stiffness damping compare plate osim joint map"
    assert not [option for option in options.split() if f"--{option}" not in told]
    program = "import sys; from geocontact.cli.main import run; run(['cop', '--help']); "
    program += "sys.stderr.write(' '.join({name.partition('.')[0] for name in sys.modules}))"
    child = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, encoding="utf-8")
    assert not {"numpy", "scipy", "pandas", "numba", "matplotlib", "ezc3d", "igl"} & set(child.stderr.split())


def test_joint_of_a_model_as_motion(tmp_path: Path) -> None:
    """The sample knee's joint puts its child far above y = 0: refused in one line, by way of the reader of models."""
    result = cop(tmp_path, "--osim", MESHES / "knee.osim", "--joint", "none", motion=MESHES / "gait.mot")
    assert (result.code, len(result.complaints)) == (2, 1) and "none" in result.err


def test_a_joint_between_two_moving_bodies_is_refused_by_its_parent(tmp_path: Path) -> None:
    """A foot in its shank, not over the ground: no depth tells it, the model does."""
    result = cop(tmp_path, "--osim", MESHES / "leg.osim", "--joint", "ankle_r", motion=MESHES / "gait.mot")
    assert (result.code, len(result.complaints), result.folder.exists()) == (2, 1, False)
    said = "--joint: 'ankle_r' gives foot_r in tibia_r, which is not the ground; give poses of foot_r in the ground"
    assert said in result.err


def test_bodies_welded_to_the_ground_are_the_ground(tmp_path: Path) -> None:
    text = (MESHES / "leg.osim").read_text(encoding="utf-8")
    assert bodies_at_rest(MESHES / "leg.osim") == {"ground"}
    welded = text.replace('FreeJoint name="base"', 'WeldJoint name="base"').replace("</FreeJoint>", "</WeldJoint>")
    welded = welded.replace('BallJoint name="hip_r"', 'WeldJoint name="hip_r"').replace("</BallJoint>", "</WeldJoint>")
    assert bodies_at_rest(written(tmp_path / "platform.osim", welded)) == {"ground", "pelvis", "femur_r"}


def test_forces_on_the_plate_are_refused(tmp_path: Path) -> None:
    """The sign is told by the load: a plate only pushes."""
    file = plate_file(tmp_path)
    head, *rows = file.read_text(encoding="utf-8").split("endheader\n")
    names, *lines = rows[0].splitlines()
    turned = ["\t".join(cell if k in (0, 4, 5, 6) else str(-float(cell)) for k, cell in enumerate(line.split("\t")))
              for line in lines]  # fmt: skip
    written(file, "\n".join([f"{head}endheader", names, *turned]) + "\n")
    result = cop(tmp_path, *LAW, "--compare", file)
    assert (result.code, len(result.complaints), result.folder.exists()) == (2, 1, False)
    assert "ground_force: its force along y, which is up, is -89.44 N under load" in result.err
    assert "give the force on the foot: turn the sign of forces and torques" in result.err
