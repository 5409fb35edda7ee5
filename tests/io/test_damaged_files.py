"""Damaged files are refused in one line or read as they should be; 10,000 of them:
benchmarks/robustness/mutated_files.py."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from geocontact.analyses.frame.places import axis
from geocontact.analyses.frame.rerun import read_run
from geocontact.analyses.misalignment.compare.pairs import _law
from geocontact.data.errors import InputError
from geocontact.data.magnitude import too_large
from geocontact.data.plausible import LARGEST_MEANT
from geocontact.io.mesh.particles import read_particles
from geocontact.io.mocap.force_plates import read_force_plates
from geocontact.io.mocap.markers import read_markers
from geocontact.io.motion.motion import read_motion
from geocontact.io.motion.poses import read_pose
from geocontact.io.opensim.osim_contact import read_contact_spheres
from geocontact.io.recordings.area_table import read_area_table, read_radius_profile
from geocontact.io.recordings.load_cells import read_regression
from geocontact.io.recordings.spheres import read_contact_intervals, read_law, read_spheres
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.tables import read_table
from geocontact.study.description import read_study_file

DEEP = "[" * 3000 + "1" + "]" * 3000
SPHERE = """<OpenSimDocument Version="40000"><Model name="m"><Ground name="ground"/><ContactGeometrySet><objects>
<ContactSphere name="s"><socket_frame>/ground</socket_frame><radius>0.02</radius></ContactSphere>
</objects></ContactGeometrySet><ForceSet><objects><SmoothSphereHalfSpaceForce name="f">
<socket_sphere>/contactgeometryset/s</socket_sphere><stiffness>{}</stiffness></SmoothSphereHalfSpaceForce>
</objects></ForceSet></Model></OpenSimDocument>"""
NAMES = "time force_vx force_vy force_vz force_px force_py force_pz"
PLATE = f"a\nnRows=2\nendheader\n{NAMES}\n0 1 9 1 0 0 0\n1 1 inf 1 0 0 0\n"
TRC = (
    "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tNumFrames\tNumMarkers\tUnits\n100\t2\t1\tmm\nFrame#\tTime\tA\t\t\n"
    "\t\tX1\tY1\tZ1\n1\t0\t1\t2\t3\n2\t0.01\t1\tinf\t3\n"
)
Read = Callable[[Path], Any]
CASES: dict[str, tuple[str, str, Read, str]] = {
    # what is wrong: file, content, reader, part of the line
    "cell": ("a.csv", "time [s],f [N]\n0,1\n1,1e30\n", read_table, "line 3: 1e+30 in column 'f' is implausibly large"),
    "cell in storage": ("a.sto", "a\nendheader\ntime f\n0 1\n1 -1e39\n", read_table, "line 5: -1e+39 in column 'f'"),
    "side table": ("a.csv", "id,x [mm]\na,1e30\n", read_side_table, "line 2: '1e30' in column 'x' is not a finite"),
    "pose": ("a.txt", "1 0 0 1e30\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", read_pose, "a.txt: not a 4x4 matrix of finite"),
    "row of a matrix": (
        "a.txt",
        "1 0 0 1e39 0 1 0 0 0 0 1 0\n",
        lambda path: read_motion(path, unit="mm", rate=1.0),
        "line 1: the pose is not finite or too large",
    ),
    "settings": ("a.toml", "k = 1e30\n", read_law, "a.toml k: 1e+30 is implausibly large"),
    "deep settings": ("a.toml", f"k = {DEEP}\n", read_law, "a.toml: is nested too deeply"),
    "deep weights": ("a.toml", f"medial = {DEEP}\n", read_regression, "a.toml: is nested too deeply"),
    "digits": ("a.toml", f"k = {'9' * 5000}\n", read_law, "a.toml: is not TOML: Exceeds the limit"),
    "no law": ("a.toml", "\n\n", read_law, "a.toml: "),
    "study": ("a.toml", 'analysis = "area"\n[options]\nrate = nan\n', read_study_file, "options.rate: is nan; write a"),
    "deep fit": ("fit.json", f'{{"axis": {DEEP}}}', lambda path: axis(str(path), "mm"), "holds no axis and point_mm"),
    "fit": (
        "fit.json",
        '{"axis": [0, 0, 1], "point_mm": [0, 1e30, 0]}',
        lambda path: axis(str(path), "mm"),
        "holds no axis and point_mm",
    ),
    "deep law": ("elbow.json", f'{{"numbers": {DEEP}}}', _law, "holds no law of an elbow"),
    "run": ("run.json", '{"command": "a", "options": {}, "inputs": [{"file": null}, 3]}', read_run, ""),
    "long cell": (
        "area.csv",
        f"time [s],threshold [mm],area_fixed [mm^2]\n0,4,{'a' * 100_000}\n",
        lambda path: read_area_table([path]),
        "area.csv row 2: 'area_fixed [mm^2]' is aaaa",
    ),
    "area": (
        "area.csv",
        "time [s],threshold [mm],area_fixed [mm^2]\n0,4,1e30\n",
        lambda path: read_area_table([path]),
        "area.csv row 1: 'area_fixed [mm^2]' is 1e+30, which is implausibly large",
    ),
    "profile": (
        "profile.csv",
        "side,flexion [deg],radius [mm]\nall,0,36\nall,inf,35\n",
        read_radius_profile,
        "side 'all': radii must be above 0",
    ),
    "cells": (
        "profile.csv",
        f"side,flexion [deg],radius [mm]{',' * 20_000}\nall,0,36\n",
        read_radius_profile,
        "profile.csv line 1: more than 10000 cells",
    ),
    "side of a profile": (
        "profile.csv",
        f"side,flexion [deg],radius [mm]\n{'a' * 5000},0,36\n",
        read_radius_profile,
        "aaa: radii must be above 0",
    ),
    "sphere": ("a.csv", "px [m],py [m],pz [m],radius [m],zone\n1e39,0,0,0.01,a\n", read_spheres, "line 2: px is 1e39"),
    "interval": (
        "parameters.csv",
        "parameter,unit,value,lower,upper\nk,N/m,1,0,1e30\n",
        lambda path: read_contact_intervals(path, ["k"]),
        "parameters.csv k: an end of its interval is implausibly large",
    ),
    "no particles": (
        "a.particles",
        "\n \n\r\n",
        lambda path: read_particles(path, "mm"),
        "a.particles: holds no particles",
    ),
    "particle": (
        "a.particles",
        "1 2 3\n4 -1e30 6\n",
        lambda path: read_particles(path, "mm"),
        "line 2: y is -1e+30, which is implausibly large",
    ),
    "particle with underscores": (
        "a.particles",
        "1 2_0 3\n",
        lambda path: read_particles(path, "mm"),
        "line 1: '1 2_0 3' is not a point",
    ),
    "infinite force": ("a.mot", PLATE, read_force_plates, "line 6: 'force_vy' is inf"),
    "infinite place": (
        "a.csv",
        "time [s],A_x [mm],A_y [mm],A_z [mm]\n0,1,2,3\n1,1,-inf,3\n",
        read_markers,
        "line 3: a coordinate is infinite",
    ),
    "infinite place in .trc": ("a.trc", TRC, read_markers, "line 7: a coordinate is infinite"),
    "stiffness": (
        "a.osim",
        SPHERE.format("-3e6"),
        lambda path: read_contact_spheres(path, "ground"),
        "<stiffness>: -3e+06 is not above 0",
    ),
    "radius": (
        "a.osim",
        SPHERE.format("3e6").replace("0.02", "-0.02"),
        lambda path: read_contact_spheres(path, "ground"),
        "<radius>: -0.02 is not above 0",
    ),
    "number of a model": ("a.osim", SPHERE.format("1e30"), lambda path: read_contact_spheres(path, "ground"), "'1e30'"),
}


@pytest.mark.parametrize("name", CASES)
def test_what_damage_left_is_one_line(name: str, tmp_path: Path) -> None:
    file, content, read, part = CASES[name]
    (tmp_path / file).write_text(content, encoding="utf-8")
    if not part:
        read(tmp_path / file)
        return
    with pytest.raises(InputError) as refused:
        read(tmp_path / file)
    line = str(refused.value)
    assert part in line and file in line and "\n" not in line and len(line) < 1000


def test_numbers_are_too_large_beyond_64_bits() -> None:
    """A clock of nanoseconds since 1970 stays; what is not finite is told of where it is used."""
    values = np.array([1.8e18, -(2.0**64), LARGEST_MEANT * 1.01, -1e39, math.nan, math.inf])
    assert list(too_large(values)) == [False, False, True, True, False, False]


@pytest.mark.skipif(sys.platform != "linux", reason="memory is bounded by way of /proc")
def test_two_hundred_damaged_files_over_every_reader() -> None:
    from benchmarks.robustness.mutated_files import run

    found = run(int(os.environ.get("GEOCONTACT_DAMAGED", "200")), seed=3, only="", c3d=False)
    assert found["bad"] == 0, found["examples"]
    assert found["outcomes"]["refused"] > 80 and found["outcomes"]["read"] > 20 and len(found["readers"]) > 50
