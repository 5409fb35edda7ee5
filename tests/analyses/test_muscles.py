"""Muscles of a shipped leg through `geocontact id --muscles`: paths by hand, files, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
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
    monkeypatch.setattr(muscle_paths, "find_spec", lambda name: None)
    with pytest.raises(InputError, match="needs the opensim package"):
        asked(muscular(tmp_path))


def test_a_contact_force_without_muscles_is_refused() -> None:
    with pytest.raises(InputError, match="`across`"):
        gc.inverse_dynamics(MESHES / "leg_swing.mot", model=MESHES / "leg.osim", across="tibia_r")
