"""Shapes fitted from Python: rods, balls, cups and plates of the samples, patches, sides, radius over flexion."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import t as student

import geocontact as gc
from geocontact.analyses.shape.result import ShapeResult
from geocontact.data.errors import InputError, InputWarning
from geocontact.geometry.fit.cylinder import fit_cylinder
from tests.cli.calls import in_metres

MESHES = Path(__file__).resolve().parents[3] / "meshes"
CYLINDER, SPHERE, CUP, PLATE, FEMUR, FINER = (
    MESHES / f"{name}.stl"
    for name in (
        "cylinder_r15_l40",
        "sphere_r20",
        "cup_r24",
        "plate_80x80x12",
        "femoral_component_right_coarse",
        "femoral_component_right_medium",
    )
)
KNEE = {"axis": "0,0,0,0,0,1", "sagittal": "-y,-x", "region": "outward>0.5 and -40<flexion<150"}


def along() -> int:
    """The coordinate along which the sample rod lies."""
    return int(np.argmax(np.ptp(gc.read_mesh(CYLINDER, "mm").vertices, axis=0)))


def wall() -> str:
    """The faces of the rod's wall."""
    return f"abs(n{'xyz'[along()]})<0.5"


def fit(mesh: Path, shape: str, unit: str = "mm", **options: object) -> ShapeResult:
    """`gc.fit_shape`, of meshes in mm."""
    return gc.fit_shape(mesh, shape=shape, unit=unit, **options)


def test_a_rod() -> None:
    result = fit(CYLINDER, "cylinder", region=wall())
    assert result.fit.radius == pytest.approx(15e-3, abs=1e-7)  # corners of the facets lie on the rod
    assert result.fit.axis is not None
    assert np.abs(result.fit.axis) == pytest.approx(np.eye(3)[along()], abs=1e-7)
    assert result.fitting.facing == "convex" and result.fit.quality.inlier.all() and result.fit.arc > np.radians(340)
    (row,) = result.table().to_dict("records")
    assert row["side"] == "whole" and row["radius [mm]"] == pytest.approx(15.0, abs=1e-4)
    low, high = result.fit.radius_interval or (np.nan, np.nan)
    assert (row["radius_lower [mm]"], row["radius_upper [mm]"]) == (low * 1e3, high * 1e3)


def test_says_what_was_found() -> None:
    result = fit(CYLINDER, "cylinder", region=wall())
    count = len(result.fit.quality.residual)
    assert str(result).startswith("cylinder_r15_l40.stl: cylinder, radius 15.000 mm (95 % 15.000 … 15.000), rms 0.000")
    assert str(result).endswith(f"over {count} points, {count} of them inliers")
    assert result.record.results["fit"]["radius_mm"] == result.fit.radius * 1e3


@pytest.mark.slow
def test_the_ends_of_a_rod_are_outliers_of_its_wall() -> None:
    """Without a region: caps and all."""
    with (
        pytest.warns(gc.InputWarning, match="does not describe this patch"),
        pytest.warns(gc.InputWarning, match="74% of the points lie on the cylinder exactly"),
    ):
        robust, plain = fit(CYLINDER, "cylinder"), fit(CYLINDER, "cylinder", robust=False)
    assert robust.fit.radius == pytest.approx(15e-3, abs=1e-6) and not robust.fit.quality.inlier.all()
    assert plain.fit.radius is not None and abs(plain.fit.radius - 15e-3) > 1e-4


def test_units_and_placement(tmp_path: Path) -> None:
    place = tmp_path / "place.txt"
    place.write_text("1 0 0 1\n0 1 0 -2\n0 0 1 3\n0 0 0 1\n", encoding="utf-8")
    here, there = (fit(SPHERE, "sphere", **options).fit for options in ({}, {"place": place}))
    with pytest.warns(gc.InputWarning, match="radius: 200 mm is unusual"):
        larger = fit(SPHERE, "sphere", unit="cm").fit
    assert here.radius == pytest.approx(20e-3, abs=1e-7) and here.axis is None
    assert there.point - here.point == pytest.approx([1e-3, -2e-3, 3e-3], abs=1e-7)
    assert larger.radius == pytest.approx(10.0 * here.radius, rel=1e-9)
    centroids = fit(SPHERE, "sphere", points="faces").fit.radius
    assert 19.5e-3 < centroids < here.radius - 1e-6, "centroids of facets lie below the sphere"


