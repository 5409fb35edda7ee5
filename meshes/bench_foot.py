"""Compressions of a foot on a bench, invented: `python -m meshes.bench_foot [FOLDER]` writes meshes/foot_bench.

A keel of 240 mm whose EI is 28 N m², on two supports, with 120 N/mm in series. A plate presses on its tip down to 8 mm
at three known fulcrums and one that is not known, 118 mm. By Euler and Bernoulli, nothing of the package:

    d = F (a² L/(3 EI) + 1/k) + d0,  a = L - l

The gauge has a standard deviation of 0.03 mm, and the load cell's zero makes the plate touch 0.2 to 0.5 mm late.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

LENGTH, BENDING, SERIES = 0.240, 28.0, 120e3
FULCRUMS = {"soft": 0.070, "walking": 0.118, "firm": 0.140, "hard": 0.165}
GAUGE, TRAVEL, ROWS, SEED = 3e-5, 8e-3, 60, 2026
FOLDER = Path(__file__).parent / "foot_bench"
FOOT = """# A foot on a bench, invented: written by `python -m meshes.bench_foot`.
name = "bench foot"

[keel]
length = { value = 240, unit = "mm" }
posterior = { value = 66, unit = "mm" }
lowest = { value = 66, unit = "mm" }
highest = { value = 170, unit = "mm" }
width = { value = 58, unit = "mm" }
thickness = { value = 7, unit = "mm" }
density = { value = 1.6, unit = "g/cm^3", source = "invented", note = "usual for carbon fibre" }

[settings]
soft = { value = 70, unit = "mm" }
firm = { value = 140, unit = "mm" }
hard = { value = 165, unit = "mm" }

[sole]
spheres = "spheres.csv"
source = "invented"
below = { value = 28, unit = "mm" }

[bench]
noise = { value = 0.03, unit = "mm" }
"""
ZONES = {"heel": (15, 50), "midfoot": (80, 110, 140), "forefoot": (165, 190, 215, 232)}
"""Rows of two spheres each, from the keel's posterior end [mm]."""
LAW = """
[sole.zones.{zone}]
stiffness = {{ value = 22, unit = "N/mm", source = "invented" }}
damping = {{ value = 0.3, unit = "N s/mm", source = "invented" }}
static = {{ value = 0.8, unit = "-", source = "invented" }}
kinetic = {{ value = 0.7, unit = "-", source = "invented" }}
"""


def compliance(fulcrum: float) -> float:
    """Travel of the plate per force [m/N]."""
    return (LENGTH - fulcrum) ** 2 * LENGTH / (3.0 * BENDING) + 1.0 / SERIES


def main(folder: Path = FOLDER) -> None:
    """Description, spheres and a curve for each setting."""
    folder.mkdir(parents=True, exist_ok=True)
    rng, text = np.random.default_rng(SEED), FOOT
    text += "".join(LAW.format(zone=zone) for zone in ZONES)
    for name, fulcrum in FULCRUMS.items():
        force = np.linspace(3.0, TRAVEL / compliance(fulcrum), ROWS)
        late = rng.uniform(2e-4, 5e-4)
        deflection = force * compliance(fulcrum) + late + GAUGE * rng.standard_normal(ROWS)
        rows = [f"{f:.1f},{1e3 * d:.3f}" for f, d in zip(force, deflection, strict=True)]
        (folder / f"{name}.csv").write_text("\n".join(["force [N],deflection [mm]", *rows, ""]), encoding="utf-8")
        text += f'\n[[compressions]]\nname = "{name}"\nsetting = "{name}"\ncurve = "{name}.csv"\n'
        text += "sought = true\n" * (name == "walking")
    (folder / "foot.toml").write_text(text, encoding="utf-8")
    places = [(x, z, zone) for zone, rows in ZONES.items() for x in rows for z in (-15, 15)]
    lines = [f"{x},-8,{z},20,{zone}" for x, z, zone in places]
    head = "px [mm],py [mm],pz [mm],radius [mm],zone"
    (folder / "spheres.csv").write_text("\n".join([head, *lines, ""]), encoding="utf-8")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
