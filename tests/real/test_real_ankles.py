"""Subtalar joints of walking people: talus and calcaneus both move; poses are rows of 4x4 matrices in the laboratory.

Some matrices are off orthonormal by 0.006, as their entries were interpolated: the nearest rotation is 0.2 mm away.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.cli.calls import Call, area, done, written

FRAMES = slice(0, None, 60)


def part(folder: Path, file: Path) -> Path:
    """Some frames of a file, as they stand there."""
    return written(folder / file.name, "\n".join(file.read_text(encoding="utf-8").split()[FRAMES]) + "\n")


@pytest.mark.slow
@pytest.mark.parametrize("person", ["Norm_01", "Norm_03"])
def test_two_bones_that_move_are_read_as_they_are(data_dir: Path, tmp_path: Path, person: str) -> None:
    """Areas as of the relative poses, and near those of nearest vertices: 1040 to 1157 mm^2 in Norm_01."""
    home = data_dir / "jma_ankles" / person
    talus, calcaneus = (part(tmp_path, home / f"{person}_Walk_{bone}.txt") for bone in ("Talus", "Calcaneus"))
    moving, fixed = (np.loadtxt(file, delimiter=",").reshape(-1, 4, 4) for file in (talus, calcaneus))
    relative = np.linalg.inv(fixed) @ moving
    one = written(tmp_path / "one.txt", "\n".join(",".join(map(repr, m.ravel().tolist())) for m in relative) + "\n")

    def contact(out: str, *options: object) -> Call:
        bones = {"moving": home / f"{person}_Talus.stl", "fixed": home / f"{person}_Calcaneus_Right.stl"}
        return done(area(tmp_path / out, "--rate", "1", *options, **bones))

    ours = contact("both", "--motion", talus, "--motion-fixed", calcaneus).table()
    theirs = contact("one", "--motion", one).table()
    np.testing.assert_allclose(ours["area_fixed [mm^2]"], theirs["area_fixed [mm^2]"], rtol=5e-3)
    np.testing.assert_allclose(ours["min_distance [mm]"], theirs["min_distance [mm]"], atol=0.2)
    assert ours["area_fixed [mm^2]"].between(900.0, 1700.0).all() and (ours["signed"] == "both").all()