@pytest.mark.slow
def test_inside_and_outside_of_a_cup_by_centre_and_by_the_ball_in_it(tmp_path: Path) -> None:
    ball = fit(SPHERE, "sphere").write(tmp_path / "ball") / "fit.json"
    cavity = fit(CUP, "sphere", centre=ball, region="outward<-0.9")
    back = fit(CUP, "sphere", centre="0,0,0", region="outward>0.9")
    near = fit(CUP, "sphere", other=SPHERE, region="distance<4.5")
    assert (cavity.fitting.facing, back.fitting.facing) == ("concave", "convex")
    radii = [each.fit.radius for each in (cavity, back, near)]
    assert radii == pytest.approx([24e-3, 29e-3, 24e-3], abs=1e-6)


def test_the_other_mesh_may_be_in_a_unit_of_its_own(tmp_path: Path) -> None:
    """The distance stays in the unit of the mesh that is fitted."""
    region = "distance<4.5"
    near = fit(CUP, "sphere", other=SPHERE, region=region)
    apart = fit(CUP, "sphere", other=in_metres(tmp_path, SPHERE), unit_other="m", region=region)
    assert apart.fit.radius == near.fit.radius == pytest.approx(24e-3, abs=1e-6)
    with pytest.raises(InputError, match="`unit_other`: has no effect without `other`"):
        fit(CUP, "sphere", unit_other="m")


def test_a_plate() -> None:
    """The upper face of the plate, and the two together, which are none."""
    top = fit(PLATE, "plane", region="ny>0.9")
    assert top.fit.radius is None and top.fit.radius_interval is None and top.fitting.facing is None
    assert top.fit.axis is not None and np.abs(top.fit.axis) == pytest.approx([0, 1, 0], abs=1e-9)
    assert top.fit.rms < 1e-7 and np.isnan(top.table()["radius [mm]"].item())


@pytest.mark.slow
def test_radius_by_side_and_by_flexion() -> None:
    """The synthetic femoral component: distal radius 34, posterior 22, about the axis through its origin."""
    result = fit(FINER, "cylinder", **KNEE, split="z", side="right", profile=gc.deg(-20, 100, 20))
    table = result.table("profile")
    assert list(result.sides) == list(result.profiles) == ["medial", "lateral"]
    assert list(result.table()["side"]) == ["whole", "medial", "lateral"]
    for side in result.sides.values():
        np.testing.assert_array_equal(side.axis, result.fit.axis)
    points, counted = (sum(len(f.quality.residual) for f in fits) for fits in ([result.fit], result.sides.values()))
    assert points <= counted <= points + 200, "points on the plane are on both sides"
    (low, high), q = result.fit.radius_interval or (np.nan, np.nan), result.fit.quality
    radius = q.names.index("radius [m]")
    half = student.ppf(0.975, 15) * np.sqrt(q.covariance[radius][radius])
    assert 0.5 * (high - low) == pytest.approx(half, rel=1e-3)
    assert low < result.fit.radius < high and 22e-3 < result.fit.radius < 34e-3
    assert list(table["flexion [deg]"]) == pytest.approx([*range(-20, 101, 20)] * 2)
    medial = table[table["side"] == "medial"].set_index(table["flexion [deg]"].round()[table["side"] == "medial"])
    assert medial.loc[0, "radius [mm]"] == pytest.approx(34, rel=0.01)
    assert medial.loc[80, "radius [mm]"] == pytest.approx(22, rel=0.01)
    assert (medial["crest_z [mm]"] < 0).all() and (table[table["side"] == "lateral"]["crest_z [mm]"] > 0).all()
    middle = 0.5 * (table["radius_upper [mm]"] + table["radius_lower [mm]"])
    np.testing.assert_allclose(middle, table["radius [mm]"], rtol=1e-12)
    right = fit(FINER, "cylinder", **KNEE, split="z", medial="+")
    assert right.sides["lateral"].radius == result.sides["medial"].radius


