"""Coordinates that depend on others follow them in ik, markers and id, as in OpenSim."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError
from geocontact.data.multibody.joint import Affine
from geocontact.data.multibody.markers import MarkerTasks, MarkerTrajectories
from geocontact.dynamics.inverse_kinematics import inverse_kinematics
from geocontact.dynamics.scaling import scaled
from geocontact.dynamics.tree import Tree, tree_of
from geocontact.io.mocap.trc import write_trc
from geocontact.io.opensim.coordinates import motion_of
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.opensim.osim_scaler import write_scaled_model
from geocontact.io.text.tables import read_table
from meshes.leg_files import leg_model
from tests import opensim_oracle
from tests.cli.calls import MESHES
from tests.elsewhere import Elsewhere

SPLINE = "<SimmSpline><x>-1.5 -0.8 0 0.4</x><y>0.6 0.2 -0.1 -0.3</y></SimmSpline>"
LINE = "<LinearFunction><coefficients>0.5 0.1</coefficients></LinearFunction>"


def coupler(name: str, dependent: str, of: str, function: str, factor: float = 1.0) -> str:
    return f"""<CoordinateCouplerConstraint name="{name}"><coupled_coordinates_function>{function}
</coupled_coordinates_function><independent_coordinate_names>{of}</independent_coordinate_names>
<dependent_coordinate_name>{dependent}</dependent_coordinate_name><scale_factor>{factor}</scale_factor>
</CoordinateCouplerConstraint>"""


def coupled_leg(folder: Path, *couplers: str) -> Path:
    """The shipped leg; the first coupler depends on what the second sets."""
    each = couplers or (coupler("b", "hip_x", "ankle", LINE), coupler("a", "ankle", "knee", SPLINE, 2.0))
    constraints = f"<ConstraintSet><objects>{''.join(each)}</objects></ConstraintSet>"
    file = folder / "leg.osim"
    file.write_text(leg_model().replace("BallJoint", "GimbalJoint").replace("<MarkerSet>", f"{constraints}<MarkerSet>"))
    return file


def noisy(tree: Tree) -> MarkerTrajectories:
    """Markers of the shipped swing, which knows nothing of the couplers, and 5 mm of noise."""
    table = read_table(MESHES / "leg_swing.mot")
    values = motion_of(table, replace(tree.model, couplers=()), None)[::20]
    places = tree.model.marker_places(values)
    places += np.random.default_rng(2).normal(0.0, 5e-3, places.shape)
    return MarkerTrajectories(table.time[::20], places, tuple(m.name for m in tree.model.markers))


def column(tree: Tree, values: np.ndarray, name: str) -> np.ndarray:
    return np.asarray(values[:, tree.names.index(name)])


def test_dependent_coordinates_follow_and_nothing_fits_better(tmp_path: Path) -> None:
    tree = tree_of(read_multibody(coupled_leg(tmp_path)))
    assert [c.dependent for c in tree.model.couplers] == ["ankle", "hip_x"]
    seen = noisy(tree)
    found = inverse_kinematics(tree, seen, MarkerTasks(dict.fromkeys(seen.names, 1.0)))
    spline = tree.model.couplers[0].function
    ankle = spline(column(tree, found.values, "knee")[:, None])
    np.testing.assert_allclose(column(tree, found.values, "ankle"), ankle, atol=1e-12)
    np.testing.assert_allclose(column(tree, found.values, "hip_x"), 0.5 * ankle + 0.1, atol=1e-12)
    assert found.settled.all()

    def cost(values: np.ndarray) -> float:
        return float(((tree.model.marker_places(tree.model.coupled(values)) - seen.positions) ** 2).sum())

    least = cost(found.values)
    for direction in np.random.default_rng(3).normal(0.0, 1e-3, (8, *found.values.shape)):
        assert cost(found.values + direction) > least


def test_angles_are_those_of_opensim(tmp_path: Path, opensim: Elsewhere) -> None:
    file = coupled_leg(tmp_path)
    tree = tree_of(read_multibody(file))
    seen = noisy(tree)
    write_trc(tmp_path / "noisy.trc", seen)
    weights = dict.fromkeys(seen.names, 1.0)
    ours = inverse_kinematics(tree, seen, MarkerTasks(weights)).values
    given = (file, tmp_path / "noisy.trc", weights, {}, seen.time.tolist(), tree.names, 1e-9)
    _, theirs = opensim(opensim_oracle.inverse_kinematics, *given)
    assert np.degrees(np.abs(ours - theirs)).max() < 0.01


def test_what_no_marker_tells_follows_too(tmp_path: Path) -> None:
    """No marker on the foot: the knee tells the ankle. A column that a motion lacks is filled alike."""
    tree = tree_of(read_multibody(coupled_leg(tmp_path)))
    seen = noisy(tree)
    legs = {name: 1.0 for name in seen.names if not name.startswith("foot")}
    found = inverse_kinematics(tree, seen, MarkerTasks(legs))
    assert found.determined.all()
    assert np.ptp(column(tree, found.values, "ankle")) > 0.3
    lines = (MESHES / "leg_swing.mot").read_text().replace("\tankle", "\tother")
    (tmp_path / "short.mot").write_text(lines)
    values = motion_of(read_table(tmp_path / "short.mot"), tree.model, None)
    knee = column(tree, values, "knee")[:, None]
    np.testing.assert_array_equal(column(tree, values, "ankle"), tree.model.couplers[0].function(knee))


def test_what_no_marker_tells_of_the_others_is_not_told_of_them(tmp_path: Path) -> None:
    tree = tree_of(read_multibody(coupled_leg(tmp_path, coupler("a", "ankle", "knee", SPLINE))))
    seen = noisy(tree)
    high = {name: 1.0 for name in seen.names if name.startswith(("pelvis", "femur"))}
    found = inverse_kinematics(tree, seen, MarkerTasks(high))
    untold = [name for name, known in zip(tree.names, found.determined.T, strict=True) if not known.any()]
    assert untold == ["knee", "ankle"]


def test_a_shift_that_depends_on_an_angle_grows_with_its_parent(tmp_path: Path) -> None:
    """As in OpenSim, for factors that are the same along all axes; the file that is written says the same."""
    file = coupled_leg(tmp_path, coupler("a", "slide", "knee", LINE, 2.0), coupler("b", "hip_x", "knee", LINE))
    text = file.read_text().replace('<PinJoint name="ankle_r">', '<SliderJoint name="ankle_r">')
    head, tail = text.split('<SliderJoint name="ankle_r">')
    tail = tail.replace("</PinJoint>", "</SliderJoint>", 1).replace(
        'Coordinate name="ankle"', 'Coordinate name="slide"'
    )
    file.write_text(f'{head}<SliderJoint name="ankle_r">{tail}')
    generic = read_multibody(file)
    factors = {"tibia_r": np.full(3, 1.2)}
    larger = scaled(generic, factors)
    slopes = [float(c.function.slopes[0]) for c in larger.couplers if isinstance(c.function, Affine)]
    np.testing.assert_allclose(slopes, [1.2, 0.5], rtol=1e-15)
    write_scaled_model(file, tmp_path / "larger.osim", larger, factors)
    (shift, _) = read_multibody(tmp_path / "larger.osim").couplers
    assert isinstance(shift.function, Affine)
    np.testing.assert_allclose(shift.function.slopes, [1.2])


BAD = {
    "no coordinate": ((coupler("a", "ankle", "patella", LINE),), "names 'patella'"),
    "a circle": ((coupler("a", "ankle", "knee", LINE), coupler("b", "knee", "ankle", LINE)), "in a circle"),
    "twice": ((coupler("a", "ankle", "knee", LINE), coupler("b", "ankle", "hip_x", LINE)), "set the same coordinate"),
}


@pytest.mark.parametrize("case", BAD)
def test_refused(tmp_path: Path, case: str) -> None:
    couplers, message = BAD[case]
    with pytest.raises(InputError, match=message):
        read_multibody(coupled_leg(tmp_path, *couplers))
