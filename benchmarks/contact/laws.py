"""Contact laws against closed forms: `python -m benchmarks.contact.laws`.

Hertz's laws against their closed forms, evaluated with 50 digits, and against the half-space that they solve
(Boussinesq's integral); the elastic foundation under a rigid sphere against its closed form, with the order of
convergence over the edge of the triangles.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
R, E = 37e-3, 1e9
DEPTHS = tuple(10.0**power for power in range(-9, -2))  # m
RATIOS = (1.01, 1.5, 3.0, 10.0, 100.0, 1e4)
EDGES = (0.8e-3, 0.4e-3, 0.2e-3, 0.1e-3)  # m


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.contact.laws", description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import machine, versions

    report = {
        "machine": machine(),
        "versions": versions({"scipy"}),
        "largest_relative_error": {"point": point(), "line": line(), "ellipse": ellipse()},
        "half_space": half_space(),
        "foundation": [foundation(law) for law in ("linear", "logarithmic")],
    }
    text = json.dumps(report, indent=1)
    print(text)
    (options.out / "contact_laws.json").write_text(text + "\n", encoding="utf-8")


def point() -> float:
    """Of force, radius and peak pressure from 1 nm to 1 mm of depth."""
    from decimal import Decimal, localcontext

    from geocontact.contact.hertz import point_force, point_peak_pressure, point_radius

    worst = 0.0
    with localcontext() as context:
        context.prec = 50
        pi = Decimal("3.14159265358979323846264338327950288419716939937510")
        for depth in DEPTHS:
            d, r, e = Decimal(depth), Decimal(R), Decimal(E)
            force, a = Decimal(4) / 3 * e * (r * d * d * d).sqrt(), (r * d).sqrt()
            exact = (force, a, Decimal("1.5") * force / (pi * a * a))
            f = point_force(depth, R, E)
            ours = (f, point_radius(f, R, E), point_peak_pressure(f, R, E))
            worst = max(worst, *(abs(float(Decimal(float(o)) / x - 1)) for o, x in zip(ours, exact, strict=True)))
    return worst


def line() -> float:
    """Of half-width, peak pressure, and the load of that half-width, from 1 N/m to 1 MN/m."""
    from decimal import Decimal, localcontext

    from geocontact.contact.hertz import line_half_width, line_load, line_peak_pressure

    worst = 0.0
    with localcontext() as context:
        context.prec = 50
        pi = Decimal("3.14159265358979323846264338327950288419716939937510")
        for load in (10.0**power for power in range(7)):
            p, r, e = Decimal(load), Decimal(R), Decimal(E)
            exact = ((4 * p * r / (pi * e)).sqrt(), (p * e / (pi * r)).sqrt(), p)
            half = line_half_width(load, R, E)
            ours = (half, line_peak_pressure(load, R, E), line_load(half, R, E))
            worst = max(worst, *(abs(float(Decimal(float(o)) / x - 1)) for o, x in zip(ours, exact, strict=True)))
    return worst


def ellipse() -> float:
    """Of axis ratio, K, S and force for B/A from 1.01 to 1e4, by SciPy's elliptic integrals and a bracketed root.

    Force: 2/3 pi a b p0, with the half axes and the peak pressure that K and S by the other way make.
    """
    import numpy as np

    from geocontact.contact.hertz import ellipse_force, ellipse_shape
    from tests.contact.half_space import by_root

    depth, flatter = 2e-4, 4.0
    pairs = []
    for ratio in RATIOS:
        shape, (q, k, s) = ellipse_shape(ratio), by_root(ratio)
        a = np.sqrt(s * depth / flatter)
        force = 2.0 / 3.0 * np.pi * a * (q * a) * (E * depth / (q * a * k))
        pairs.append(((*shape, ellipse_force(depth, flatter, E, *shape[1:])), (q, k, s, force)))
    return float(max(np.max(np.abs(np.divide(ours, exact) - 1.0)) for ours, exact in pairs))


def half_space() -> dict[str, float]:
    """How far the loaded surface is from the other body, as a share of the depth; within the patch, by B/A."""
    from geocontact.contact.hertz import ellipse_half_axis, ellipse_peak_pressure, ellipse_shape
    from tests.contact.half_space import displacement

    depth, flatter, off = 2e-4, 4.0, {}
    for ratio in (1.0, 2.0, 25.0):
        q, k, s = ellipse_shape(ratio)
        a = ellipse_half_axis(depth, flatter, s)
        p0 = ellipse_peak_pressure(depth, a, q, k, E)
        places = [(x * a, y * q * a) for x, y in ((0.0, 0.0), (0.5, 0.0), (0.0, 0.7), (0.6, -0.5))]
        gaps = [displacement(x, y, a, q * a, p0, E) - depth + flatter * (x * x + ratio * y * y) for x, y in places]
        off[f"{ratio:g}"] = max(abs(gap) for gap in gaps) / depth
    return off


def foundation(law: str) -> dict[str, object]:
    """Relative error of the force of a sphere in a layer by edge, root mean square over seeds, and the order."""
    import numpy as np

    from geocontact.contact import elastic_foundation
    from tests.contact import sphere_on_layer
    from tests.contact.test_elastic_foundation import D, H, M, R, pressed

    exact = getattr(sphere_on_layer, f"{law}_force")(R, D, H, M)
    pressure = getattr(elastic_foundation, f"{law}_pressure")
    errors = [
        float(np.sqrt(np.mean([(pressed(pressure, edge, seed).pressing / exact - 1.0) ** 2 for seed in range(6)])))
        for edge in EDGES
    ]
    order = float(np.polyfit(np.log(EDGES), np.log(errors), 1)[0])
    return {"law": law, "closed_form_N": exact, "edge_m": EDGES, "relative_error": errors, "order": round(order, 2)}


if __name__ == "__main__":
    main()
