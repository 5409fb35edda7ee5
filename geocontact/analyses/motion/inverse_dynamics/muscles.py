"""Muscle forces of a motion, and the contact force of a joint: made by the muscles alone, or held as measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float, Int

from geocontact.analyses.frame.collector import add_input, contradicted, judge, reserve, say
from geocontact.analyses.motion.inverse_dynamics.loads import Loaded
from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.data.errors import InputError
from geocontact.dynamics.inverse_dynamics import force_across
from geocontact.dynamics.static_optimisation import Contact, MuscleForces, static_optimisation
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit
from geocontact.identify.signals.filters import gaps, in_gaps
from geocontact.io.opensim.muscle_paths import MusclePaths, muscle_paths
from geocontact.io.recordings.area_table import read_force_curves
from geocontact.io.text.tables import listed
from geocontact.trial_checks.channel_checks import odd_rate
from geocontact.view.curves.declared import INK, Curve, Curves, stroke

if TYPE_CHECKING:
    from geocontact.data.multibody.model import Multibody
    from geocontact.dynamics.residuals import GeneralisedForces
    from geocontact.dynamics.tree import Tree

PRESSED = 30.0
"""N, that measured contact forces of a knee reach in every movement: the shank alone weighs as much."""
IDLE = 1.0
"""N m; a coordinate about which all muscles together make less in every frame is left to no muscle."""
MISSED = 0.05
"""Share of a coordinate's largest moment that reserves may make (Hicks et al. 2015), and of a held force."""
SHOWN = 6
"""Muscles that are drawn: those that work most."""


@dataclass(frozen=True, eq=False)
class EstimatedMuscles:
    """Muscles along a motion.

    Parameters
    ----------
    alone
        The contact force follows from the muscles.
    held
        It is held as measured; None without a measured one.
    contact
        Of `across`, with the measured compression; None without such a body.
    driven
        Coordinates that muscles drive.
    """

    paths: MusclePaths
    alone: MuscleForces
    held: MuscleForces | None
    contact: Contact | None
    across: str
    driven: tuple[str, ...]

    @property
    def told(self) -> MuscleForces:
        """With the measured contact where there is one."""
        return self.alone if self.held is None else self.held


def estimated_muscles(given: Loaded, tree: Tree, forces: GeneralisedForces, o: IdOptions) -> EstimatedMuscles | None:
    """Static optimisation of every frame; None unless asked for."""
    if not o.muscles:
        return None
    names = [c.name for c in given.model.coordinates]
    beyond = () if o.across is None else beyond_joint(given.model, o.across)
    paths = muscle_paths(o.model, names, given.shown, beyond)
    reach = np.abs(np.einsum("tmn,m->tmn", paths.arms, paths.strongest)).sum(axis=1).max(axis=0)
    driven = np.flatnonzero((reach > IDLE) & ~forces.at_ground & independent(given.model))
    _warn_of_coupled(given.model, [names[k] for k in driven])
    arms, moments = paths.arms[:, :, driven], np.asarray(forces.values)[:, driven]
    contact = None if o.across is None else _contact(given, tree, paths, o)
    try:
        alone = static_optimisation(paths.strongest, arms, moments, None if contact is None else _unheld(contact))
        known = contact is not None and contact.held is not None
        held = static_optimisation(paths.strongest, arms, moments, contact) if known else None
    except ValueError as error:
        raise InputError(o.coordinates, "`muscles`", str(error), "leave these times out, or the option") from error
    found = EstimatedMuscles(paths, alone, held, contact, o.across or "", tuple(names[k] for k in driven))
    _report(found, moments)
    return found


def independent(model: Multibody) -> Bool[np.ndarray, " n"]:
    """Coordinates that muscles can drive: neither locked, which a lock holds, nor functions of others."""
    dependent = {coupler.dependent for coupler in model.couplers}
    return np.array([not c.locked and c.name not in dependent for c in model.coordinates])


def _warn_of_coupled(model: Multibody, driven: Sequence[str]) -> None:
    coupled = tuple(each.dependent for each in model.couplers if set(each.of) & set(driven))
    if coupled:
        reserve(f"moments along {listed(coupled)}, functions of others, are not passed on to those: muscles lack them")


def beyond_joint(model: Multibody, body: str) -> tuple[str, ...]:
    """The body and all that it carries."""
    if body not in [each.name for each in model.bodies]:
        raise InputError("", "`across`", f"no body '{body}'", f"{listed(tuple(b.name for b in model.bodies))}")
    found = [body]
    for joint in model.joints:
        if joint.parent in found:
            found.append(joint.child)
    return tuple(found)


