"""Muscles of a shipped leg through `geocontact id --muscles`: paths by hand, files, and what is refused."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.motion.inverse_dynamics import muscles
from geocontact.analyses.motion.inverse_dynamics.result import IdResult
from geocontact.data.errors import InputError, InputWarning
from geocontact.io.opensim import muscle_paths
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.text.tables import read_table
from tests.cli.calls import MESHES
from tests.elsewhere import Elsewhere

MUSCLE = """<Thelen2003Muscle name="{name}"><max_isometric_force>{strength}</max_isometric_force>
<GeometryPath><PathPointSet><objects><PathPoint name="{name}-1">
<socket_parent_frame>/bodyset/femur_r</socket_parent_frame>
<location>{origin}</location></PathPoint><PathPoint name="{name}-2">
<socket_parent_frame>/bodyset/tibia_r</socket_parent_frame><location>{insertion}</location></PathPoint></objects>
</PathPointSet></GeometryPath></Thelen2003Muscle>"""
PLACES = {"extensor": ((0.05, -0.1, 0.0), (0.05, -0.05, 0.0)), "flexor": ((-0.05, -0.1, 0.0), (-0.04, -0.06, 0.01))}
STRENGTH = {"extensor": 5000.0, "flexor": 3000.0}


def muscular(folder: Path) -> Path:
    """The shipped leg with two straight muscles across its knee."""
    places = {name: [" ".join(map(str, place)) for place in pair] for name, pair in PLACES.items()}
    muscles = [
        MUSCLE.format(name=name, strength=STRENGTH[name], origin=one, insertion=other)
        for name, (one, other) in places.items()
    ]
    text = (MESHES / "leg.osim").read_text(encoding="utf-8")
    end = "</Model>"
    assert text.count(end) == 1
    file = folder / "muscular.osim"
    file.write_text(text.replace(end, f"<ForceSet><objects>{''.join(muscles)}</objects></ForceSet>{end}"), "utf-8")
    return file


def asked(model: Path, **options: object) -> IdResult:
    """Moments and muscles of the shipped motion."""
    return gc.inverse_dynamics(MESHES / "leg_swing.mot", model=model, muscles=True, **options)


def estimated(model: Path, **options: object) -> IdResult:
    """The same: there are no plates, which is warned of."""
    with pytest.warns(InputWarning):
        return asked(model, **options)


def test_arms_and_directions_are_those_of_straight_lines(tmp_path: Path, opensim: Elsewhere) -> None:
    """By hand: from insertion q to origin p the pull is (p - q)/|p - q|; arms by virtual work."""
    file, table = muscular(tmp_path), read_table(MESHES / "leg_swing.mot")
    model = read_multibody(file)
    names = [c.name for c in model.coordinates]
    turning = np.array([c.kind == "rotational" for c in model.coordinates])
    values = np.column_stack([table.column(name) for name in names])[::25]
    values = np.where(turning, np.radians(values), values)
    found = muscle_paths.muscle_paths(file, names, values, ("tibia_r", "foot_r"))
    assert found.names == ("extensor", "flexor") and found.strongest == pytest.approx([5000.0, 3000.0])

    def lines(q: np.ndarray) -> np.ndarray:
        poses = model.poses(q)
        ends = [
            [poses[b].apply(np.array(x)) for b, x in zip(("femur_r", "tibia_r"), PLACES[n], strict=True)]
            for n in PLACES
        ]
        return np.array([one - other for one, other in ends])  # (m, t, 3)

    along = lines(values)
    length = np.linalg.norm(along, axis=2)
    np.testing.assert_allclose(found.pulls, np.moveaxis(along / length[..., None], 0, 1), atol=1e-9)
    k, step = names.index("knee"), 1e-6
    ahead, behind = values.copy(), values.copy()
    ahead[:, k] += step
    behind[:, k] -= step
    slope = (np.linalg.norm(lines(ahead), axis=2) - np.linalg.norm(lines(behind), axis=2)) / (2.0 * step)
    np.testing.assert_allclose(found.arms[:, :, k], -slope.T, atol=1e-7)


def test_muscles_and_contact_are_files_of_the_command(tmp_path: Path, opensim: Elsewhere) -> None:
    """The knee alone is driven; contact held at twice what muscles make is met by both of them together."""
    model = muscular(tmp_path)
    first = estimated(model, across="tibia_r")
    contact = first.table("contact")
    held = pd.DataFrame({"time [s]": contact["time [s]"], "total [N]": contact["muscles_alone [N]"] + 300.0})
    held.to_csv(tmp_path / "held.csv", index=False)
    result = estimated(model, across="tibia_r", held=tmp_path / "held.csv")
    result.write(tmp_path / "out")
    written = pd.read_csv(tmp_path / "out" / "contact.csv")
    np.testing.assert_allclose(written["held [N]"], held["total [N]"], rtol=2e-3)
    muscles = pd.read_csv(tmp_path / "out" / "muscles.csv")
    moment = result.moments["knee_moment"]
    more = muscles[["extensor_force [N]", "flexor_force [N]"]].sum(axis=1)
    less = first.table("muscles")[["extensor_force [N]", "flexor_force [N]"]].sum(axis=1)
    assert (more > less + 250.0).all() and np.abs(moment).max() > 1.0
    assert result.muscles is not None and result.muscles.driven == ("knee",)
    assert any("squared activations" in line for line in result.sentences)
    assert "Compression of the joint of tibia_r" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


def test_what_cannot_be_answered_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, opensim: Elsewhere
) -> None:
    with pytest.raises(InputError, match="no body 'patella'"):
        asked(muscular(tmp_path), across="patella")
    with pytest.raises(InputError, match="no muscle crosses the joint of foot_r"):
        asked(muscular(tmp_path), across="foot_r")
    with pytest.raises(InputError, match="has no muscles"):
        asked(MESHES / "leg.osim")
    late = tmp_path / "late.csv"
    late.write_text("time [s],total [N]\n9,100\n10,100\n", encoding="utf-8")
    with pytest.raises(InputError, match="no frame of the motion lies in its time"):
        asked(muscular(tmp_path), across="tibia_r", held=late)


def test_the_extra_is_named_before_anything_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(muscle_paths, "find_spec", lambda name: None)
    (tmp_path / "empty.osim").touch()
    with pytest.raises(InputError, match=r"needs the opensim package; pip install 'geocontact\[muscles\]' \(Python"):
        asked(tmp_path / "empty.osim")


def test_a_contact_force_without_muscles_is_refused() -> None:
    with pytest.raises(InputError, match="`across`"):
        gc.inverse_dynamics(MESHES / "leg_swing.mot", model=MESHES / "leg.osim", across="tibia_r")


def by_hand(
    names: tuple[str, ...], arms: dict[tuple[int, str], float], pulls: dict[int, float]
) -> Callable[..., object]:
    """Constant arms [m] by muscle and coordinate, pulls along the ground's y, in place of the opensim package."""

    def paths(model: Path, coordinates: list[str], values: np.ndarray, beyond: tuple[str, ...]) -> object:
        found = np.zeros((len(values), len(names), len(coordinates)))
        for (m, name), arm in arms.items():
            found[:, m, coordinates.index(name)] = arm
        pull = np.zeros((len(values), len(names), 3))
        for m, size in pulls.items():
            pull[:, m, 1] = size
        return muscle_paths.MusclePaths(names, np.full(len(names), 3000.0), found, pull)

    return paths


