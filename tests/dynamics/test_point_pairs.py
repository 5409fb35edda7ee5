"""Points that a constraint keeps together, in ik as in OpenSim."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTasks
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_kinematics import inverse_kinematics
from geocontact.dynamics.scaling import scaled
from geocontact.dynamics.tree import tree_of
from geocontact.io.mocap.trc import write_trc
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.opensim.osim_scaler import write_scaled_model
from meshes.leg_files import leg_model
from tests import opensim_oracle
from tests.dynamics.test_coupled_coordinates import noisy
from tests.elsewhere import Elsewhere

ROD = """<ConstraintSet><objects><PointConstraint name="strap"><socket_body_1>/bodyset/pelvis</socket_body_1>
<socket_body_2>{foot}</socket_body_2><location_body_1>0.1 -0.85 0.12</location_body_1>
<location_body_2>0.05 0.02 0.01</location_body_2></PointConstraint></objects></ConstraintSet>"""


def strapped(folder: Path, foot: str = "/bodyset/foot_r") -> Path:
    """The shipped leg, a point of its foot at a place of the pelvis: a loop."""
    text = leg_model().replace("BallJoint", "GimbalJoint")
    (folder / "leg.osim").write_text(text.replace("<MarkerSet>", f"{ROD.format(foot=foot)}<MarkerSet>"))
    return folder / "leg.osim"


def apart(model: Multibody, values: np.ndarray) -> np.ndarray:
    """How far the points are from each other [m]."""
    (pair,), poses = model.pairs, model.poses(values)
    one, other = (poses[body].apply(place) for body, place in (pair.ends(0), pair.ends(1)))
    return np.asarray(np.linalg.norm(one - other, axis=1))


def test_points_stay_together(tmp_path: Path) -> None:
    """Markers of a swing that pulls them up to 30 cm apart, noise added: a tenth of a millimetre is left."""
    tree = tree_of(read_multibody(strapped(tmp_path)))
    seen = noisy(tree)
    found = inverse_kinematics(tree, seen, MarkerTasks(dict.fromkeys(seen.names, 1.0)))
    assert found.settled.all() and found.determined.all() and apart(tree.model, found.values).max() < 2e-4
    free = tree_of(Multibody(**{**vars(tree.model), "pairs": ()}))
    loose = inverse_kinematics(free, seen, MarkerTasks(dict.fromkeys(seen.names, 1.0)))
    assert apart(tree.model, loose.values).max() > 0.05


def test_angles_are_those_of_opensim(tmp_path: Path, opensim: Elsewhere) -> None:
    file = strapped(tmp_path)
    tree = tree_of(read_multibody(file))
    seen = noisy(tree)
    weights = dict.fromkeys(seen.names, 1.0)
    ours = inverse_kinematics(tree, seen, MarkerTasks(weights)).values
    write_trc(tmp_path / "walk.trc", seen)
    times = [*seen.time[:-1].tolist(), float(seen.time[-1]) - 1e-9]
    _, theirs = opensim(
        opensim_oracle.inverse_kinematics, file, tmp_path / "walk.trc", weights, {}, times, tree.names, 1e-9
    )
    np.testing.assert_allclose(ours, theirs, atol=np.radians(0.1))


def test_what_a_loop_tells_is_determined(tmp_path: Path) -> None:
    """Without markers of the foot and the shank the strap tells the knee; without the strap nothing does."""
    tree = tree_of(read_multibody(strapped(tmp_path)))
    seen = noisy(tree)
    high = {name: 1.0 for name in seen.names if name[:-1] in ("pelvis", "femur_r")}
    found = inverse_kinematics(tree, seen, MarkerTasks(high))
    assert found.determined[:, tree.names.index("knee")].all()
    free = tree_of(Multibody(**{**vars(tree.model), "pairs": ()}))
    assert not inverse_kinematics(free, seen, MarkerTasks(high)).determined[:, tree.names.index("knee")].any()


def test_points_are_scaled_with_their_bodies(tmp_path: Path) -> None:
    file = strapped(tmp_path)
    by = {"pelvis": 1.2 * np.ones(3), "foot_r": 0.9 * np.ones(3)}
    larger = scaled(read_multibody(file), by)
    write_scaled_model(file, tmp_path / "scaled.osim", larger, by)
    (read,), (meant,) = read_multibody(tmp_path / "scaled.osim").pairs, larger.pairs
    np.testing.assert_allclose(read.places, meant.places, atol=1e-12)
    np.testing.assert_allclose(meant.places, [[0.12, -1.02, 0.144], [0.045, 0.018, 0.009]], atol=1e-12)


def test_a_pair_without_a_body_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="PointConstraint strap: names no body 2"):
        read_multibody(strapped(tmp_path, foot=""))
