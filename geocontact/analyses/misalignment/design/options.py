"""What a design may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import Millimetres, Spelled, Typed
from geocontact.analyses.frame.options import Options
from geocontact.analyses.misalignment.law_numbers import ACROSS, LINK, OFFSET
from geocontact.analyses.misalignment.shared_options import (
    Angles,
    Drift,
    Stroke,
    require_drift,
    require_span,
    require_stroke,
)
from geocontact.data.plausible import ATTACHMENT, LIMIT, Plausible
from geocontact.data.units import mm

Offset = Annotated[
    tuple[float, float],
    Typed("m", "length_pair", "gc.mm(5, -3)"),
    Spelled("offset-mm", "offset_mm", default="0,0", dashed=True),
    OFFSET,
]
REACH = Plausible("how far a map goes", mm, (0.1, 1000.0), (2.0, 300.0))
UNSURE = Plausible("how far things are off", mm, (0.0, 500.0), (0.0, 50.0), least=0.2)
STEP = Plausible("the step of a map", mm, (0.001, 500.0), (0.05, 50.0))


@dataclass(frozen=True)
class DesignOptions(Options):
    """Which offsets of an exoskeleton's axis, and which stroke of a compensation joint, keep |F| under a limit.

    Parameters
    ----------
    k
        Stiffness of the attachment [N/m].
    l
        Length of the exoskeleton's link, from its hinge to the attachment.
    z
        Distance of the attachment from the limb's line.
    range
        Angles of the exoskeleton, with their unit: 0:120deg.
    limit
        Largest |F| [N] that is allowed on the limb.
    stroke
        Ends between which a compensation joint slides freely: -20:35. Locked by default.
    offset
        Offsets x,y of the axes that the design is made for; 0,0 by default.
    uncertainty
        How far the offsets may be from these, in any direction: what the stroke has to cover.
    map
        The map goes this far from the offsets in x and in y.
    step
        Step of the map.
    drift
        How the joint's axis moves with the angle: x=0:-8:2,y=0:5 (mm, mm/rad, mm/rad², …, over the exoskeleton's
        angle), or a .csv with the columns beta or alpha [deg], x [mm], y [mm], or alpha [deg], instant_centre_x [mm],
        instant_centre_y [mm]; alpha is the joint's own angle.
    """

    writes: ClassVar[str] = """
    For the elbow, and for the knee, the hip or any joint of one degree of freedom; slow motion. Writes design.json,
    map.csv, boundary.csv, sensitivity.csv, force.csv, design.png, design.svg, report.html and run.json into OUT.
    """

    _: KW_ONLY
    k: Annotated[float, ATTACHMENT]
    l: Annotated[Millimetres, Spelled("l-mm", "l_mm"), LINK]
    z: Annotated[Millimetres, Spelled("z-mm", "z_mm", dashed=True), ACROSS]
    range: Angles
    limit: Annotated[float, LIMIT]
    stroke: Stroke | None = None
    offset: Offset = (0.0, 0.0)
    uncertainty: Annotated[Millimetres, Spelled("uncertainty-mm", "uncertainty_mm"), UNSURE] = 0.0
    map: Annotated[Millimetres, Spelled("map-mm", "map_mm", default=60.0), REACH] = 60e-3
    step: Annotated[Millimetres, Spelled("step-mm", "step_mm", default=2.0), STEP] = 2e-3
    drift: Drift | None = None

    def refuse_impossible(self) -> None:
        """Angles that are no range, a stroke that ends before it begins."""
        require_span(self.range)
        require_stroke(self.stroke)
        require_drift(self.drift)
