"""Distances at points that correspond: read where they are, compared as curves are."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.errors import InputError
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.mesh.particles import read_particles
from geocontact.study.statistics import sign_flips
from geocontact.study.surface import SurfaceValues, surface_difference_table, surface_fields, surface_table
from geocontact.view.surfaces.points_vtp import write_points_vtp
from tests.cli.calls import MESHES, Call, call

PARTICLES = np.array([[x, 0.0, z] for x in (-12.0, 0.0, 12.0) for z in (-9.0, 0.3, 9.0)])
"""On the upper face of the plate [mm], none of them a vertex."""


def written(file: Path, points: np.ndarray) -> Path:
    file.write_text("".join(f"{x}    {y}    {z}\n" for x, y, z in points.tolist()), encoding="utf-8")
    return file


def values(distance: np.ndarray, conditions: tuple[str, ...], at: tuple[float, ...] = (0.0, 100.0)) -> SurfaceValues:
    """Of subjects in the order of the rows, each once in every condition."""
    subjects = tuple(f"S{k}" for k in range(len(distance) // len(set(conditions))))
    points = np.zeros((distance.shape[2], 3))
    return SurfaceValues(points, at, tuple(np.repeat(subjects, len(set(conditions)))), conditions, distance)


def test_particles_are_read_in_their_order(tmp_path: Path) -> None:
    read = read_particles(written(tmp_path / "a.particles", PARTICLES), "mm")
    np.testing.assert_allclose(read, PARTICLES / 1e3, rtol=1e-15)
    for text, said in (("1 2 3\n1 2\n", "line 2: '1 2' is not a point"), ("1 nan 3", "line 1"), ("x y z\n", "line 1")):
        (tmp_path / "b.particles").write_text(text, encoding="utf-8")
        with pytest.raises(InputError, match=said):
            read_particles(tmp_path / "b.particles", "mm")


def test_means_and_differences_are_those_of_each_particle() -> None:
    """7 subjects, two conditions, two places, three particles of which the last is beyond reach for one subject."""
    rng = np.random.default_rng(8)
    distance = 1e-3 * rng.normal(2.0, 0.3, (14, 2, 3))
    distance[0::2, :, 0] += 1e-3
    distance[4, 0, 2] = np.nan
    v = values(distance, ("slow", "fast") * 7)
    table = surface_table(v)
    slow = table[(table["condition"] == "slow") & (table["cycle [%]"] == 0.0)]
    np.testing.assert_allclose(slow["distance_mean [mm]"], 1e3 * np.nanmean(distance[0::2, 0], axis=0), rtol=1e-12)
    np.testing.assert_allclose(slow["distance_sd [mm]"], 1e3 * np.nanstd(distance[0::2, 0], axis=0, ddof=1), rtol=1e-12)
    assert list(slow["subjects [-]"]) == [7, 7, 6] and list(slow["particle [-]"]) == [1, 2, 3]
    told = surface_difference_table(v)
    assert len(told) == 5, "five of six places have a value for everybody"
    flat = (distance[0::2] - distance[1::2]).reshape(7, -1)[:, [0, 1, 3, 4, 5]]
    expected = sign_flips(flat)
    np.testing.assert_allclose(told["p [-]"], expected.p, atol=1e-15)
    np.testing.assert_allclose(told["difference [mm]"], 1e3 * flat.mean(axis=0), rtol=1e-12)
    apart = told["particle [-]"] == 1
    assert (told["p [-]"][apart] <= 0.05).all() and (told["p [-]"][~apart] > 0.05).all()
    assert np.isnan(surface_fields(v)["slow - fast 0 %: p [-]"][2])


def test_false_findings_anywhere_on_the_surface_are_as_rare_as_promised() -> None:
    """200 surfaces of 30 particles, 8 subjects, no difference: 5 % ± 3 SD have p below 5 % anywhere."""
    rng = np.random.default_rng(11)
    found = [
        (surface_difference_table(values(rng.normal(size=(16, 1, 30)), ("a", "b") * 8, (50.0,)))["p [-]"] <= 0.05).any()
        for _ in range(200)
    ]
    assert abs(np.mean(found) - 12 / 256) < 3 * np.sqrt(0.05 * 0.95 / 200)


def test_points_are_what_vtk_reads(tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista", reason="the extra `view` is not installed")
    write_points_vtp(tmp_path / "a.vtp", PARTICLES / 1e3, {"mean <1> [mm]": np.r_[np.nan, np.arange(1.0, 9.0)]})
    read = pyvista.read(tmp_path / "a.vtp")
    np.testing.assert_allclose(read.points, PARTICLES, atol=1e-5)
    assert read.n_verts == 9
    np.testing.assert_array_equal(read["mean <1> [mm]"], np.r_[np.nan, np.arange(1.0, 9.0)].astype("f4"))


def balls(folder: Path, scheduler: str, *more: str) -> Call:
    """Three subjects, each with a plate and particles in a frame of their own; a ball comes 1 mm nearer (fast: 2)."""
    rng = np.random.default_rng(3)
    plate = read_mesh(MESHES / "plate_80x80x12.stl", unit="mm")
    for subject in "ABC":
        pose = RigidTransform.from_components([10.0, -20.0, 5.0] * rng.normal(size=3), Rotation.random(rng=rng))
        home = folder / subject
        home.mkdir()
        corners = pose.apply(1e3 * plate.vertices)[plate.faces]
        faces = "".join(
            "facet normal 0 0 0\nouter loop\n"
            + "".join(f"vertex {x} {y} {z}\n" for x, y, z in f)
            + "endloop\nendfacet\n"
            for f in corners.tolist()
        )
        (home / "plate.stl").write_text(f"solid plate\n{faces}endsolid plate\n", encoding="utf-8")
        written(home / "plate.particles", pose.apply(PARTICLES))
        for condition, nearer in (("slow", 1.0), ("fast", 2.0)):
            rows = ["time [s], tx [mm], ty [mm], tz [mm], qw, qx, qy, qz"]
            for k in range(2):
                x, y, z = pose.apply([0.0, 20.0 + 3.0 - k * nearer, 0.0]).tolist()
                rows.append(f"{k}, {x!r}, {y!r}, {z!r}, 1, 0, 0, 0")
            (home / f"{condition}.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    lines = [
        'analysis = "area"', 'files = "{subject}/{condition}.csv"', "[options]", f'moving = "{MESHES}/sphere_r20.stl"',
        'fixed = "{subject}/plate.stl"', 'unit = "mm"', 'motion = "{file}"', "threshold = 8", "save_map = true", *more,
    ]  # fmt: skip
    (folder / "study.toml").write_text("\n".join(lines).replace("\\", "/") + "\n", encoding="utf-8")
    return call(
        "cohort", folder / "study.toml", "--scheduler", scheduler, "--out", folder / "out", folder=folder / "out"
    )


SURFACE = ("[surface]", 'particles = "{subject}/plate.particles"', 'unit = "mm"', "at = [0, 50, 100]")


@pytest.mark.slow
def test_a_study_reads_distances_at_the_particles_of_each_subject(tmp_path: Path, scheduler: str) -> None:
    """Plane and sphere: the distance of a point of the plane from the ball is known, whatever frame the subject has."""
    done = balls(tmp_path, scheduler, *SURFACE)
    assert done.code == 0, done.err
    table = done.table("surface.csv")
    for condition, nearer in (("slow", 1.0), ("fast", 2.0)):
        for at, height in ((0.0, 3.0), (100.0, 3.0 - nearer)):
            own = table[(table["condition"] == condition) & (table["cycle [%]"] == at)]
            exact = np.hypot(np.hypot(PARTICLES[:, 0], PARTICLES[:, 2]), 20.0 + height) - 20.0
            np.testing.assert_allclose(own["distance_mean [mm]"], exact, atol=0.25)
            assert (own["distance_sd [mm]"] < 0.02).all(), "facets of the ball lie otherwise in each subject's frame"
            assert (own["subjects [-]"] == 3).all()
    assert "distance at 9 particles, fast against slow: 3 subjects cannot show a difference" in done.out
    differences = pd.read_csv(tmp_path / "out" / "surface_differences.csv")
    assert len(differences) == 27 and (tmp_path / "out" / "surface.vtp").is_file()
    assert differences["difference [mm]"].min() == pytest.approx(-1.0, abs=0.05)

    text = (tmp_path / "study.toml").read_text(encoding="utf-8")
    for odd, new, said in (
        ('unit = "mm"\nat', 'unit = "cm"\nat', "mm off the mesh; give the local particles of this mesh"),
        ("{subject}/plate.particles", "{who}/plate.particles", "no trial has {who}"),
        ("save_map = true", "save_map = false", "[surface]: needs the distances of every vertex"),
        ('unit = "mm"\nat', 'unit = "furlong"\nat', "[surface] unit: 'furlong' is none of length"),
        ("at = [0, 50, 100]", "at = [120]", "[surface] at: [120] are not places"),
    ):
        (tmp_path / "study.toml").write_text(text.replace(odd, new), encoding="utf-8")
        refused = call("cohort", tmp_path / "study.toml", "--scheduler", scheduler, "--out", tmp_path / "out")
        assert refused.code == 2 and said in refused.err, refused.err
