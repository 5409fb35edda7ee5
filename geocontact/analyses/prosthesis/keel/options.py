"""What the identification of a keel may be asked for."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from geocontact.analyses.frame.options import Options


@dataclass(frozen=True)
class ProsthesisKeelOptions(Options):
    """Keel of a prosthetic foot from static compressions of its forefoot: EI, what gives in series, with intervals.

    Parameters
    ----------
    foot
        Description of the foot (.toml) with its compressions: curves of force over deflection, or stiffnesses. The
        shipped foot by default.
    """

    writes: ClassVar[str] = """
    Writes keel.csv (numbers with intervals), compressions.csv, stiffness.csv (over the fulcrum), curves.csv where
    curves were given, foot.toml and spheres.csv (the identified foot, for all commands; of foam foot.toml), a figure,
    report.html and run.json into OUT.
    """

    foot: Path | None = None
