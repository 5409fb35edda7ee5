"""A gap case that reads, as the text of its files; tests change a copy of it."""

from __future__ import annotations

from pathlib import Path

Files = dict[str, str]
"""Text by path inside the folder of the case."""

TRIAL = """time [s],beta [rad],force [N],cop [m]
0.0,0.50,10.5,0.010
0.1,0.75,11.5,
0.2,1.00,-12.25,0.030
"""

CASE: Files = {
    "case.toml": """format = 1
system = "elbow"
calibration = ["t01", "t02"]
evaluation = ["t03"]
spheres = "spheres.csv"

[noise]
force = 0.2
cop = 0.001

[constants]
l_ex = 0.17
turns = 2

[parameters.k]
start = 300.0
lower = 50.0
upper = 1000.0
unit = "N/m^n"

[parameters.z_ex]
start = 0.09
unit = "m"
fixed = true

[trial.t01]
condition = "locked"
cuff_pressure = 4000.0
level = 1
""",
    "spheres.csv": "px [m],py [m],radius [m],zone\n0.0,0.01,0.011,z1\n0.5,0.02,0.012,2\n",
    "trials/t01.csv": TRIAL,
    "trials/t02.csv": TRIAL,
    "trials/t03.csv": TRIAL,
}


def case_in(folder: Path, files: Files | None = None, **changed: str) -> Path:
    """A folder `elbow_1` with the files of a case; `changed` texts stand for those of `case`, `spheres`, `t01` …"""
    home = folder / "elbow_1"
    names = {Path(name).stem: name for name in CASE}
    for name, text in {**CASE, **(files or {}), **{names[key]: text for key, text in changed.items()}}.items():
        (home / name).parent.mkdir(parents=True, exist_ok=True)
        (home / name).write_text(text, encoding="utf-8", newline="")
    return home
