"""What a contact page shows of pressures: the map, forces, centres of pressure, and how far to trust them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.area.pressure.along import PressureEvolution
from geocontact.data.motion import Course
from geocontact.view.page.content import Curve, Curves, FaceMap, Picture, Readout, Row, Section, Words

MM, MM2, MPA = 1e3, 1e6, 1e-6
WORDS = (
    "Force and largest pressure over the motion; right, the mean pressure of each face of the fixed body in the frame "
    "with the largest force, and the way of the centre of pressure. Each place of the layer gives way by itself."
)
DEEPER = 0.1e-3  # m; what the words put into pressure


@dataclass(frozen=True, eq=False)
class Pressures:
    """Pressures on FIXED over all frames of a motion, and the maps of some.

    Parameters
    ----------
    force, centre
        Force [N] and centre of pressure [m] of each compartment and of the "total"; NaN where nothing presses.
    peak, area
        Largest pressure [Pa] and area under pressure [m^2] of the whole.
    maps
        Mean pressure of each face [Pa], by the number of the frame.
    law, modulus, thickness, other_modulus
        Law of the layer, its confined modulus [Pa], the least and greatest thickness where it is pressed [m], and the
        confined modulus of MOVING's layer [Pa], infinite where MOVING is rigid.
    finer
        Largest force again, with pieces of half the size [N].
    picture
        The static figure.
    """

    force: Mapping[str, Float[np.ndarray, " t"]]
    centre: Mapping[str, Float[np.ndarray, "t 3"]]
    peak: Float[np.ndarray, " t"]
    area: Float[np.ndarray, " t"]
    maps: Mapping[int, Float[np.ndarray, " f"]]
    law: str
    modulus: float
    thickness: tuple[float, float]
    other_modulus: float
    finer: float
    picture: Picture

    @property
    def heaviest(self) -> int:
        """Frame with the largest force."""
        return int(np.argmax(self.force["total"]))


def shown_pressures(e: PressureEvolution, drawing: bytes) -> Pressures:
    """What the page shows of pressures, with their figure."""
    return Pressures(
        force={side: np.array([load.pressing for load in loads]) for side, loads in e.sides.items()},
        centre={side: np.array([load.centre for load in loads]) for side, loads in e.sides.items()},
        peak=np.array([load.peak for load in e.loads]),
        area=np.array([load.area for load in e.loads]),
        maps=e.maps,
        law=e.layer.law,
        modulus=e.layer.modulus,
        thickness=e.thickness,
        other_modulus=e.skin.modulus,
        finer=e.finer,
        picture=Picture("Pressure", WORDS, drawing, wide=True),
    )


def face_map(p: Pressures, frames: Int[np.ndarray, " k"], body: int) -> FaceMap:
    """The colours of the frames shown."""
    values = np.array([p.maps[k] for k in frames.tolist()]) * MPA
    return FaceMap("mean pressure of each face", "MPa", body, values)


def headline(p: Pressures, course: Course) -> list[tuple[str, str]]:
    """How much and when."""
    at = {"force": p.heaviest, "peak": int(np.argmax(p.peak))}
    when = {name: f"at {course.at(k)} (frame {k + 1} of {len(p.peak)})" for name, k in at.items()}
    lines = [
        ("Largest contact force", f"{p.force['total'][at['force']]:.0f} N {when['force']}"),
        ("Largest contact pressure", f"{p.peak[at['peak']] * MPA:.1f} MPa {when['peak']}"),
    ]
    x, y, z = p.centre["total"][at["force"]] * MM
    if np.isfinite(x):
        whole = p.force["total"][at["force"]]
        where = [f"x {x:.1f}, y {y:.1f}, z {z:.1f} mm"]
        shares = [f"{values[at['force']] / whole:.0%} {side}" for side, values in p.force.items() if side != "total"]
        where += [", ".join(shares)] if shares else []
        lines.append(("Centre of pressure under the largest force", "; ".join(where)))
    return lines


def pressure_sections(p: Pressures, frames: Int[np.ndarray, " k"]) -> list[Section]:
    """Numbers of the frame shown, curves over time, and the static figure."""
    centre = p.centre["total"][frames] * MM
    parts = {side: values[frames] for side, values in p.force.items()}
    rows = [Row(f"force, {side}", "N", _texts(values, 1)) for side, values in parts.items()]
    rows += [
        Row("largest pressure", "MPa", _texts(p.peak[frames] * MPA, 2)),
        Row("area under pressure", "mm²", _texts(p.area[frames] * MM2, 2)),
        *(Row(f"centre of pressure {axis}", "mm", _texts(centre[:, k], 2)) for k, axis in enumerate("xyz")),
    ]
    sides = {side: values[frames] * MM for side, values in p.centre.items()}
    ways = [
        Curve(f"{side} {axis}", values[:, k])
        for side, values in sides.items()
        for k, axis in enumerate("xyz")
        if side == "total" or len(sides) == 1 or axis != "y"
    ]
    return [
        Readout(rows, title="Pressure in this frame"),
        Curves("Contact force, elastic foundation", "N", [Curve(side, values) for side, values in parts.items()]),
        Curves("Largest contact pressure", "MPa", [Curve("largest pressure", p.peak[frames] * MPA)]),
        Curves("Centre of pressure", "mm", ways),
        p.picture,
    ]


def pressure_words(p: Pressures) -> Words:
    """What the pressures rest on, and how far to trust them."""
    thin, thick = (length * MM for length in p.thickness)
    largest = float(p.force["total"].max())
    other = "rigid" if np.isinf(p.other_modulus) else f"another one of {p.other_modulus * MPA:.4g} MPa"
    layer = (
        f"FIXED is an elastic layer on a rigid base ({p.law} law, confined modulus {p.modulus * MPA:.4g} MPa, "
        f"thickness {thin:.3g} … {thick:.3g} mm where it is pressed) and MOVING is {other}. Each place of "
        "the layer carries the pressure of its own depth: what a patch does to the surface beside it, friction and "
        "creep are left out."
    )
    more = p.modulus * DEEPER / p.thickness[0] * MPA
    pose = (
        f"The pose decides: {DEEPER * MM:g} mm deeper is up to {more:.3g} MPa more. Recorded poses rarely know where "
        "surfaces are to that; maps from them show where, not how much."
    )
    off = abs(largest - p.finer) / p.finer if p.finer > 0.0 else 0.0
    error = (
        f"Pieces of half the size change the largest force by {off:.2%}. How the triangles resemble the surfaces is "
        "not in that number: repeat with a finer mesh."
    )
    shown, peak = max(float(each.max()) for each in p.maps.values()) * MPA, float(p.peak.max()) * MPA
    colours = (
        f"The colours are means over faces, up to {shown:.3g} MPa; the largest pressure of a piece is {peak:.3g} MPa. "
        "The two are alike where faces are small against the patch."
    )
    return Words("Pressures", [layer, pose, error, colours])


def _texts(values: Float[np.ndarray, " k"], digits: int) -> list[str]:
    return ["–" if np.isnan(value) else f"{value:.{digits}f}" for value in values]
