"""Recordings of an elbow: every form gives the same numbers, and what cannot be an elbow's is refused in one line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError
from geocontact.io.recordings.elbow_recording import read_elbow_recording

TIME = np.arange(200) * 0.02
DEGREES = 50.0 + 40.0 * np.sin(2.0 * TIME)
FORCE = 5.0 * np.cos(2.0 * TIME)


def csv(folder: Path, head: str = "time [s],beta [deg],force [N]", *columns: np.ndarray, name: str = "t1.csv") -> Path:
    table = np.column_stack([TIME, *(columns or (DEGREES, FORCE))])
    np.savetxt(folder / name, table, delimiter=",", header=head, comments="", fmt="%.9g")
    return folder / name


def storage(folder: Path, degrees: str = "yes", unit: float = 1.0) -> Path:
    rows = "\n".join("\t".join(f"{v:.9g}" for v in row) for row in zip(TIME, DEGREES * unit, FORCE, strict=True))
    text = f"t\nversion=1\nnRows=200\nnColumns=3\ninDegrees={degrees}\nendheader\ntime\telbow\tforce\n{rows}\n"
    (folder / "t1.sto").write_text(text, encoding="utf-8")
    return folder / "t1.sto"


def test_a_table_in_other_units_signs_and_names(tmp_path: Path) -> None:
    head = "Time [ms],hinge [rad],Fx [lbf],slide [mm],cuff [mmHg],motor [N cm]"
    forces = -FORCE / 4.4482216152605, 7.0 * FORCE, np.full(200, 30.0), 40.0 * FORCE
    path = csv(tmp_path, head, -np.radians(DEGREES), *forces)
    text = path.read_text(encoding="utf-8").splitlines()
    rows = [",".join([f"{float(line.split(',')[0]) * 1e3:.9g}", *line.split(",")[1:]]) for line in text[1:]]
    path.write_text("\n".join(["# a comment", text[0], *rows]), encoding="utf-8")
    mapping = {
        "beta": (-1.0, "hinge"),
        "force": (-1.0, "Fx"),
        "displacement": (1.0, "slide"),
        "pressure": (1.0, "cuff"),
        "torque": (-1.0, "motor"),
    }
    r = read_elbow_recording(path, mapping)
    assert r.name == "t1" and r.displacement is not None and r.pressure is not None and r.torque is not None
    both = (r.time, TIME), (np.degrees(r.beta), DEGREES), (r.force, FORCE), (r.displacement, 7e-3 * FORCE)
    for got, want in (*both, (r.torque, -0.4 * FORCE)):
        np.testing.assert_allclose(got, want, atol=1e-6)
    assert r.pressure[0] == pytest.approx(3999.67, rel=1e-5)


@pytest.mark.parametrize(("degrees", "unit"), [("yes", 1.0), ("no", np.pi / 180.0)])
def test_storage_says_what_its_angles_are(tmp_path: Path, degrees: str, unit: float) -> None:
    r = read_elbow_recording(storage(tmp_path, degrees, unit), {"beta": (1.0, "elbow")}, unit="N")
    np.testing.assert_allclose(np.degrees(r.beta), DEGREES, rtol=1e-7)
    with pytest.raises(InputError, match="`unit`: is missing"):
        read_elbow_recording(storage(tmp_path, degrees, unit), {"beta": (1.0, "elbow")})


def test_analog_channels_of_a_c3d(tmp_path: Path) -> None:
    ezc3d = pytest.importorskip("ezc3d", reason="the extra `mocap` is not installed")
    content = ezc3d.c3d()
    content["parameters"]["POINT"]["RATE"]["value"] = [50.0]
    content["parameters"]["POINT"]["LABELS"]["value"] = ["m"]
    content["parameters"]["ANALOG"]["RATE"]["value"] = [100.0]
    content["parameters"]["ANALOG"]["LABELS"]["value"] = ["beta", "force", "cell"]
    content["parameters"]["ANALOG"]["UNITS"]["value"] = ["deg", "N", "V"]
    content["data"]["points"] = np.zeros((4, 1, 100))
    content["data"]["analogs"] = np.stack([DEGREES, FORCE, FORCE])[None]
    path = tmp_path / "t1.c3d"
    content.write(str(path))
    r = read_elbow_recording(path, {})
    np.testing.assert_allclose(np.degrees(r.beta), DEGREES, rtol=1e-5)
    np.testing.assert_allclose(r.force, FORCE, atol=1e-5)
    np.testing.assert_allclose(np.diff(r.time), 0.01, rtol=1e-9)
    with pytest.raises(InputError, match="'cell' is in 'V'"):
        read_elbow_recording(path, {"force": (1.0, "cell")})
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    with pytest.raises(InputError, match=r"t1\.c3d"):
        read_elbow_recording(path, {})


BAD = {
    "degrees declared as radians": ("time [s],beta [rad],force [N]", DEGREES, FORCE, "too much for the radians"),
    "few degrees declared as radians": ("time [s],beta [rad],force [N]", DEGREES / 15, FORCE, "beyond any elbow"),
    "radians declared as degrees": ("time [s],beta [deg],force [N]", np.radians(DEGREES), FORCE, "are these radians"),
    "no unit of the angle": ("time [s],beta,force [N]", DEGREES, FORCE, "degrees or radians"),
    "turned sign": ("time [s],beta [deg],force [N]", -DEGREES, FORCE, "`map` beta=-beta"),
    "turned sign, a small range": ("time [s],beta [deg],force [N]", -0.2 * DEGREES - 2.0, FORCE, "`map` beta=-beta"),
    "zero elsewhere": ("time [s],beta [deg],force [N]", DEGREES + 120, FORCE, "its zero elsewhere"),
    "constant angle": ("time [s],beta [deg],force [N]", np.full(200, 40.0), FORCE, "it hardly changes"),
    "small range": ("time [s],beta [deg],force [N]", 0.1 * DEGREES, FORCE, "it hardly changes"),
    "constant force": ("time [s],beta [deg],force [N]", DEGREES, np.full(200, 3.0), "3 N throughout"),
    "force in mN": ("time [s],beta [deg],force [N]", DEGREES, 1e3 * FORCE, "more than any cuff carries"),
    "no unit of the force": ("time [s],beta [deg],force", DEGREES, FORCE, "`unit`: is missing"),
    "another channel": ("time [s],beta [deg],load [N]", DEGREES, FORCE, "`map` force=NAME"),
    "a gap": ("time [s],beta [deg],force [N]", np.where(TIME[9] == TIME, np.nan, DEGREES), FORCE, "line 11"),
}


@pytest.mark.parametrize("name", BAD)
def test_what_cannot_be_an_elbows_is_refused_in_one_line(tmp_path: Path, name: str) -> None:
    head, beta, force, said = BAD[name]
    with pytest.raises(InputError) as caught:
        read_elbow_recording(csv(tmp_path, head, beta, force), {})
    line = str(caught.value)
    assert said in line and "\n" not in line and ("t1.csv" in line or "--" in line)


@pytest.mark.parametrize(
    ("head", "column", "said"),
    [
        ("displacement", FORCE, "has no unit"),
        ("displacement [m]", FORCE, "more than any compensation joint slides"),
        ("pressure [mmHg]", np.full(200, 4000.0), "reaches 4000 mmHg, more than any cuff"),
        ("pressure", np.full(200, 30.0), "has no unit"),
        ("pressure [mm]", np.full(200, 30.0), "is in 'mm'"),
        ("torque", FORCE, "'torque' has no unit; write torque [N m] (one of N m, N cm"),
        ("torque [N]", FORCE, "is in 'N'"),
        ("torque [N m]", 400.0 * FORCE, "reaches 2000 N m, more than an actuator of an arm turns with"),
    ],
)
def test_what_comes_besides_needs_its_unit(tmp_path: Path, head: str, column: np.ndarray, said: str) -> None:
    with pytest.raises(InputError, match="t1") as caught:
        read_elbow_recording(csv(tmp_path, f"time [s],beta [deg],force [N],{head}", DEGREES, FORCE, column), {})
    assert said in str(caught.value)


def test_other_files_are_refused(tmp_path: Path) -> None:
    (tmp_path / "no.c3d").write_bytes(b"no" * 600)
    with pytest.raises(InputError, match=r"not a \.c3d"):
        read_elbow_recording(tmp_path / "no.c3d", {})
    with pytest.raises(InputError, match="give a recording in seconds"):
        read_elbow_recording(csv(tmp_path, "time [%],beta [deg],force [N]"), {})
