"""A foot that did not stand flat: its height and pitch are sought beside the sole, and known numbers hold."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.below_knee_prosthesis.calibration.calibrate import calibrate
from geocontact.below_knee_prosthesis.calibration.recorded_stance import Errors, RecordedStance, stance_from_markers
from geocontact.below_knee_prosthesis.calibration.sole_residuals import SoleResiduals
from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.design.drawn import TrialErrors
from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from tests.below_knee_prosthesis.calibration.stances import planted, recorded
from tests.below_knee_prosthesis.socket_markers import markers_of, planted_stance

TURNED = np.radians(0.57)
PLANTED = np.array([22e3, 11e3, 15e3, 11e3, 52e3, 520.0, 200.0, 300.0, 300.0, 420.0, *[0.6] * 5])


def test_one_error_of_pitch_everywhere() -> None:
    told = [
        of.__dataclass_fields__["pitch_error"].default for of in (ProsthesisCalibrateOptions, ProsthesisDesignOptions)
    ]
    assert [*told, Errors().pitch, TrialErrors().pitch] == pytest.approx([np.radians(0.5)] * 4)


def test_a_foot_that_stood_on_its_heel_is_moved_back() -> None:
    """Turned about the heel, by hand: the middle of the keel is raised by the arm's sine, and the toes are up."""
    true = recorded()
    arm, e = 0.11, true.errors
    about_the_heel = RigidTransform.from_rotation(Rotation.from_euler("z", -TURNED))
    seen = replace(true, poses=true.poses * about_the_heel)
    height, pitch = arm * np.sin(TURNED) / e.standing, TURNED / e.pitch
    residuals = SoleResiduals.of([seen], vsf_foot())
    back = residuals.stance(np.concatenate([np.zeros(15), [height, pitch]]), 0)
    assert (back.poses.inv() * true.poses).rotation.magnitude().max() < 1e-12
    middle = np.array([arm, 0.0, 0.0])
    off = back.poses.apply(middle) - true.poses.apply(middle)
    assert np.abs(off).max() < 1e-3  # m: raised along the laboratory's y, whatever the foot's own pitch
    zones, values = planted()
    logs = np.log(values / zones.values_of(zones.usual))
    with_errors, without = (
        residuals.of_data(np.concatenate([logs, aside])) for aside in (np.array([height, pitch]), np.zeros(2))
    )
    assert np.mean(with_errors**2) < 0.25 * np.mean(without**2)


def test_height_and_pitch_have_their_priors() -> None:
    residuals = SoleResiduals.of([recorded()], vsf_foot())
    z = np.concatenate([np.zeros(15), [2.0, -1.0]])
    assert residuals(z)[-2:] == pytest.approx([2.0, -1.0])
    assert residuals.errors(z, 0) == pytest.approx((2.0 * np.hypot(0.5e-3, 0.11 * np.radians(0.5)), -np.radians(0.5)))
    assert residuals.errors(np.zeros(15), 0) == (0.0, 0.0)


def stood_out_of_flat() -> RecordedStance:
    """A simulated stance with inertia on a planted sole, exact markers; the foot stood 0.57 degrees from flat."""
    usual = vsf_foot()
    law = ZoneParameters(usual.sole, usual.law).law(PLANTED)
    truth = planted_stance(0.1174, 0.72, replace(usual, law=law))
    leg = truth.motion.leg
    turned = replace(leg, turn=leg.turn * Rotation.from_euler("z", TURNED))
    plate = PlateStance(truth.time, truth.force, truth.centre("ground"))
    given = markers_of(truth), turned, plate, truth.fulcrum, usual.keel.length
    return stance_from_markers(*given, cutoff=None, gap_limit=0.1)


@pytest.mark.slow
@pytest.mark.long  # with every change: test_whole_height_and_pitch.py, and a planted pitch by the analysis
def test_with_half_a_degree_planted_no_known_number_is_outside_its_interval() -> None:
    """Before, midfoot (27.0 [21.8, 33.3] kN/m for 11) and forefoot (37.8 [34.6, 41.4] for 52) were told as known."""
    found = calibrate([stood_out_of_flat()], vsf_foot(), starts=3, finished=1)
    numbers = found.knowledge.numbers
    known = [(n, value) for n, value in zip(numbers, PLANTED, strict=True) if n.verdict == "known"]
    # 7; 10 before, of which three were known only because their priors counted with the variance of the residuals
    assert len(known) >= 7
    assert not [n.name for n, value in known if not n.lower <= value <= n.upper]
    assert all(np.isnan(n.lower) and np.isnan(n.upper) for n in numbers if n.verdict != "known")
    assert found.offsets[0].pitch == pytest.approx(-TURNED, abs=np.radians(0.1))


def test_stances_of_one_standing_trial_share_its_errors() -> None:
    """Residuals of both together are those of each by itself, at one height and pitch or at two."""
    whole, e = recorded(), Errors()
    names = ("time", "poses", "rate", "force", "centre")
    one, two = (replace(whole, **{name: getattr(whole, name)[few] for name in names}) for few in PARTS)
    alone = [SoleResiduals.of([each], vsf_foot()) for each in (one, two)]
    sole, first, second = 0.1 * np.ones(15), [0.5, -0.8], [-0.3, 0.4]
    together = SoleResiduals.of([replace(one, standing="a"), replace(two, standing="a")], vsf_foot())
    apart = SoleResiduals.of([replace(one, standing="a"), replace(two, standing="b")], vsf_foot())
    assert (together.standing, apart.standing) == ((0, 0), (0, 1))
    assert (len(together.sd), len(together.reach), len(apart.sd), len(apart.reach)) == (17, 17, 19, 19)
    assert together.sizes == pytest.approx([e.standing, e.pitch])

    def beside(errors: tuple[list[float], list[float]]) -> np.ndarray:
        each = zip(alone, errors, strict=True)
        return np.concatenate([one.of_data(np.concatenate([sole, aside])) for one, aside in each])

    by_one, by_two = np.concatenate([sole, first]), np.concatenate([sole, first, second])
    np.testing.assert_allclose(together.of_data(by_one), beside((first, first)), rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(apart.of_data(by_two), beside((first, second)), rtol=1e-9, atol=1e-12)
    assert np.abs(together.of_data(by_one) - apart.of_data(by_two)).max() > 0.01


PARTS = (slice(20, 40), slice(60, 80))
