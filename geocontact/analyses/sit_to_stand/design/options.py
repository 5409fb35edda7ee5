"""What the choice of an exoskeleton for standing up may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.frame.marks import Expression, Fraction, Spelled
from geocontact.analyses.sit_to_stand.search_options import NODES, StandingSearchOptions, within
from geocontact.data.errors import InputError
from geocontact.data.plausible import MOST_OF
from geocontact.standing_up.assistance_room import ROOM

MOST_DRAWS, MOST_POINTS = 200, 50


@dataclass(frozen=True)
class StandingDesignOptions(StandingSearchOptions):
    """Strap, place and help of an exoskeleton that minimise the strap's force while they relieve the knee.

    Parameters
    ----------
    study
        Trials of a person with the exoskeleton (.toml), whose movement is to be the same.
    parameters
        parameters.csv of a calibration with the exoskeleton.

    Objective
    ---------
    vary
        What is chosen, separated by commas: share (of the person's knee torque), timing, place (of the strap), normal,
        tangential and turning (its stiffnesses); of straps at shank and pelvis shank_place, pelvis_normal and so on.
    aim
        What is minimised: smooth peak of the force of the strap at the thigh (strap), shank or pelvis, or mean energy
        of all springs.
    knee
        Upper limit of the true peak torque of the person's knee, as part of the peak without help.

    Validation
    ----------
    front
        Further limits of the knee between none and `knee`, each with its own best.
    draws
        Sets of parameters drawn from the calibration's intervals.
    robust
        Choose for the worst of the draws too.
    seed
        Seed of the draws.
    """

    writes: ClassVar[str] = """
    Writes designs.csv (without help, share alone, chosen), chosen.csv, sensitivity.csv (how the minimum force changes
    with fixed numbers), certificate.csv, numbers.csv and mesh.csv (all that ran), front.csv and draws.csv where asked
    for, a trajectory for OpenSim's Moco for each trial, a figure, report.html and run.json into OUT.
    """

    study: Path
    _: KW_ONLY
    parameters: Path
    vary: Expression = "share,timing,place"
    aim: Literal["strap", "energy", "shank", "pelvis"] = "strap"
    knee: Annotated[Fraction, MOST_OF, Spelled(default="0.8")] = 0.8
    front: int = 0
    draws: int = 0
    robust: bool = False
    seed: int = 0
    nodes: Annotated[float, NODES] = 20.0

    @property
    def varied(self) -> tuple[str, ...]:
        """Names, in the order of tables."""
        told = {name.strip() for name in self.vary.split(",")}
        return tuple(name for name in ROOM if name in told)

    def refuse_impossible(self) -> None:
        """Numbers without a search, names of nothing that can be chosen."""
        super().refuse_impossible()
        odd = [name.strip() for name in self.vary.split(",") if name.strip() not in ROOM]
        if odd:
            raise InputError("", "`vary`", f"{odd[0]!r} cannot be chosen", f"names are {', '.join(ROOM)}")
        if "share" not in self.varied:
            raise InputError("", "`vary`", "share is not among them", "add it: without it nothing relieves the knee")
        if not 0.0 < self.knee <= 1.0:
            raise InputError("", "`knee`", f"{self.knee:g} is not above 0 and at most 1", "give for example 0.8")
        within("front", self.front, 0, MOST_POINTS, 4)
        within("draws", self.draws, 0, MOST_DRAWS, 6)
        if self.robust and not self.draws:
            raise InputError("", "`robust`", "there are no draws to choose for", "give for example `draws` 4")
