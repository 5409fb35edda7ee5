"""The time series for ParaView: what is written comes back, by pyvista and by the package's own reader."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from defusedxml.ElementTree import parse

from geocontact.data.errors import InputError
from geocontact.io.mesh.meshes import read_mesh
from geocontact.view.surfaces import vtp_series
from geocontact.view.surfaces.scene import MappedBody
from geocontact.view.surfaces.vtp_series import truncation, write_vtp_series
from tests.view.surfaces.ball import LIMIT, MM, THRESHOLDS, series

PROGRAM = "geocontact 0.0.0"


@pytest.fixture
def pyvista():
    """The library, or the reason why not."""
    return pytest.importorskip("pyvista")


def bodies(folder: Path, frame: int) -> tuple[Path, Path]:
    return folder / f"frames/fixed_{frame:03d}.vtp", folder / f"frames/moving_{frame:03d}.vtp"


def test_positions_and_faces_come_back(pyvista, tmp_path: Path) -> None:
    """By both readers; to the float32 of the file."""
    given = series()
    write_vtp_series(given, tmp_path, PROGRAM)
    for k in range(len(given)):
        expected = (
            (given.fixed.vertices, given.fixed.faces),
            (given.poses[k].apply(given.moving.vertices), given.moving.faces),
        )
        for file, (vertices, faces) in zip(bodies(tmp_path, k), expected, strict=True):
            one, other = pyvista.read(file), read_mesh(file, "mm")
            assert np.abs(one.points * MM - vertices).max() < 1e-8
            assert np.abs(other.vertices - vertices).max() < 1e-8
            assert np.array_equal(one.regular_faces, faces) and np.array_equal(other.faces, faces)


def test_distances_come_back_and_are_truncated_where_not_known(pyvista, tmp_path: Path) -> None:
    given = series()
    write_vtp_series(given, tmp_path, PROGRAM)
    limit = truncation(given)
    assert 4 * MM < limit <= LIMIT
    for k in range(len(given)):
        for file, body in zip(bodies(tmp_path, k), (given.fixed, given.moving), strict=True):
            read = pyvista.read(file)
            distance = read.point_data["distance [mm]"] * MM
            known = np.isfinite(body.distance[k])
            assert np.abs(distance - body.distance[k])[known].max() < 1e-9
            assert np.allclose(distance[~known], limit, rtol=1e-6)
            assert read.point_data["distance [mm]"].dtype == np.float32
            for threshold in THRESHOLDS:
                within = read.point_data[f"within {threshold / MM:g} mm"]
                assert np.array_equal(within == 1, body.distance[k] <= threshold)


def test_deep_inside_is_within(pyvista, tmp_path: Path) -> None:
    given = series(1)
    deep = np.where(given.fixed.distance < 0.0, -np.inf, given.fixed.distance)
    assert np.isneginf(deep).any()
    changed = series(1, fixed=MappedBody(given.fixed.vertices, given.fixed.faces, deep))
    write_vtp_series(changed, tmp_path, PROGRAM)
    read = pyvista.read(bodies(tmp_path, 0)[0])
    assert (read.point_data["within 1 mm"][np.isneginf(deep[0])] == 1).all()
    assert np.allclose(read.point_data["distance [mm]"][np.isneginf(deep[0])] * MM, -truncation(changed))


def test_contour_lines_have_no_holes(pyvista, tmp_path: Path) -> None:
    """The filter that a user applies first; not-a-number in the distances gives points that are not numbers."""
    write_vtp_series(series(1), tmp_path, PROGRAM)
    read = pyvista.read(bodies(tmp_path, 0)[0])
    lines = read.contour([1.0, 4.0], scalars="distance [mm]")
    assert lines.n_points and np.isfinite(lines.points).all()
    assert {1.0, 4.0} == set(np.unique(lines["distance [mm]"]))


def test_field_data_tell_what_it_is(pyvista, tmp_path: Path) -> None:
    given = series(3, time_unit="%")
    write_vtp_series(given, tmp_path, PROGRAM)
    fixed, moving = (pyvista.read(file).field_data for file in bodies(tmp_path, 2))
    assert fixed["TimeValue"] == given.time[2]
    for data, body, signed in ((fixed, "FIXED", 1), (moving, "MOVING", 0)):
        texts = {name: str(data[name][0]) for name in ("time unit", "length unit", "body", "frame of reference")}
        assert texts == {"time unit": "%", "length unit": "mm", "body": body, "frame of reference": "FIXED"}
        assert data["thresholds [mm]"] == pytest.approx([1.0, 4.0])
        assert data["truncated at [mm]"] == pytest.approx([truncation(given) / MM])
        assert data["signed"] == [signed]
        assert str(data["program"][0]) == PROGRAM


def test_collections_give_the_times(pyvista, tmp_path: Path) -> None:
    """All digits of the times; every file there, with the body it is said to be."""
    given = series(5)
    written = write_vtp_series(given, tmp_path, PROGRAM)
    assert [file.name for file in written] == ["both.pvd", "fixed.pvd", "moving.pvd"]
    for file, count in zip(written, (2, 1, 1), strict=True):
        reader = pyvista.PVDReader(file)
        assert reader.time_values == given.time.tolist()
        reader.set_active_time_point(3)
        assert len(reader.read()) == count
        rows = list(parse(file).iter("DataSet"))
        assert len(rows) == count * len(given)
        for row in rows:
            read = pyvista.read(tmp_path / row.get("file"))
            assert read.field_data["TimeValue"] == float(row.get("timestep"))
            assert str(read.field_data["body"][0]) == row.get("name")


def test_names_come_from_numbers(pyvista, tmp_path: Path) -> None:
    write_vtp_series(series(2), tmp_path, '../<script>"$x$&')
    names = sorted(file.relative_to(tmp_path).as_posix() for file in tmp_path.rglob("*") if file.is_file())
    assert names == [
        "both.pvd", "fixed.pvd", "frames/fixed_000.vtp", "frames/fixed_001.vtp",
        "frames/moving_000.vtp", "frames/moving_001.vtp", "moving.pvd",
    ]  # fmt: skip
    assert pyvista.read(tmp_path / names[2]).field_data["program"][0] == '../<script>"$x$&'


def test_twice_the_same_bytes(pyvista, tmp_path: Path) -> None:
    for name in ("one", "two"):
        write_vtp_series(series(2), tmp_path / name, PROGRAM)
    for file in (tmp_path / "one").rglob("*.*"):
        assert file.read_bytes() == (tmp_path / "two" / file.relative_to(tmp_path / "one")).read_bytes()


def test_the_order_of_names_is_that_of_the_frames(pyvista, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """More than a thousand frames: all names have the same number of digits."""
    monkeypatch.setattr(vtp_series, "_surface", lambda *_: None)
    monkeypatch.setattr(vtp_series, "_describe", lambda *_: None)
    monkeypatch.setattr(vtp_series, "encoded_vtp", lambda _: b"")
    point = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]) * MM
    many = MappedBody(point, np.array([[0, 1, 2]]), np.zeros((1001, 3)))
    write_vtp_series(series(1001, fixed=many, moving=many), tmp_path, PROGRAM)
    names = re.findall(r"fixed_\d+", (tmp_path / "fixed.pvd").read_text())
    assert names == sorted(names) and len(set(names)) == 1001


@pytest.mark.skipif(sys.platform == "win32", reason="no limit on the size of files")
def test_a_full_disk_is_an_error_and_not_a_crash(pyvista, tmp_path: Path) -> None:
    """VTK's own writer ends the process here."""
    program = (
        "import resource, signal, sys; from pathlib import Path\n"
        "from geocontact.view.surfaces.vtp_series import write_vtp_series\n"
        "from tests.view.surfaces.ball import series\n"
        "import pyvista\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN); resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))\n"
        "try:\n"
        "    write_vtp_series(series(1), Path(sys.argv[1]), 'p')\n"
        "except OSError as error:\n"
        "    sys.exit(7)\n"
    )
    root = Path(__file__).resolve().parents[3]
    ended = subprocess.run([sys.executable, "-c", program, str(tmp_path)], cwd=root, capture_output=True, text=True)
    assert ended.returncode == 7, ended.stderr


def test_without_pyvista_one_line_says_what_to_do(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(InputError) as refused:
        write_vtp_series(series(1), tmp_path, PROGRAM)
    assert "pyvista cannot be imported" in str(refused.value)
    assert str(refused.value).endswith("pip install 'geocontact[view]'")
    assert not list(tmp_path.iterdir())


def test_a_series_refuses_frames_that_do_not_match() -> None:
    with pytest.raises(ValueError, match="3, 4, 4 and 4 frames"):
        series(4, time=np.zeros(3))
    with pytest.raises(ValueError, match="signed"):
        series(2, signed="yes")
