"""Files of a synthetic step with a known E*: areas as `geocontact area` writes them, and forces by the law."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.elastic_modulus.area_force import MODULUS
from geocontact.io.recordings.area_table import OFFSET
from tests.identify.synthetic_contact import DURATION, THRESHOLDS, TRUE, synthetic_areas, synthetic_model

FRAMES = 56
SHARE = 0.55  # of the area that is medial
LBF = 4.4482216152605
MEDIAL, LATERAL, WHOLE = (f"area_fixed{side} [mm^2]" for side in ("_medial", "_lateral", ""))
PER_DEGREE = 0.1  # share of a side's area that a degree takes or gives at the start; half at the end


def areas(folder: Path, name: str = "area.csv", scale: float = 1.0, levels: slice = slice(None)) -> Path:
    """Synthetic areas of a step as `geocontact area` writes them, empty cells included."""
    time = np.linspace(0.0, DURATION, FRAMES)
    rows = [
        {
            "time [s]": t,
            "threshold [mm]": T * 1e3,
            WHOLE: a * 1e6,
            "centroid_x [mm]": np.nan,
            "signed": "none",
            MEDIAL: SHARE * a * 1e6,
            LATERAL: (1 - SHARE) * a * 1e6,
        }
        for t, row in zip(time, synthetic_areas(time, scale), strict=True)
        for T, a in list(zip(THRESHOLDS, row, strict=True))[levels]
    ]
    pd.DataFrame(rows).to_csv(folder / name, index=False, float_format="%.12g")
    return folder / name


def forces(
    folder: Path,
    name: str = "forces.csv",
    unit: float = 1.0,
    head: str = "",
    sides: bool = True,
    late: float = 0.0,
    scale: float = 1.0,
) -> Path:
    """The law's own forces of those areas, at the area's times."""
    model = synthetic_model(frames=FRAMES)
    area = synthetic_areas(model.frames, scale)[:, 3]
    force = 4.0 / 3.0 * TRUE * (area / np.pi) ** 1.5 / 0.037
    if scale == 1.0:
        np.testing.assert_allclose(force, model.force({MODULUS: TRUE}), rtol=1e-12)
    columns = [force * SHARE**1.5, force * (1 - SHARE) ** 1.5] if sides else [force]
    head = head or ("time [s],medial [N],lateral [N]" if sides else "time [s],total [N]")
    rows = np.column_stack([model.frames + late, *(c / unit for c in columns)])
    return written(folder / name, "\n".join([head, *(",".join(map(repr, row)) for row in rows.tolist())]) + "\n")


def tilted(folder: Path, *degrees: float) -> list[Path]:
    """A table of areas for each adduction offset."""
    base = pd.read_csv(areas(folder))
    files = []
    for each in degrees:
        grown = PER_DEGREE * (1.0 - 0.5 * base["time [s]"] / DURATION) * each
        table = base.assign(**{MEDIAL: base[MEDIAL] * (1 - grown), LATERAL: base[LATERAL] * (1 + grown)})
        table[OFFSET] = each
        table[WHOLE] = table[MEDIAL] + table[LATERAL]
        files.append(folder / f"areas_{each:g}.csv")
        table.to_csv(files[-1], index=False, float_format="%.12g")
    return files


def pressed(folder: Path, table: pd.DataFrame) -> Path:
    """Forces by the law of both sides' areas at 4 mm."""
    rows = table[table["threshold [mm]"] == 4.0]
    columns = {"time [s]": rows["time [s]"]}
    for side, name in (("medial", MEDIAL), ("lateral", LATERAL)):
        columns[f"{side} [N]"] = 4.0 / 3.0 * TRUE * (rows[name] * 1e-6 / np.pi) ** 1.5 / 0.037
    pd.DataFrame(columns).to_csv(folder / "pressed.csv", index=False, float_format="%.12g")
    return folder / "pressed.csv"


def written(file: Path, text: str) -> Path:
    """The file, with this text."""
    file.write_text(text, encoding="utf-8")
    return file
