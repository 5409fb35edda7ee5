"""The synthetic mat recordings: exact resultants against other quadratures, and the shipped files against both."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from geocontact.data.pressure_frames import PressureFrames
from meshes.make import differing, mat_files
from meshes.mat_recordings import DRIFT, recordings
from meshes.moving_pressure import Footprint, resultant
from meshes.segments import THIGH, Oval, Segment

pytestmark = [pytest.mark.slow, pytest.mark.long]  # they change with the scripts of the samples only

FOLDER = Path(__file__).parents[2] / "meshes"
RECORDINGS = list(recordings())
STRETCH = {"mat_shank_16x8": (0.965, 1.018), "mat_upper_arm_16x8": (0.96, 1.03)}
"""Least and largest area of the skin under a flat one, on the segments that curve more than thigh and torso."""
each_recording = pytest.mark.parametrize("recording", RECORDINGS, ids=lambda r: r.mat.name)


def shipped(recording, name):
    """Numbers of a table beside the recording, comments and the header left out; empty cells are NaN."""
    text = (FOLDER / recording.mat.name / name).read_text(encoding="ascii")
    rows = [line for line in text.splitlines() if not line.startswith("#")]
    return rows[0].split(","), np.genfromtxt(rows[1:], delimiter=",")


def readings(recording, name):
    header, numbers = shipped(recording, name)
    mat = recording.mat
    assert header[0] == "time [s]"
    assert header[1:] == [f"r{i}c{j} [kPa]" for i in range(mat.rows) for j in range(mat.columns)]
    assert numbers[:, 0] == pytest.approx(recording.time, abs=1e-12)
    return numbers[:, 1:].reshape(-1, mat.rows, mat.columns)


def by_squares(segment, footprint, point, n):
    """Resultants of one frame by the midpoint rule on n x n squares of (theta, y), pressed or not."""
    reach = 1.3 * max(footprint.along, footprint.across)
    half = np.array([reach / segment.radius(footprint.middle)[0, 0], reach])
    ticks = (2 * np.arange(n) + 1) / n - 1
    at = footprint.middle[0] + half * np.stack(np.meshgrid(ticks, ticks, indexing="ij"), axis=-1)
    points, skin = segment.points(at), segment.area_vector(at)
    push = -footprint.pressure(segment, points[None])[0][..., None] * 1e-3 * skin * half.prod() * 4 / n**2
    pressed = (footprint.reach(segment, points[None])[0] < 1)[..., None]
    area = (np.linalg.norm(skin, axis=-1, keepdims=True) * pressed).sum() * half.prod() * 4 / n**2
    moment = np.cross(points - point, push) * 1e-3
    normal = np.linalg.norm(push, axis=-1)
    first = (normal[..., None] * points).sum(axis=(0, 1))
    return push.sum(axis=(0, 1)), moment.sum(axis=(0, 1)), normal.sum(), first, area


@pytest.mark.parametrize("power", [0.5, 2.0], ids=["hertz", "soft"])
@pytest.mark.parametrize(
    ("recording", "part", "frame"), [(0, 0, 40), (0, 0, 95), (1, 0, 50), (1, 1, 70)], ids=lambda k: str(k)
)
def test_resultant_agrees_with_the_midpoint_rule(recording, part, frame, power):
    whole = RECORDINGS[recording].footprints[part]
    one = Footprint(whole.peak[[frame]], whole.middle[[frame]], whole.along, whole.across, power)
    segment, point = RECORDINGS[recording].mat.segment, np.array([10.0, -30.0, 20.0])
    exact = resultant(segment, one, point)
    force, moment, normal, first, area = by_squares(segment, one, point, 600)
    assert one.peak[0] > 1
    assert force == pytest.approx(exact.force[0], abs=2e-5 * normal)
    assert moment == pytest.approx(exact.moment[0], abs=2e-6 * normal)
    assert normal == pytest.approx(exact.normal[0], rel=2e-5)
    assert first == pytest.approx(exact.first_moment[0], rel=2e-5, abs=2e-3 * normal)
    assert area == pytest.approx(exact.area[0], rel=3e-4)


def test_resultant_on_a_wide_tube_is_that_of_hertz():
    """A plane footprint carries 2/3 pi a b p0 on pi a b; the tube's curvature adds of the order of (a/R)^2."""
    tube = Segment("tube", 400.0, Oval(1e6, 1e6), 0.0, 0.0)
    found = resultant(tube, Footprint(np.array([30.0]), np.array([[0.0, 12.0]]), 50.0, 30.0), np.array([1e6, 0.0, 4.0]))
    force = 2 / 3 * np.pi * 50.0 * 30.0 * 30e-3
    assert found.normal[0] == pytest.approx(force, rel=1e-8)
    assert found.force[0] == pytest.approx([-force, 0.0, 0.0], rel=1e-8, abs=1e-9)
    assert found.area[0] == pytest.approx(np.pi * 50.0 * 30.0, rel=1e-8)
    assert found.centre[0, 1:] == pytest.approx([12.0, 0.0], abs=1e-8)
    # r x F with r = (0, 12, -4) mm from the point and F = (-force, 0, 0)
    assert found.moment[0] == pytest.approx([0.0, 4e-3 * force, 12e-3 * force], rel=1e-6, abs=1e-6)


