"""STEP files (AP214) written by hand: a box of planes and lines, and a sphere, in a unit that the text states."""

from __future__ import annotations

from itertools import pairwise

Triple = tuple[float, float, float]

UNITS = {"m": "$", "cm": ".CENTI.", "mm": ".MILLI.", "um": ".MICRO."}
SIDES = (
    ((0, 1, 3, 2), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    ((4, 6, 7, 5), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    ((0, 4, 5, 1), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
    ((2, 3, 7, 6), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    ((0, 2, 6, 4), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)),
    ((1, 5, 7, 3), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)),
)
"""Corners of each side of a box, its normal, and a direction in it."""


class Entities:
    """Entities of a file, numbered from 1."""

    def __init__(self) -> None:
        self.texts: list[str] = []

    def add(self, text: str) -> str:
        self.texts.append(text)
        return f"#{len(self.texts)}"

    def point(self, at: Triple) -> str:
        return self.add(f"CARTESIAN_POINT('',({at[0]:.9f},{at[1]:.9f},{at[2]:.9f}))")

    def direction(self, way: Triple) -> str:
        return self.add(f"DIRECTION('',({way[0]:.9f},{way[1]:.9f},{way[2]:.9f}))")

    def frame(self, at: Triple, z: Triple, x: Triple) -> str:
        return self.add(f"AXIS2_PLACEMENT_3D('',{self.point(at)},{self.direction(z)},{self.direction(x)})")

    def face(self, edges: list[str], surface: str) -> str:
        loop = self.add(f"EDGE_LOOP('',({','.join(edges)}))")
        bound = self.add(f"FACE_BOUND('',{loop},.T.)")
        return self.add(f"ADVANCED_FACE('',({bound}),{surface},.T.)")

    def file(self, faces: list[str], unit: str) -> str:
        """The whole text, of a solid that these faces bound."""
        shell = self.add(f"CLOSED_SHELL('',({','.join(faces)}))")
        solid, length = self.add(f"MANIFOLD_SOLID_BREP('',{shell})"), self._length(unit)
        angle = self.add("( NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.) )")
        solid_angle = self.add("( NAMED_UNIT(*) SI_UNIT($,.STERADIAN.) SOLID_ANGLE_UNIT() )")
        context = self.add(
            f"( GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{angle},{solid_angle})) "
            "REPRESENTATION_CONTEXT('','3D') )"
        )
        origin = self.frame((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
        shape = self.add(f"ADVANCED_BREP_SHAPE_REPRESENTATION('',({origin},{solid}),{context})")
        application = self.add("APPLICATION_CONTEXT('automotive_design')")
        use = self.add(f"PRODUCT_CONTEXT('',{application},'mechanical')")
        product = self.add(f"PRODUCT('body','body','',({use}))")
        formation = self.add(f"PRODUCT_DEFINITION_FORMATION('','',{product})")
        part = self.add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{application},'design')")
        definition = self.add(f"PRODUCT_DEFINITION('design','',{formation},{part})")
        of_shape = self.add(f"PRODUCT_DEFINITION_SHAPE('','',{definition})")
        self.add(f"SHAPE_DEFINITION_REPRESENTATION({of_shape},{shape})")
        body = "\n".join(f"#{k} = {text};" for k, text in enumerate(self.texts, 1))
        return (
            "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('synthetic'),'2;1');\n"
            "FILE_NAME('body','2026-01-01T00:00:00',(''),(''),'','','');\n"
            f"FILE_SCHEMA(('AUTOMOTIVE_DESIGN {{ 1 0 10303 214 1 1 1 1 }}'));\nENDSEC;\nDATA;\n{body}\nENDSEC;\n"
            "END-ISO-10303-21;\n"
        )

    def _length(self, unit: str) -> str:
        if unit != "in":
            return self.add(f"( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT({UNITS[unit]},.METRE.) )")
        base = self.add("( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) )")
        measure = self.add(f"LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),{base})")
        exponents = self.add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)")
        return self.add(f"( CONVERSION_BASED_UNIT('INCH',{measure}) LENGTH_UNIT() NAMED_UNIT({exponents}) )")


def box(sizes: Triple, unit: str) -> str:
    """A box from the origin to (x, y, z)."""
    made = Entities()
    x, y, z = sizes
    corners = [(a, b, c) for a in (0.0, x) for b in (0.0, y) for c in (0.0, z)]
    vertices = [made.add(f"VERTEX_POINT('',{made.point(at)})") for at in corners]
    edges: dict[tuple[int, int], str] = {}

    def edge(one: int, other: int) -> str:
        if (other, one) in edges:
            return made.add(f"ORIENTED_EDGE('',*,*,{edges[other, one]},.F.)")
        along = tuple(float(b > a) - float(b < a) for a, b in zip(corners[one], corners[other], strict=True))
        length = sum(abs(b - a) for a, b in zip(corners[one], corners[other], strict=True))
        vector = made.add(f"VECTOR('',{made.direction((along[0], along[1], along[2]))},{length:.9f})")
        line = made.add(f"LINE('',{made.point(corners[one])},{vector})")
        edges[one, other] = made.add(f"EDGE_CURVE('',{vertices[one]},{vertices[other]},{line},.T.)")
        return made.add(f"ORIENTED_EDGE('',*,*,{edges[one, other]},.T.)")

    faces = []
    for loop, normal, along in SIDES:
        around = [edge(one, other) for one, other in pairwise([*loop, loop[0]])]
        faces.append(made.face(around, made.add(f"PLANE('',{made.frame(corners[loop[0]], normal, along)})")))
    return made.file(faces, unit)


def sphere(radius: float, unit: str) -> str:
    """A sphere about the origin, cut along a meridian."""
    made = Entities()
    south, north = (made.add(f"VERTEX_POINT('',{made.point((0.0, 0.0, z))})") for z in (-radius, radius))
    circle = made.add(f"CIRCLE('',{made.frame((0.0, 0.0, 0.0), (0.0, -1.0, 0.0), (1.0, 0.0, 0.0))},{radius:.9f})")
    seam = made.add(f"EDGE_CURVE('',{south},{north},{circle},.T.)")
    ends = [made.add(f"ORIENTED_EDGE('',*,*,{seam},{way})") for way in (".T.", ".F.")]
    frame = made.frame((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    return made.file([made.face(ends, made.add(f"SPHERICAL_SURFACE('',{frame},{radius:.9f})"))], unit)
