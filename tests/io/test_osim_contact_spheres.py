"""Contact spheres of OpenSim models: the force that presses them is OpenSim's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.opensim.osim_contact import read_contact_spheres
from tests import opensim_oracle
from tests.cli.calls import call, done
from tests.elsewhere import Elsewhere

BALLS = {"heel": (0.04, (-0.1, 0.0, 0.01)), "toe": (0.025, (0.12, 0.0, -0.02))}
"""Radius [m] and centre in the foot [m]."""
NONE = "<dissipation>0</dissipation>" + "".join(
    f"<{kind}_friction>0</{kind}_friction>" for kind in ("static", "dynamic", "viscous")
)
SETS = f"""<HuntCrossleyForce::ContactParameters><geometry>{{}}</geometry><stiffness>{{}}</stiffness>{NONE}
</HuntCrossleyForce::ContactParameters>"""
HUNT = f"""<HuntCrossleyForce name="c"><HuntCrossleyForce::ContactParametersSet><objects>{SETS.format("heel toe", 2e6)}
{SETS.format("floor", 5e7)}</objects></HuntCrossleyForce::ContactParametersSet></HuntCrossleyForce>"""
SMOOTH = "".join(
    f"""<SmoothSphereHalfSpaceForce name="{name}"><socket_sphere>/contactgeometryset/{name}</socket_sphere>
<socket_half_space>/contactgeometryset/floor</socket_half_space><stiffness>3e6</stiffness>{NONE}
</SmoothSphereHalfSpaceForce>"""
    for name in BALLS
)


def model(folder: Path, forces: str) -> Path:
    """A foot of 1 kg in a plane, without gravity, over a floor."""
    balls = "".join(
        f"""<ContactSphere name="{name}"><socket_frame>/bodyset/foot</socket_frame><radius>{radius}</radius>
<location>{" ".join(map(str, centre))}</location></ContactSphere>"""
        for name, (radius, centre) in BALLS.items()
    )
    text = f"""<?xml version="1.0"?><OpenSimDocument Version="40000"><Model name="synthetic_foot">
<gravity>0 0 0</gravity><Ground name="ground"/><BodySet><objects><Body name="foot"><mass>1</mass>
<mass_center>0 0 0</mass_center><inertia>1 1 1 0 0 0</inertia></Body></objects></BodySet><JointSet><objects>
<PlanarJoint name="base"><socket_parent_frame>/ground</socket_parent_frame>
<socket_child_frame>/bodyset/foot</socket_child_frame><coordinates><Coordinate name="rz"/><Coordinate name="tx"/>
<Coordinate name="ty"/></coordinates></PlanarJoint></objects></JointSet><ContactGeometrySet><objects>{balls}
<ContactHalfSpace name="floor"><socket_frame>/ground</socket_frame><orientation>0 0 -1.5707963267948966</orientation>
</ContactHalfSpace></objects></ContactGeometrySet><ForceSet><objects>{forces}</objects></ForceSet></Model>
</OpenSimDocument>"""
    (folder / "foot.osim").write_text(text)
    return folder / "foot.osim"


@pytest.mark.parametrize(("forces", "rounded", "near"), [(HUNT, 0.0, 1e-9), (SMOOTH, 1e-5, 6e-3)])
def test_the_force_is_that_of_opensim(
    tmp_path: Path, opensim: Elsewhere, forces: str, rounded: float, near: float
) -> None:
    """10 mm deep at the heel, 25 at the toe; the smooth form has d^2 + 1e-5 for d^2."""
    file = model(tmp_path, forces)
    with pytest.warns(InputWarning, match="dissipation and friction"):
        spheres = read_contact_spheres(file, "foot")
    assert spheres.zone == ("heel", "toe") and spheres.exponent == 1.5 and spheres.stiffness is not None
    rest = np.array([[0.0, 0.0, 0.02]])
    depth = spheres.radius - (spheres.centre[:, 1] + 0.02)
    up = opensim(opensim_oracle.accelerations, file, ("rz", "tx", "ty"), rest, 0.0 * rest)[0, 2]
    assert float((spheres.stiffness * (depth**2 + rounded) ** 0.75).sum()) == pytest.approx(up, rel=near)


def test_a_foot_of_a_model_gives_a_centre_of_pressure(tmp_path: Path) -> None:
    file = model(tmp_path, HUNT)
    rows = "".join(f"{0.1 * k},0,0.02,0,1,0,0,0\n" for k in range(3))
    (tmp_path / "still.csv").write_text(f"time [s],tx [m],ty [m],tz [m],qw,qx,qy,qz\n{rows}")
    out = tmp_path / "out"
    result = done(call("cop", file, "--body", "foot", "--motion", tmp_path / "still.csv", "--out", out, folder=out))
    table = result.table("cop.csv")
    with pytest.warns(InputWarning):
        spheres = read_contact_spheres(file, "foot")
    each = np.asarray(spheres.stiffness) * (spheres.radius - 0.02) ** 1.5
    np.testing.assert_allclose(table["force_y [N]"], each.sum(), rtol=1e-9)
    np.testing.assert_allclose(table["cop_x [m]"], each @ spheres.centre[:, 0] / each.sum(), rtol=1e-6)


def test_a_model_without_forces_has_no_stiffness(tmp_path: Path) -> None:
    spheres = read_contact_spheres(model(tmp_path, ""), "foot")
    assert spheres.stiffness is None and spheres.exponent is None


@pytest.mark.parametrize(("body", "said"), [(None, "the foot is not named"), ("shank", "no contact sphere on shank")])
def test_the_body_is_asked_for(tmp_path: Path, body: str | None, said: str) -> None:
    with pytest.raises(InputError, match=f"{said}; spheres are on foot"):
        read_contact_spheres(model(tmp_path, HUNT), body)