def _contact(given: Loaded, tree: Tree, paths: MusclePaths, o: IdOptions) -> Contact:
    """Along the y axis of the body, which is to point to the joint; compression is positive."""
    across = o.across or ""
    _warn_of_axis(given.model, across)
    force, turn = force_across(tree, across, given.recorded, given.values, given.time, given.loads)
    along = turn[:, :, 1]
    net = -np.einsum("ti,ti->t", force, along)
    pulls = np.einsum("tmi,ti->tm", paths.pulls, along)
    if not pulls.any():
        raise InputError(
            o.model, "`across`", f"no muscle crosses the joint of {across}", "name the body beyond a joint"
        )
    _warn_of_beside(given.model, paths, across)
    return Contact(pulls, net, _held(given, o))


def _warn_of_axis(model: Multibody, across: str) -> None:
    """Unless the mass centre lies within 45 degrees of -y, seen from the joint."""
    body = next(each for each in model.bodies if each.name == across)
    joint = next(each for each in model.joints if each.child == across)
    x, y, z = body.centre - joint.child_offset.translation
    if -y <= np.hypot(x, z):
        place = ", ".join(f"{1e3 * each:.0f}" for each in (x, y, z))
        what = f"the mass centre of {across} is at ({place}) mm from its joint, not along -y"
        reserve(f"{what}: compression is along the y axis, does that point to the joint?")


def _warn_of_beside(model: Multibody, paths: MusclePaths, across: str) -> None:
    """Muscles that turn the joint and pull at nothing beyond it: they end on a body beside, such as a patella."""
    own = {c.name for joint in model.joints if joint.child == across for c in joint.coordinates}
    columns = [k for k, c in enumerate(model.coordinates) if c.name in own]
    turns = (np.abs(paths.arms[:, :, columns]).max(axis=(0, 2), initial=0.0) * paths.strongest) > IDLE
    beside = tuple(paths.names[m] for m in np.flatnonzero(turns & ~paths.pulls.any(axis=(0, 2))))
    if beside:
        what = f"{listed(beside)} turn the joint of {across} from a body beside it (a patella?)"
        reserve(f"{what}: their compression is missing")


def _held(given: Loaded, o: IdOptions) -> Float[np.ndarray, " t"] | None:
    if o.held is None:
        return None
    curves = read_force_curves(o.held, o.held_unit, {})
    add_input("`held`", o.held, unit=curves.unit)
    for odd in odd_rate(str(o.held), "", curves.time):
        reserve(str(odd))
    if "total" not in curves.forces:
        raise InputError(o.held, "", "has no total", "give total, or medial and lateral")
    found = np.interp(given.time, curves.time, curves.forces["total"], left=np.nan, right=np.nan)
    found[in_gaps(given.time, gaps(curves.time))] = np.nan
    there = np.isfinite(found)
    if not there.any():
        span = f"{curves.time[0]:g} to {curves.time[-1]:g} s"
        raise InputError(o.held, "", f"no frame of the motion lies in its time ({span})", "are the clocks the same?")
    largest = float(np.abs(found[there]).max())
    if largest < PRESSED:
        what = f"its force is {largest:.3g} N at most where the motion is"
        reserve(f"{o.held}: {what}: is it in N, not in kN or parts of the body's weight?")
    if float(np.median(found[there])) < 0.0:
        reserve(f"{o.held}: its force is below 0 most of the time: compression is positive here; is its sign turned?")
    if not there.all():
        lacking = f"{int((~there).sum())} of {len(there)} frames lie outside its time or in gaps"
        reserve(f"{o.held}: {lacking}: muscles alone there")
    return np.asarray(found)


def _unheld(contact: Contact) -> Contact:
    return Contact(contact.pulls, contact.net)