@each_recording
def test_resultants_do_not_depend_on_the_nodes_and_move_with_the_point(recording):
    for footprint in recording.footprints:
        there, here = np.array([15.0, -40.0, 25.0]), np.zeros(3)
        segment = recording.mat.segment
        fine, usual, moved = (
            resultant(segment, footprint, here, 96, 40),
            resultant(segment, footprint, here),
            resultant(segment, footprint, there),
        )
        for name in ("force", "moment", "normal", "first_moment", "area"):
            scale = np.abs(getattr(fine, name)).max()
            assert getattr(usual, name) == pytest.approx(getattr(fine, name), abs=1e-12 * scale)
        shifted = moved.moment + np.cross(there, moved.force) * 1e-3
        assert shifted == pytest.approx(usual.moment, abs=1e-12 * np.abs(usual.force).max())


@each_recording
def test_nothing_presses_outside_the_mat(recording):
    mat = recording.mat
    u, v = np.linspace(0, mat.rows, 129), np.linspace(0, mat.columns, 65)
    rim = [(u, np.array([0.0, mat.columns])), (np.array([0.0, mat.rows]), v)]
    points = np.vstack([mat.segment.points(mat.parameters(*lines)).reshape(-1, 3) for lines in rim])
    for footprint in recording.footprints:
        assert (footprint.reach(mat.segment, points[None]) > 1).all()


@pytest.mark.slow
@each_recording
def test_cells_laid_out_carry_the_exact_force(recording):
    """Cell pressures times the skin's area under the cell, summed with the outward normals, give the truth."""
    mat, frame = recording.mat, len(recording.time) // 2
    points, weights = mat.cell_points()
    inside = (np.polynomial.legendre.leggauss(8)[0] + 1) / 2
    u, v = ((np.arange(n)[:, None] + inside).ravel() for n in (mat.rows, mat.columns))
    h = 1e-4
    by_u, by_v = (
        (
            mat.segment.points(mat.parameters(u + h * a, v + h * b))
            - mat.segment.points(mat.parameters(u - h * a, v - h * b))
        )
        / (2 * h)
        for a, b in ((1, 0), (0, 1))
    )
    skin = np.cross(by_u, by_v).reshape(mat.rows, 8, mat.columns, 8, 3).swapaxes(1, 2).reshape(*points.shape)
    p = sum(f.pressure(mat.segment, points[None])[frame] for f in recording.footprints) * 1e-3
    force = -np.einsum("rcn,rcnx,n->x", p, skin, weights)
    exact = recording.truth()
    assert force == pytest.approx(exact.force[frame], abs=1e-5 * exact.normal[frame])
    stretch = np.linalg.norm(skin, axis=-1) / mat.pitch**2
    least, most = STRETCH.get(mat.name, (0.97, 1.012))
    assert least < stretch.min() < stretch.max() < most, "the figures in meshes/README.md"


@each_recording
def test_shipped_truth_is_the_exact_resultant(recording):
    header, rows = shipped(recording, "truth.csv")
    exact = recording.truth()
    assert [h.strip() for h in header] == [
        "time [s]", *(f"f{a} [N]" for a in "xyz"), *(f"m{a} [N m]" for a in "xyz"), "normal [N]", "area [mm^2]",
        "peak [Pa]", *(f"cop_{a} [mm]" for a in "xyz"),
    ]  # fmt: skip
    assert rows[:, 0] == pytest.approx(recording.time)
    assert rows[:, 1:4] == pytest.approx(exact.force, abs=1e-6)
    assert rows[:, 4:7] == pytest.approx(exact.moment, abs=1e-7)
    assert rows[:, 7] == pytest.approx(exact.normal, abs=1e-6)
    assert rows[:, 8] == pytest.approx(exact.area, abs=1e-5)
    assert rows[:, 10:] == pytest.approx(exact.centre, abs=1e-6, nan_ok=True)
    idle = (recording.time <= 0.3) | (recording.time >= recording.time[-1] - 0.3)
    assert (rows[idle, 1:10] == 0).all()
    assert np.isnan(rows[idle, 10:]).all()
    assert rows[~idle, 7].min() > 0
    assert rows[:, 7].max() > 50


