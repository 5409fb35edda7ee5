"""What a comparison of many prosthetic stances may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.frame.marks import C3dUnit, Excludes, Expression, Length, Requires
from geocontact.analyses.frame.options import Options, declared
from geocontact.analyses.prosthesis.ranges import TURNS, require_one_socket, require_turns, require_walks
from geocontact.data.errors import InputError
from geocontact.data.plausible import CUTOFF, GAP, SHIFT


@dataclass(frozen=True)
class ProsthesisCompareOptions(Options):
    """Stances of a study, simulated, compared with their force plates and with two baseline predictors.

    Parameters
    ----------
    study
        Persons and trials (.toml), with markers, plates and the setting of the foot.
    runs
        Stances of `prosthesis simulate` in place of a study, each by its run.json: simulated again as they were. A
        person is who has one standing trial. May be given again.

    The motion
    ----------
    cutoff
        Zero-lag low-pass of the recorded coordinates [Hz]; 0 leaves them as they are.
    socket_turns
        Most fits after the first, each with the socket's simulated motion removed from its markers. With 0 that motion
        is counted twice: in the leg's angles and again in the bushing.
    gap_limit
        Longest time for which a coordinate may be unknown [s].
    markers_map
        Names of recorded markers as they are called here: R_HIP=RASI, or a file with a pair in each line.
    axes
        Which of the markers' axes are x (forward along the walk), y (upwards) and z: x,z,-y where the laboratory's z
        is up.
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.

    Errors of the markers
    ---------------------
    walks
        Draws of the markers' errors, along each of which every stance is simulated again: how far they move force and
        centre of pressure, and how much of the plate's curves is within that. A draw takes as long as the stance.
    marker_error
        Standard deviation of each coordinate of a marker [mm], half of its variance from frame to frame and half
        slowly; 0.5 mm by default, which is invented. Skin moves by millimetres.
    seed
        Seed of the draws.

    How it is simulated
    -------------------
    foot
        Description of another foot (.toml), for persons who have none in the study.
    socket
        Bushing between residual limb and socket: as_meant (10 N m/deg) or as_printed (10 N mm/deg).
    socket_numbers
        Stiffness and damping of the socket in a file (.toml), in place of `socket`, for persons who have
        none in the study.
    score
        What is compared with the plate: its stance, or as the study of the variable-stiffness foot does, also 0.25 s
        of swing on both sides, with centres of pressure low-passed at 6 Hz, which makes errors smaller.
    machine_code
        Machine code of the equations, kept for later runs. Without it, CasADi interprets them: the same, but slower.
    workers
        Processes; as many as there are cores by default. Results do not depend on it.
    """

    writes: ClassVar[str] = """
    Writes summary.csv (means by setting), trials.csv (length, peaks, outliers and their likely causes), errors.csv,
    ensembles.csv, changes.csv (between settings, predicted and measured), coordinates, external loads, spheres and
    numbers of each stance, a figure, report.html and run.json into OUT.
    """

    study: Path | None = None
    _: KW_ONLY
    runs: Annotated[tuple[Path, ...], Excludes("study", "both describe the stances", "give one of them")] = ()
    cutoff: Annotated[float, CUTOFF] = 6.0
    socket_turns: int = TURNS
    gap_limit: Annotated[float, GAP] = 0.2
    markers_map: str | None = None
    axes: Expression | None = None
    c3d_unit: C3dUnit = None
    walks: int | None = None
    marker_error: Annotated[Length | None, SHIFT, Requires("walks")] = None
    seed: Annotated[int | None, Requires("walks")] = None
    foot: Path | None = None
    socket: Literal["as_meant", "as_printed"] = "as_meant"
    socket_numbers: Path | None = None
    score: Literal["stance", "study"] = "stance"
    machine_code: bool = True
    workers: int | None = None

    @property
    def source(self) -> Path:
        """What describes the stances."""
        return self.study or (self.runs or (Path(),))[0]

    @property
    def place(self) -> str:
        """Where `source` describes the stances, for errors."""
        return "[[trials]]" if self.study else "`runs`"

    def refuse_impossible(self) -> None:
        """No stances, no process at all, a negative number of fits."""
        if self.study is None and not self.runs:
            raise InputError("", "`study`", "no stances are described", "give a study (.toml), or `runs`")
        if self.runs:
            self._refuse_own()
        require_turns(self.socket_turns)
        require_walks(self.walks)
        require_one_socket(self.socket, self.socket_numbers)
        if self.workers is not None and self.workers < 1:
            raise InputError("", "`workers`", f"{self.workers} is less than one process", "give 1 or more")

    def _refuse_own(self) -> None:
        """InputError for an option of the simulation beside runs that have it already."""
        for one in declared(type(self)):
            if one.name not in ("study", "runs", "workers") and getattr(self, one.name) != one.default:
                what = "has no effect with `runs`: each is simulated as it was"
                raise InputError("", f"`{one.name}`", what, "give it to `prosthesis simulate`")