@pytest.mark.slow
def test_profile_of_the_coarse_component_about_the_axis_of_the_fit() -> None:
    region = {key: KNEE[key] for key in ("axis", "region", "sagittal")}
    narrow, wide = (
        fit(FEMUR, "cylinder", **region, profile=gc.deg(0, 80, 40), window=window) for window in (None, gc.deg(60))
    )
    assert list(narrow.profiles) == ["whole"] and narrow.table("profile")["radius [mm]"].notna().all()
    assert narrow.table("profile")["radius [mm]"][0] == pytest.approx(34, rel=0.05)
    assert wide.table("profile")["radius_lower [mm]"][0] != narrow.table("profile")["radius_lower [mm]"][0]


def test_an_axis_that_is_held() -> None:
    """The wall of a rod seen a little askew: the radius of its section grows, and the axis is the one given."""
    way = np.roll([1.0, 0.1, 0.0], along())
    given = ",".join(map(str, [0, 0, 0, *way]))
    held = fit(CYLINDER, "cylinder", axis=given, hold_axis=True, region=wall()).fit
    assert held.axis == pytest.approx(way / np.linalg.norm(way), abs=1e-12)
    assert held.rms > 0.3e-3 and held.quality.names == ("shift_u [m]", "shift_v [m]", "radius [m]")


def test_a_file_of_faces(tmp_path: Path) -> None:
    file = tmp_path / "faces.txt"
    file.write_text("\n".join(map(str, range(0, 900, 3))), encoding="utf-8")
    result = fit(SPHERE, "sphere", region=file)
    assert result.fitting.patch.faces.sum() == 300 and result.fit.radius == pytest.approx(20e-3, abs=1e-7)
    assert [entry["role"] for entry in result.record.inputs] == ["mesh", "`region`"]


@pytest.mark.slow
def test_a_file_that_names_the_axis_is_noted_once(tmp_path: Path) -> None:
    axis = fit(FEMUR, "cylinder", **KNEE).write(tmp_path / "axis") / "fit.json"
    assert json.loads(axis.read_text(encoding="utf-8"))["shape"] == "cylinder"
    again = fit(FEMUR, "cylinder", axis=axis, hold_axis=True, region="outward>0.5")
    assert 20e-3 < again.fit.radius < 40e-3
    assert [entry["role"] for entry in again.record.inputs] == ["mesh", "`axis`"]


def test_doubts_are_said_and_kept() -> None:
    with pytest.warns(InputWarning, match="degrees about the axis") as said:
        flat = fit(SPHERE, "cylinder", region="abs(z)<4 and y>18")
    assert [str(each.message) for each in said] == list(flat.warnings)
    assert f"warning: {flat.warnings[0]}" in str(flat)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"axis": "0,0,0,0,0,1", "region": "x>0"}, "`axis`: has no effect here: `region` does not speak of radial"),
        ({"medial": "+"}, "`medial`: has no effect without `split`"),
        ({"split": "z"}, "`split`: 'z' does not say which side of the plane is medial"),
        ({"split": "z", "side": "left", "medial": "+"}, "`medial`: with `side` says twice what is medial"),
        ({"window": 0.3}, "`window`: has no effect without `profile`"),
        (
            {"profile": (0.0, 1.0, 0.1), "window": 4.0},
            "`window`: 229.183 deg cannot be a window of flexion: that is 1 to 180 deg; is 4 deg meant?",
        ),
        ({"profile": (0.0, 1.0, -0.1)}, "`profile`: never arrives"),
        ({"profile": (0.0, 1.0, 0.0)}, "`profile`: never arrives"),
        ({"shape": "cone"}, "`shape`: 'cone' is not a choice; one of cylinder, sphere, plane"),
    ],
)
def test_refused_before_a_file_is_read(options: dict[str, object], words: str) -> None:
    with pytest.raises(InputError) as refused:
        gc.fit_shape("none.stl", **{"shape": "cylinder", "unit": "mm", **options})
    assert words in str(refused.value)


