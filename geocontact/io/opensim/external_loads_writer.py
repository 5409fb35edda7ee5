"""OpenSim's external loads (.xml) for forces of a .mot file, as `external_loads.read_external_loads` reads them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from xml.sax.saxutils import escape, quoteattr

FORCE = """\t\t\t<ExternalForce name={name}>
\t\t\t\t<applied_to_body>{body}</applied_to_body>
\t\t\t\t<force_expressed_in_body>{frame}</force_expressed_in_body>
\t\t\t\t<point_expressed_in_body>{frame}</point_expressed_in_body>
\t\t\t\t<force_identifier>{stem}_v</force_identifier>
\t\t\t\t<point_identifier>{stem}_p</point_identifier>
\t\t\t\t<torque_identifier>{torque}</torque_identifier>
\t\t\t</ExternalForce>
"""
WHOLE = """<?xml version="1.0" encoding="UTF-8" ?>
<OpenSimDocument Version="40000">
\t<ExternalLoads name="externalloads">
\t\t<objects>
{forces}\t\t</objects>
\t\t<groups />
\t\t<datafile>{data}</datafile>
\t</ExternalLoads>
</OpenSimDocument>
"""


def write_external_loads(
    path: Path, data: str, bodies: Mapping[str, str], *, torques: bool = False, frame: str = "ground"
) -> None:
    """Forces in the ground's frame or a body's, with torques or without.

    Parameters
    ----------
    data
        Name of the .mot file beside this one, with columns STEM_vx … and STEM_px ….
    bodies
        Body that each force acts on, by its stem, which holds the word "force".
    torques
        Whether there are columns of torques, named as those of the force with the word "torque": left_torque_x for
        left_force_vx.
    frame
        Body in whose frame forces, points and torques are.
    """
    forces = "".join(
        FORCE.format(
            name=quoteattr(stem),
            body=escape(body),
            frame=escape(frame),
            stem=escape(stem),
            torque=escape(stem.replace("force", "torque") + "_") if torques else "",
        )
        for stem, body in bodies.items()
    )
    path.write_text(WHOLE.format(forces=forces, data=escape(data)), encoding="utf-8")
