"""Write the shipped foot: `python -m meshes.make_foot`.

It is the variable-stiffness foot of `geocontact.below_knee_prosthesis.keel.vsf`, whose numbers follow from the three
compressions of its study, as a file like one of your own.
"""

from __future__ import annotations

from pathlib import Path

from geocontact.analyses.prosthesis.foot_file import SHIPPED
from geocontact.analyses.prosthesis.foot_writer import quantity, write_foot
from geocontact.below_knee_prosthesis.keel.vsf import SETTINGS, vsf_foot
from geocontact.data.parameter import Number

ROUNDED = 1e3 / 12.0**0.5
"""Standard deviation of a stiffness that is rounded to 1 N/mm [N/m]."""


def compressions() -> list[str]:
    """Stiffnesses of the study; where medium has its fulcrum is not stated there."""
    lines = []
    for setting, stiffness in SETTINGS.items():
        lines += ["", "[[compressions]]", f'name = "{setting}"', f'setting = "{setting}"']
        lines += ["sought = true"] * (setting == "medium")
        lines.append(f"stiffness = {quantity(Number(stiffness, 'paper', 'table 2'), 'N/m')}")
        lines.append(f"sd = {quantity(Number(ROUNDED, 'derived', 'rounded to 1 N/mm'), 'N/m')}")
    return lines


def main(folder: Path = SHIPPED.parent) -> None:
    """The shipped files, or the same in another folder."""
    write_foot(folder, vsf_foot(), compressions())


if __name__ == "__main__":
    main()
