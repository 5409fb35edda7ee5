"""Models for other programs of real implants and of a published OpenSim model."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from tests import opensim_oracle
from tests.analyses.area.test_exports import Feb
from tests.cli.calls import Call, area, done
from tests.elsewhere import Elsewhere
from tests.real.test_real_areas import DM_MAP, WORKSHOP


def test_fluoroscopic_gait_of_dm_as_a_model_for_febio(data_dir: Path, tmp_path: Path) -> None:
    """Poses from the recording's columns by hand: intrinsic x, y, z, shifts in m."""
    folder = data_dir / "gc6_dm_knee"
    bodies = {
        name: folder / f"stl/{part} decimated.stl"
        for name, part in (("moving", "Femoral Component"), ("fixed", "Tibial Insert"))
    }
    motion = folder / "fluoroscopy/Fluoroscopic Gait Data.sto"
    options = ("--map", DM_MAP, "--angles", "rad", "--order", "XYZ", "--rule", "clip", "--export", "febio,abaqus")
    result = done(area(tmp_path / "out", *options, **bodies, motion=motion, unit="m"))
    lines = motion.read_text(encoding="utf-8").splitlines()
    start = next(k for k, line in enumerate(lines) if line.strip().lower() == "endheader") + 1
    names = lines[start].split()
    table = pd.DataFrame([line.split() for line in lines[start + 1 :] if line.strip()], columns=names).astype(float)
    columns = dict(pair.split("=") for pair in DM_MAP.split(","))
    R = Rotation.from_euler("XYZ", table[[columns[k] for k in ("rx", "ry", "rz")]].to_numpy()).as_matrix()
    t = table[[columns[k] for k in ("tx", "ty", "tz")]].to_numpy() * 1e3
    feb = Feb(result.folder / "export" / "contact.feb")
    own = (feb.nodes["MOVING"] - t[0]) @ R[0]
    assert len(feb.time) == len(table) == 101
    for k in range(len(table)):
        np.testing.assert_allclose(feb.placed(k), own @ R[k].T + t[k], atol=1e-7)


def test_meshes_on_the_workshops_model(data_dir: Path, tmp_path: Path, opensim: Elsewhere) -> None:
    """OpenSim opens the copy; both bodies of the joint have one mesh more, the model is else what it was."""
    folder = data_dir / WORKSHOP
    given = ("--osim", folder / "KneeProsthesis.osim", "--joint", "knee_joint", "--angles", "deg", "--moving", "parent")
    bodies = {
        "moving": folder / "Femoral_Component_simpler.stl",
        "fixed": folder / "Tibial_Insert_simpler_superior.stl",
    }
    motion = folder / "KneeProsthesis.mot"
    result: Call = done(
        area(tmp_path / "out", *given, "--rule", "clip", "--export", "opensim", **bodies, motion=motion, unit="m")
    )
    before = opensim(opensim_oracle.meshes, folder / "KneeProsthesis.osim")
    after = opensim(opensim_oracle.meshes, result.folder / "export" / "KneeProsthesis.osim")
    added = {name: after.pop(name) for name in set(after) - set(before)}
    assert after == before and {file for _, file, _ in added.values()} == {"fixed.stl", "moving.stl"}
    assert all(scale == [0.001] * 3 for *_, scale in added.values())
    assert len({body for body, *_ in added.values()}) == 2