def said(model: Path, **options: object) -> tuple[IdResult, str]:
    """The result and all warnings."""
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        result = asked(model, **options)
    return result, " ".join(str(each.message) for each in seen)


TWO = by_hand(("front", "behind"), {(0, "knee"): 0.04, (1, "knee"): -0.04, (1, "ankle"): -0.03}, {0: 1.0, 1: 1.0})


def changed(folder: Path, old: str, new: str) -> Path:
    """The shipped leg with another text at one place."""
    text = (MESHES / "leg.osim").read_text(encoding="utf-8")
    assert text.count(old) == 1
    (folder / "changed.osim").write_text(text.replace(old, new), encoding="utf-8")
    return folder / "changed.osim"


def test_a_locked_coordinate_is_left_to_its_lock(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(muscles, "muscle_paths", TWO)
    free, _ = said(MESHES / "leg.osim")
    file = changed(
        tmp_path, '<Coordinate name="ankle"/>', '<Coordinate name="ankle"><locked>true</locked></Coordinate>'
    )
    locked, _ = said(file)
    assert free.muscles is not None and free.muscles.driven == ("knee", "ankle")
    assert locked.muscles is not None and locked.muscles.driven == ("knee",)


def test_the_y_axis_is_that_of_the_leg_or_warned_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same leg with x along its shank; a centre 40 degrees off is still along -y."""
    monkeypatch.setattr(muscles, "muscle_paths", TWO)
    tibia = '<Body name="tibia_r"><mass>4.0</mass><mass_center>0 -0.15 0</mass_center>'
    for place, warned in (("0 -0.15 0", False), ("0.12 -0.15 0", False), ("-0.15 0 0", True), ("0 0.15 0", True)):
        model = changed(tmp_path, tibia, tibia.replace("0 -0.15 0", place))
        _, words = said(model, across="tibia_r")
        assert ("compression is along the y axis, does that point to the joint?" in words) == warned, place


def test_a_muscle_on_a_patella_has_no_compression_in_silence(monkeypatch: pytest.MonkeyPatch) -> None:
    """It turns the knee and pulls at nothing below it; one that turns the ankle alone is not meant."""
    arms = {(0, "knee"): 0.04, (1, "knee"): -0.04, (2, "ankle"): 0.04}
    monkeypatch.setattr(muscles, "muscle_paths", by_hand(("rectus", "biceps", "soleus"), arms, {1: 1.0}))
    _, words = said(MESHES / "leg.osim", across="tibia_r")
    assert "rectus turn the joint of tibia_r from a body beside it" in words
    monkeypatch.setattr(muscles, "muscle_paths", by_hand(("rectus", "biceps", "soleus"), arms, {0: 1.0, 1: 1.0}))
    _, words = said(MESHES / "leg.osim", across="tibia_r")
    assert "from a body beside it" not in words


def test_moments_of_coupled_coordinates_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The ankle as a function of the knee: it is not driven, and its moment is not in the knee's."""
    monkeypatch.setattr(muscles, "muscle_paths", TWO)
    line = "<LinearFunction><coefficients>0.5 0</coefficients></LinearFunction>"
    constraint = (
        f"<CoordinateCouplerConstraint name='c'><coupled_coordinates_function>{line}</coupled_coordinates_function>"
        "<independent_coordinate_names>knee</independent_coordinate_names>"
        "<dependent_coordinate_name>ankle</dependent_coordinate_name></CoordinateCouplerConstraint>"
    )
    end = "</JointSet>"
    model = changed(tmp_path, end, f"{end}<ConstraintSet><objects>{constraint}</objects></ConstraintSet>")
    result, words = said(model)
    assert result.muscles is not None and result.muscles.driven == ("knee",)
    assert "moments along ankle, functions of others, are not passed on" in words
    assert "not passed on" not in said(MESHES / "leg.osim")[1]


def test_a_gap_of_the_measured_force_is_not_bridged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Samples of every 10 ms but for the middle third: nothing is held there, and a force that cannot be is missed."""
    monkeypatch.setattr(muscles, "muscle_paths", TWO)
    time = read_table(MESHES / "leg_swing.mot").time
    low, high = np.quantile(time, (1.0 / 3.0, 2.0 / 3.0))
    own = np.arange(time[0], time[-1] + 0.005, 0.01)
    own = own[(own < low) | (own > high)]
    pd.DataFrame({"time [s]": own, "total [N]": 9e3}).to_csv(tmp_path / "held.csv", index=False)
    result, words = said(MESHES / "leg.osim", across="tibia_r", held=tmp_path / "held.csv")
    contact = result.table("contact")
    gap = (contact["time [s]"] > low + 0.01) & (contact["time [s]"] < high - 0.01)
    assert gap.sum() > 5 and contact["measured [N]"][gap].isna().all()
    assert (contact["measured [N]"][~gap] == 9e3).mean() > 0.8
    assert "lie outside its time or in gaps: muscles alone there" in words
    assert "contact held: the measured force is missed by up to" in words


def test_a_frame_that_cannot_be_solved_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(*_: object) -> None:
        raise ValueError("frame 3: iterations")

    monkeypatch.setattr(muscles, "muscle_paths", TWO)
    monkeypatch.setattr(muscles, "static_optimisation", stopped)
    warnings.simplefilter("ignore", InputWarning)
    with pytest.raises(InputError, match=r"leg_swing\.mot `muscles`: frame 3: iterations"):
        asked(MESHES / "leg.osim")