def _report(found: EstimatedMuscles, moments: Float[np.ndarray, "t n"]) -> None:
    """How well muscles make the moments, the contact force, and what holding it costs."""
    for which, each in (("muscles alone", found.alone), ("contact held", found.held)):
        if each is not None:
            _warn(which, each, found.driven, moments)
    contact = found.contact
    if contact is None or contradicted():
        return
    peak = found.alone.compression.max() if found.alone.compression is not None else float("nan")
    without = contact.net.max()
    say(f"{found.across}: muscles alone press its joint with {peak:.0f} N at most, load alone with {without:.0f} N")
    if found.held is not None and contact.held is not None and found.held.compression is not None:
        there = np.isfinite(contact.held)
        off = float(np.sqrt(np.mean((found.alone.compression - contact.held)[there] ** 2)))
        kept = float(np.sqrt(np.mean((found.held.compression - contact.held)[there] ** 2)))
        more = np.square(found.held.activations).sum() / max(np.square(found.alone.activations).sum(), 1e-12)
        say(
            f"measured are {np.nanmax(contact.held):.0f} N at most: muscles alone are {off:.0f} N off (RMS); held to "
            f"{kept:.0f} N the squared activations are {more:.2f} times as large"
        )
        judge(_goodness(found.held.compression[there], contact.held[there]))


def _goodness(made: Float[np.ndarray, " t"], held: Float[np.ndarray, " t"]) -> GoodnessOfFit:
    """Whether muscles that make the moments can press as was measured."""
    most, largest = float(np.abs(made - held).max()), float(np.abs(held).max())
    what = f"contact held: the measured force is missed by up to {most:.0f} N, which no muscle makes with these moments"
    doubts = (Doubt(what, False, most / max(largest, IDLE)),) if most > MISSED * largest else ()
    return GoodnessOfFit(doubts, ("held contact force",))


def _warn(which: str, each: MuscleForces, driven: tuple[str, ...], moments: Float[np.ndarray, "t n"]) -> None:
    largest = np.abs(moments).max(axis=0)
    share = np.abs(each.missed).max(axis=0) / np.where(largest > 0.0, largest, 1.0)
    short = [k for k in np.argsort(-share) if share[k] > MISSED and np.abs(each.missed[:, k]).max() > IDLE]
    if short:
        k = int(short[0])
        what = (
            f"{driven[k]} lacks up to {np.abs(each.missed[:, k]).max():.3g} N m, {share[k]:.0%} of its largest moment"
        )
        more = f", {len(short) - 1} further coordinates as well" if len(short) > 1 else ""
        reserve(f"{which}: {what}{more}: muscles are too weak or too few, or the moments contradict the contact force")


def muscle_tables(found: EstimatedMuscles, time: Float[np.ndarray, " t"]) -> dict[str, pd.DataFrame]:
    """`muscles`: activation and force of each, with the contact held where it is known; `contact` of the joint."""
    told = found.told
    active = {f"{n} [-]": a for n, a in zip(found.paths.names, told.activations.T, strict=True)}
    tension = (told.activations * found.paths.strongest).T
    pulled = {f"{n}_force [N]": f for n, f in zip(found.paths.names, tension, strict=True)}
    tables = {"muscles": pd.DataFrame({"time [s]": time, **active, **pulled})}
    if found.contact is not None:
        columns = {"net [N]": found.contact.net, "muscles_alone [N]": found.alone.compression}
        if found.held is not None:
            columns |= {"held [N]": found.held.compression, "measured [N]": found.contact.held}
        tables["contact"] = pd.DataFrame({"time [s]": time, **columns})
    return tables


def muscle_curves(found: EstimatedMuscles | None, shown: Int[np.ndarray, " s"]) -> list[Curves]:
    """Contact force, and activations of the muscles that work most; nothing without muscles."""
    if found is None:
        return []
    panels, told = [], found.told
    if found.contact is not None and found.alone.compression is not None:
        lines = [Curve("muscles alone", found.alone.compression[shown], stroke=0)]
        lines += [Curve("load alone", found.contact.net[shown], stroke=1)]
        if found.held is not None and found.contact.held is not None:
            lines.insert(0, Curve("measured, held", found.contact.held[shown], stroke=INK))
        panels.append(Curves(f"Compression of the joint of {found.across}", "N", lines, words=CONTACT))
    work = np.square(told.activations * found.paths.strongest).sum(axis=0)
    most = np.argsort(-work)[:SHOWN]
    drawn = [
        Curve(found.paths.names[m], told.activations[shown, m], stroke=stroke(k, k))
        for k, m in enumerate(map(int, most))
    ]
    return [*panels, Curves("Activation of the muscles with the most force", "-", drawn, words=ACTIVE)]


CONTACT = (
    "Along the y axis of the body beyond the joint. Muscles alone: least squared activation, which has no reason to "
    "co-contract. Ligaments are not in it."
)
ACTIVE = "Force over the largest isometric one: no length, no speed, no tendon. Each frame by itself."
