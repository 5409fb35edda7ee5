"""Figures 2 to 9 of Serrancoli et al. (2019), in their form, of a user's trials.

Phase A: 2, force of the ground and its centre of pressure; 3, angles and angular velocities of both chains. Phase B: 4,
normal forces of the straps; 5, moments of both chains. Phase C: 6, angles and angular velocities; 7, forces of the
straps, by calibrated and by perturbed contacts. 8 and 9, both contact laws: the normal force over the indentation, and
the coefficient of friction over the speed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from geocontact.analyses.sit_to_stand.rmsd_by_trial import VARIABLES
from geocontact.analyses.sit_to_stand.show import PARTS, at_parts
from geocontact.analyses.sit_to_stand.trial_tables import channels
from geocontact.contact.smooth_half_space import half_space_coefficient, half_space_force
from geocontact.contact.smooth_hunt_crossley import smoothed_sphere_force, stribeck_coefficient
from geocontact.data.motion import Course
from geocontact.standing_up.chain import FRICTION, GROUND_LAW
from geocontact.standing_up.trial_result import TrialResult
from geocontact.standing_up.trials import StandingNoise
from geocontact.view.curves.declared import Curve, Curves, CurveSheet, stroke

GROUND = ("force_x", "force_y", "centre")
KINEMATICS = (*VARIABLES["angles"], *VARIABLES["angular velocities"])
STRAPS = ("pelvis strap", "strap", "shank strap")
MOMENTS = (*VARIABLES["moments of the person"], *VARIABLES["moments of the exoskeleton"])
ROUNDING, SLOPE = 1e-3, 0.5
"""Smooth positive part [m] and slope term [N] of the printed law, which prints no number for either; invented."""


def study_figure(names: Sequence[str], shown: Mapping[str, TrialResult], noise: StandingNoise) -> CurveSheet:
    """A panel for each channel: by the model, and dashed as recorded, once for all of the same trial.

    Parameters
    ----------
    names
        Channels in the order of the panels; those that no trial has are left out.
    shown
        Trials by what their curves are called.
    """
    panels: dict[str, list[Curve]] = {}
    units = {}
    for k, (label, trial) in enumerate(shown.items()):
        first = next(j for j, other in enumerate(shown.values()) if other.recorded is trial.recorded)
        for each in channels(trial.recorded, trial.model, noise):
            if each.name not in names or not np.isfinite(each.model).all():
                continue
            curves, units[each.name] = panels.setdefault(each.name, []), each.unit
            if first == k and np.isfinite(each.recorded).all():
                recorded = each.factor * at_parts(trial, each.recorded)
                curves.append(Curve(f"{trial.recorded.name} recorded", recorded, stroke=stroke(4, 1 + k % 7)))
            curves.append(Curve(label, each.factor * at_parts(trial, each.model), stroke=stroke(k % 4, k // 4)))
    return CurveSheet([Curves(name, units[name], panels[name]) for name in names if name in panels], PARTS)


def contact_laws(values: Mapping[str, float]) -> CurveSheet:
    """Figures 8 and 9: the law that ran, OpenSim's, beside the printed one, with calibrated numbers of the feet.

    Parameters
    ----------
    values
        Of the feet, by name, in SI.
    """
    law = GROUND_LAW
    depth = np.linspace(-4e-3, 8e-3, 241)
    sphere = values["stiffness"], values["radius"], values["dissipation"]
    force = {
        "OpenSim's": half_space_force(depth, 0.0, *sphere, law.hertz, law.hunt_crossley, law.constant),
        "as printed": smoothed_sphere_force(depth, 0.0, *sphere, ROUNDING, law.hertz, law.hunt_crossley, SLOPE),
    }
    speed = np.linspace(-4.0, 4.0, 321) * FRICTION.v_t
    numbers = FRICTION.v_t, FRICTION.mu_s * values["friction"], FRICTION.mu_d * values["friction"], FRICTION.mu_v
    rubbing = {
        "OpenSim's": half_space_coefficient(speed, *numbers),
        "as printed": stribeck_coefficient(speed, *numbers),
    }
    near = np.abs(depth) <= 1e-3
    close, whole = (Course("indentation", "mm", 1e3 * each) for each in (depth[near], depth))
    begins = [Curve(name, np.asarray(each)[near]) for name, each in force.items()]
    along = Course("speed", "m/s", speed)
    return CurveSheet(
        [
            Curves("Normal force of a sphere at rest", "N", _each(force), over=whole),
            Curves("The same where it begins", "N", begins, over=close),
            Curves("Coefficient of friction", "-", _each(rubbing), over=along),
        ],
        whole,
    )


def _each(laws: Mapping[str, object]) -> list[Curve]:
    return [Curve(name, np.asarray(values)) for name, values in laws.items()]