@each_recording
def test_shipped_readings_as_frames_of_a_mat(recording):
    """What an undistorted grid of 2 cm^2 cells makes of the recording; the rest is what draping has to find."""
    mat, cells = recording.mat, readings(recording, "frames.csv")
    frames = PressureFrames(
        recording.time,
        1e3 * cells,
        (mat.pitch * 1e-3, mat.pitch * 1e-3),
        np.ones((mat.rows, mat.columns), bool),
        np.full((mat.rows, mat.columns), 200e-6),
    )
    exact = recording.truth()
    loaded = exact.normal > 1
    assert frames.force[loaded] == pytest.approx(exact.normal[loaded], rel=5e-3)
    assert frames.force[~loaded] == pytest.approx(exact.normal[~loaded], abs=0.01)
    centres = mat.segment.points(mat.parameters(np.arange(mat.rows) + 0.5, np.arange(mat.columns) + 0.5))
    middle = np.einsum("trc,rcx->tx", cells[loaded], centres) / cells[loaded].sum(axis=(1, 2))[:, None]
    assert middle == pytest.approx(exact.centre[loaded], abs=0.2), "a mirrored mat is centimetres off"
    assert (cells.max(axis=(1, 2)) <= exact.peak * 1e-3 + 1e-3).all()


@each_recording
def test_variants_are_the_reading_rounded_and_spoiled_as_said(recording):
    cells, quantised = readings(recording, "frames.csv"), readings(recording, "frames_quantised.csv")
    assert quantised == pytest.approx(cells, abs=0.05 + 1e-3)
    assert quantised * 10 == pytest.approx(np.round(quantised * 10), abs=1e-9)
    faulty = readings(recording, "frames_faulty.csv")
    layout = tomllib.loads((FOLDER / recording.mat.name / "layout_faulty.toml").read_text(encoding="ascii"))
    number = np.arange(cells[0].size).reshape(cells[0].shape)
    offset = 0.2 + 0.6 * (0.6180339887498949 * number % 1.0)
    expected = np.minimum(cells + offset + DRIFT * recording.time[:, None, None], layout["saturation_kPa"])
    for i, j in layout["dead"]:
        expected[:, i, j] = 0.0
        assert cells[:, i, j].max() > 0, "a dead cell that matters"
    assert faulty == pytest.approx(expected, abs=0.05 + 1e-3)
    clipped = faulty >= layout["saturation_kPa"]
    assert clipped.any(axis=(1, 2)).sum() > 20
    assert clipped.sum() < 0.02 * clipped.size


@each_recording
def test_layout_says_what_the_mat_is(recording):
    layout = tomllib.loads((FOLDER / recording.mat.name / "layout.toml").read_text(encoding="ascii"))
    assert (layout["rows"], layout["columns"]) in {(16, 8), (32, 8)}
    assert (layout["rows"], layout["columns"]) == (recording.mat.rows, recording.mat.columns)
    assert layout["pitch_mm"] ** 2 == pytest.approx(200.0, rel=1e-14)
    assert (layout["unit"], layout["origin"], layout["order"]) == ("kPa", "top-left", "row")
    assert layout["saturation_kPa"] > readings(recording, "frames.csv").max()
    assert layout["rate_Hz"] == pytest.approx(1 / np.diff(recording.time))


@each_recording
def test_shipped_landmarks_lie_on_the_skin(recording):
    text = (FOLDER / recording.mat.name / "landmarks.csv").read_text(encoding="ascii").splitlines()
    assert text[0] == "id, row, column, x [mm], y [mm], z [mm]"
    rows = np.array([[float(x) for x in line.split(",")[1:]] for line in text[1:]])
    assert len(rows) == 9
    assert np.abs(recording.mat.segment.off_surface(rows[:, 2:])).max() < 1e-7, "1e-10 m"
    assert rows[:, :2] == pytest.approx(recording.mat.landmarks)
    assert rows[:, 2:] == pytest.approx(recording.mat.landmark_points(), abs=5.1e-8)


def test_the_thigh_is_pressed_on_its_front_and_pushed_back():
    exact = RECORDINGS[0].truth()
    busiest = np.argmax(exact.normal)
    assert RECORDINGS[0].mat.segment is THIGH
    assert exact.force[busiest, 0] < -0.9 * exact.normal[busiest]
    assert exact.centre[busiest, 0] > 70


def test_generator_reproduces_segments_and_recordings():
    files = mat_files()
    assert len(files) == 4 + 4 * 7
    assert differing(files, FOLDER) == []
    assert max(len(data) for name, data in files.items() if name.endswith(".stl")) < 400_000
    assert sum(len(data) for name, data in files.items() if "/" in name) < 1_000_000
