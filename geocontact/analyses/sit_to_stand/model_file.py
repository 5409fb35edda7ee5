"""The chains with their contacts as an OpenSim model that solution_NAME.sto solves.

A sphere slides and is pressed where OpenSim's is, half of its depth below the ground, and straps are its bushings: the
accelerations of the equations are those of the model.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from geocontact.io.opensim.osim_contact_forces import bushing_force_between, smooth_sphere_force, torque_along
from geocontact.io.opensim.osim_writer import ContactBall, write_osim
from geocontact.standing_up.chain import Subject, leg_chain
from geocontact.standing_up.exoskeleton import two_chains
from geocontact.standing_up.feet import FRICTION
from geocontact.standing_up.strap_sites import StrapSite, sites_of

NOTE = "Both legs are one planar chain: masses, torques, contacts and bushings are those of both."


def write_standing_model(file: Path, subject: Subject, values: Mapping[str, float], *, worn: bool) -> None:
    """Spheres under the foot, straps as bushings where an exoskeleton is worn, torques of all joints.

    Parameters
    ----------
    values
        Of the parameters of feet and straps, in SI.
    """
    chain = two_chains(subject) if worn else leg_chain(subject)
    height, factor = values["radius"] - values["bottom"], values["friction"]
    friction = [float(each) for each in (FRICTION.v_t, FRICTION.mu_s * factor, FRICTION.mu_d * factor, FRICTION.mu_v)]
    balls = [
        ContactBall(name, "foot", np.array([values[name], height, 0.0]), values["radius"]) for name in ("heel", "toe")
    ]
    forces = [smooth_sphere_force(each.name, values["stiffness"], values["dissipation"], friction) for each in balls]
    if worn:
        forces += [_bushing(site, values) for site in sites_of(values)]
    forces += [torque_along(each.name) for each in chain.coordinates[3:]]
    write_osim(file, replace(chain, name="sit_to_stand"), balls=balls, forces=forces, note=NOTE)


def _bushing(site: StrapSite, values: Mapping[str, float]) -> Element:
    """Of all straps of a site; called strap at the thigh, and shank_strap, pelvis_strap."""
    normal, tangential, turning, place = (values[name] for name in site.names)
    there = np.array([0.0, place, 0.0])
    ends = [(site.person, there), (site.device, there - [0.0, site.above, 0.0])]
    turns, moves = np.array([0.0, 0.0, site.count]), np.array([site.count, site.count, 0.0])
    stiff = turns * turning, moves * [normal, tangential, 0.0]
    name = site.names[0].removesuffix(" normal").replace(" ", "_")
    return bushing_force_between(name, ends, stiff, (turns * site.turning_damping, moves * site.damping))
