"""Pairs of real bodies: bones whose poses are rows of 4x4 matrices, segments of a whole-body model that walks."""

from __future__ import annotations

import warnings
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

import geocontact as gc
from geocontact.analyses.area.pairs.bodies import read
from geocontact.analyses.area.pairs.options import PairsOptions
from geocontact.data.errors import InputError, InputWarning
from tests.cli.calls import SPHERE, written
from tests.real.test_real_ankles import part


def ankle(folder: Path, data_dir: Path, more: str = "") -> Path:
    """Talus and calcaneus of one person over walking, every sixtieth frame."""
    home = data_dir / "jma_ankles" / "Norm_01"
    text = 'unit = "mm"\nrate = { value = 1, unit = "Hz" }\n'
    for bone, mesh in (("Talus", "Talus"), ("Calcaneus", "Calcaneus_Right")):
        part(folder, home / f"Norm_01_Walk_{bone}.txt")
        text += f'[[bodies]]\nname = "{bone.lower()}"\nmesh = "{(home / f"Norm_01_{mesh}.stl").as_posix()}"\n'
        text += f'motion = "Norm_01_Walk_{bone}.txt"\n'
    return written(folder / "ankle.toml", f'{text}[[pairs]]\nmoving = "talus"\nfixed = "calcaneus"\n{more}')


@pytest.mark.slow
def test_rows_of_both_bones_are_those_of_a_single_run(data_dir: Path, tmp_path: Path) -> None:
    """To the last digit; matrices written column by column are refused."""
    file = ankle(tmp_path, data_dir)
    home = data_dir / "jma_ankles" / "Norm_01"
    talus, calcaneus = (tmp_path / f"Norm_01_Walk_{bone}.txt" for bone in ("Talus", "Calcaneus"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        ours = gc.area_pairs(file, rule="clip")
        theirs = gc.area(
            home / "Norm_01_Talus.stl",
            home / "Norm_01_Calcaneus_Right.stl",
            unit="mm",
            motion=talus,
            motion_fixed=str(calcaneus),
            rate=1.0,
            rule="clip",
        )
    pd.testing.assert_frame_equal(ours.table("talus_calcaneus/area"), theirs.table(), check_exact=True)
    rows = np.loadtxt(talus, delimiter=",").reshape(-1, 4, 4).transpose(0, 2, 1).reshape(-1, 16)
    written(talus, "\n".join(",".join(map(repr, row)) for row in rows.tolist()) + "\n")
    with pytest.raises(InputError, match="write it row by row, not column by column"):
        gc.area_pairs(file)


@pytest.mark.slow
def test_bones_come_to_rest_under_the_force_along_the_axes_of_the_other(data_dir: Path, tmp_path: Path) -> None:
    """A layer of 3 mm stands for both cartilages; its load on the calcaneus is 500 N along that bone's own -z."""
    layer = 'modulus = { value = 12, unit = "MPa" }, poisson = 0.4, foundation = "logarithmic"'
    lengths = 'thickness = { value = 3, unit = "mm" }, piece = { value = 2, unit = "mm" }'
    free = '[[free]]\nbody = "talus"\naxes = "calcaneus"\nsettles = ["tz"]\nfz = { value = -500, unit = "N" }\n'
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        result = gc.settle_pairs(ankle(tmp_path, data_dir, f"layer = {{ {layer}, {lengths} }}\n{free}"))
    assert result.resting.converged.all()
    poses = np.loadtxt(tmp_path / "Norm_01_Walk_Calcaneus.txt", delimiter=",").reshape(-1, 4, 4)
    along = np.einsum("ti,ti->t", result.loads["calcaneus"][:, :3], poses[:, :3, 2])
    np.testing.assert_allclose(along, -500.0, rtol=5e-3)  # matrices are off orthonormal by up to 0.006
    np.testing.assert_array_equal(result.loads["calcaneus"], -result.loads["talus"])


def axis_of(joint: ET.Element) -> np.ndarray:
    """Of the first rotation."""
    return np.array(joint.find(".//TransformAxis[@name='rotation1']/axis").text.split(), float)  # type: ignore[union-attr]


@pytest.mark.slow
def test_segments_of_a_whole_body_model_move_by_its_coordinates(data_dir: Path, tmp_path: Path) -> None:
    """Feet at the end of two chains: each joint turns about the model's own axis by the angle in the .mot."""
    home = data_dir / "opensim_walk"
    model, motion = home / "subject01_simbody.osim", home / "subject01_walk1_ik.mot"
    chain = ("tibia_r", "talus_r", "calcn_r", "talus_l")
    text = f'unit = "mm"\nmodel = "{model.as_posix()}"\ncoordinates = "{motion.as_posix()}"\n'
    for name in chain:
        text += f'[[bodies]]\nname = "{name}"\nmesh = "{SPHERE.as_posix()}"\nsegment = "{name}"\n'
    for moving, fixed in (("talus_r", "tibia_r"), ("calcn_r", "talus_r"), ("talus_l", "tibia_r")):
        text += f'[[pairs]]\nmoving = "{moving}"\nfixed = "{fixed}"\n'
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        found = read(PairsOptions(written(tmp_path / "feet.toml", text)))
    lines = motion.read_text("utf-8").splitlines()
    head = next(k for k, line in enumerate(lines) if line.startswith("time"))
    columns = dict(
        zip(lines[head].split(), np.array([line.split() for line in lines[head + 1 :]], float).T, strict=True)
    )
    np.testing.assert_allclose(found.time, columns["time"])
    root = ET.parse(model)
    for joint, coordinate, moving, fixed in (
        ("ankle_r", "ankle_angle_r", "talus_r", "tibia_r"),
        ("subtalar_r", "subtalar_angle_r", "calcn_r", "talus_r"),
    ):
        axis = axis_of(root.find(f".//CustomJoint[@name='{joint}']"))  # type: ignore[arg-type]
        turned = Rotation.from_rotvec(np.radians(columns[coordinate])[:, None] * axis / np.linalg.norm(axis))
        relative = found.poses(fixed).inv() * found.poses(moving)
        assert (relative.rotation * turned.inv()).magnitude().max() < 1e-6, joint
    left, right = (found.poses(f"talus_{side}").translation for side in "lr")
    assert (left[:, 2] < right[:, 2]).all() and np.ptp(right[:, 0]) > 0.3, "two feet that walk in the laboratory"
