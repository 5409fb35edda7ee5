"""Published contact areas of knees, each with the text in which its number was read.

A row is here only where its number, or the load and the average stress that it follows from, stands in a text that can
be opened. Most of what is published are diagrams; abstracts with areas of total knee implants are few.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, radians
from typing import Literal

Knee = Literal["total knee implant", "half knee implant", "natural knee"]
Part = Literal["total", "medial", "lateral"]
Basis = Literal["measured under load", "computed under load", "within a distance"]


@dataclass(frozen=True)
class PublishedArea:
    """One published contact area.

    Parameters
    ----------
    name
        First author, year, and what was loaded.
    knee
        What kind of knee it is of.
    basis
        A film or a sensor marks where surfaces press; a distance counts surfaces that need not touch.
    method
        How it was measured or computed, in words.
    side
        Part of the knee: "total", "medial" or "lateral".
    flexion
        Least and largest flexion [rad]; None where the text does not say, or the number is the peak of a walk.
    load
        Load on the knee [N]; None where the text does not say.
    least, most
        The published range [m^2]; both ends are one number where the text has one. 0 and infinity are open ends.
    sd
        Standard deviation [m^2]; None where none was read.
    threshold
        Distance within which the area was counted [m]; None for what was loaded.
    citation, doi
        The publication; without a doi where the text read does not state one.
    read_in
        The text in which the number was read.
    """

    name: str
    knee: Knee
    basis: Basis
    method: str
    side: Part
    flexion: tuple[float, float] | None
    load: float | None
    least: float
    most: float
    citation: str
    doi: str
    read_in: str
    sd: float | None = None
    threshold: float | None = None


MM2 = 1e-6
MPA = 1e6
STRAIGHT = (0.0, 0.0)

CADAVER = (
    "Fukubayashi et al., The contact area and pressure distribution pattern of the knee, Acta Orthop Scand 51, 1980, "
    "871-879"
)
FILM_1995 = (
    "Tibiofemoral contact stress and stress distribution evaluation of total knee arthroplasties, J Arthroplasty 10, "
    "1995, 480-491"
)
FILM_1996 = (
    "Szivek, Anderson & Benjamin, Average and peak contact stress distribution evaluation of total knee arthroplasties"
)
FITTED = (
    "Steklov, Slamin, Srivastav & D'Lima, Unicompartmental knee resurfacing: enlarged tibio-femoral contact area and "
    "reduced contact stress using novel patient-derived geometries, Open Biomed Eng J 4, 2010, 85-92"
)
ELEMENTS = (
    "Devaraj, Acharya & Adhikari, Comparison of biomechanical parameters between medial and lateral compartments of "
    "human knee joints, Open Biomed Eng J 14, 2020, 74"
)
HERTZIAN = "The Hertzian integrated contact model of a total knee implant, J Comput Med, 2015, 945379"

FORCE = 2000.0
"""Load of the films of 1995 and 1996 [N]."""
AVERAGE = "Fuji film at 37 °C; the load over the average stress of {}"


def _loaded(stress: float) -> float:
    """Area on which the films' load has this average stress [Pa]."""
    return FORCE / stress


CARTILAGE: tuple[tuple[Part, float, float], ...] = (("medial", 701.0, 89.0), ("lateral", 617.0, 63.0))
"""Mean and SD of each side of the finite elements [mm^2]."""


PUBLISHED_AREAS: tuple[PublishedArea, ...] = (
    PublishedArea(
        "film 1995, seven implants",
        "total knee implant",
        "measured under load",
        AVERAGE.format("13 to 25 MPa"),
        "total",
        (0.0, radians(60.0)),
        FORCE,
        _loaded(25.0 * MPA),
        _loaded(13.0 * MPA),
        FILM_1995,
        "10.1016/s0883-5403(05)80150-0",
        "abstract, https://pubmed.ncbi.nlm.nih.gov/8523008/",
    ),
    PublishedArea(
        "Szivek 1996, LCS, AMK constrained, PFC lipped",
        "total knee implant",
        "measured under load",
        AVERAGE.format("10 MPa or near, or less"),
        "total",
        (radians(15.0), radians(60.0)),
        FORCE,
        _loaded(10.0 * MPA),
        inf,
        FILM_1996,
        "",
        "abstract, https://experts.arizona.edu/en/publications/average-and-peak-contact-stress-distribution-evaluation-of-total-",
    ),
    PublishedArea(
        "Szivek 1996, AMK Hylamer-M, MG II",
        "total knee implant",
        "measured under load",
        AVERAGE.format("20 MPa or near, or more"),
        "total",
        (radians(15.0), radians(60.0)),
        FORCE,
        0.0,
        _loaded(20.0 * MPA),
        FILM_1996,
        "",
        "abstract, https://experts.arizona.edu/en/publications/average-and-peak-contact-stress-distribution-evaluation-of-total-",
    ),
    *(
        PublishedArea(
            f"Steklov 2010, fitted half implant, {phase}",
            "half knee implant",
            "measured under load",
            "mean of the specimens; load and flexion of the phase are not in the abstract",
            "total",
            None,
            None,
            area * MM2,
            area * MM2,
            FITTED,
            "10.2174/1874120701004010085",
            "abstract, https://pmc.ncbi.nlm.nih.gov/articles/PMC2866246/",
            sd=sd * MM2,
        )
        for phase, area, sd in (("heel strike", 81.0, 5.0), ("toe off", 96.0, 5.0), ("mid-stance", 74.0, 4.0))
    ),
    *(
        PublishedArea(
            f"Fukubayashi 1980, {menisci} menisci",
            "natural knee",
            "measured under load",
            "casting and sensor sheets, seven knees",
            "total",
            STRAIGHT,
            1000.0,
            area * MM2,
            area * MM2,
            CADAVER,
            "10.3109/17453678008990887",
            "abstract, https://scienceopen.com/document?vid=bd83c3ee-286e-437c-96c2-a7906ec4b721",
        )
        for menisci, area in (("with", 1150.0), ("without", 520.0))
    ),
    *(
        PublishedArea(
            f"Devaraj 2020, {side} cartilage",
            "natural knee",
            "computed under load",
            "finite elements",
            side,
            STRAIGHT,
            1150.0,
            area * MM2,
            area * MM2,
            ELEMENTS,
            "10.2174/1874120702014010074",
            "abstract, https://openbiomedicalengineeringjournal.com/VOLUME/14/PAGE/74/FULLTEXT/",
            sd=sd * MM2,
        )
        for side, area, sd in CARTILAGE
    ),
    PublishedArea(
        "JW 2015, peak of five walks",
        "total knee implant",
        "within a distance",
        "rigid surfaces, least distance up to 4 mm",
        "total",
        None,
        None,
        1016.0 * MM2,
        1117.0 * MM2,
        HERTZIAN,
        "10.1155/2015/945379",
        "full text, https://www.hindawi.com/journals/jcm/2015/945379/",
        threshold=4e-3,
    ),
)
"""Implants first, then natural knees, then areas that were computed from distances."""