def test_a_region_that_lacks_an_option_names_it_as_python_has_it() -> None:
    with pytest.raises(InputError, match="`region`: flexion needs `axis` and `sagittal`"):
        fit(CYLINDER, "cylinder", region="flexion>3")
    with pytest.raises(InputError, match="`shape` sphere: lateral: a sphere needs at least 5 points, not 0"):
        fit(SPHERE, "sphere", split="z=100", side="right")


def test_a_shape_that_does_not_describe_the_patch_is_told() -> None:
    sphere = MESHES / "sphere_r20.stl"
    with pytest.warns(gc.InputWarning, match="27% of the radius: a cylinder does not describe this patch"):
        gc.fit_shape(sphere, unit="mm", shape="cylinder")


def stem(share: float) -> np.ndarray:
    """Points of a rod of 7 mm, exact, and a share of them on a cone that it widens to."""
    rng = np.random.default_rng(5)
    count, wide = 4000, int(share * 4000)
    turn, along_it = rng.uniform(0.0, 2.0 * np.pi, count), rng.uniform(0.0, 0.1, count)
    radius = np.full(count, 7e-3)
    radius[:wide] += 0.25 * rng.uniform(0.01, 0.05, wide)
    along_it[:wide] += 0.1
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), along_it])


@pytest.mark.parametrize(("share", "exact"), [(0.2, True), (0.0, False), (0.04, False)])
def test_a_part_that_is_exact_gives_no_interval_for_the_whole(share: float, exact: bool) -> None:
    fit = fit_cylinder(stem(share))
    assert fit.radius == pytest.approx(7e-3, rel=1e-6)
    assert (fit.exact_in_part, fit.radius_interval is None) == (exact, exact)


def test_scatter_on_the_shape_keeps_its_interval_beside_outliers() -> None:
    points = stem(0.2) + np.random.default_rng(6).normal(0.0, 50e-6, (4000, 3))
    low, high = fit_cylinder(points).radius_interval or (np.nan, np.nan)
    assert low < high
    assert not fit_cylinder(points).exact_in_part


def stem_file(folder: Path) -> Path:
    """The same as a surface of revolution [mm]: 60 % of its rings on the rod."""
    rings = [(7.0, z) for z in np.linspace(0.0, 60.0, 31)] + [(7.0 + 0.3 * z, 60.0 + z) for z in range(2, 41, 2)]
    turns = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
    lines = [f"v {r * np.cos(t)} {r * np.sin(t)} {z}" for r, z in rings for t in turns]
    for ring in range(len(rings) - 1):
        for k in range(48):
            a, b = 48 * ring + k + 1, 48 * ring + (k + 1) % 48 + 1
            lines += [f"f {a} {b} {b + 48}", f"f {a} {b + 48} {a + 48}"]
    file = folder / "stem.obj"
    file.write_text("\n".join(lines), encoding="utf-8")
    return file


def test_a_part_that_is_exact_is_told(tmp_path: Path) -> None:
    with pytest.warns(InputWarning) as heard:
        result = gc.fit_shape(stem_file(tmp_path), unit="mm", shape="cylinder")
    assert any("of the points lie on the cylinder exactly" in str(w.message) for w in heard)
    assert "radius 7.000 mm, rms" in str(result) and "95 %" not in str(result)
    assert "95 % interval" not in json.dumps(json.loads((result.write(tmp_path / "out") / "fit.json").read_text()))
