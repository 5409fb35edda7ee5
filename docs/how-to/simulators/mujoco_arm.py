"""Torque of an elbow drive by MuJoCo's inverse dynamics: a forearm of mass m [kg] on a massless rod of length [m].

inputs: angle [rad] from hanging down, outputs: torque [N m]. `law` marks where friction, damping or play may act.
"""

import mujoco
import numpy as np

import geocontact as gc

ARM = """<mujoco><option gravity="0 0 -9.81"/><worldbody><body>
<joint name="elbow" type="hinge" axis="0 1 0"/>
<geom name="forearm" type="sphere" size="0.001" mass="1" pos="0 0 -0.3"/>
</body></worldbody></mujoco>"""
MODEL = mujoco.MjModel.from_xml_string(ARM)
DATA = mujoco.MjData(MODEL)


def run(time, inputs, numbers, law):
    """Torque at each time; rates are those that `law` brings."""
    MODEL.body_mass[1] = numbers["m"]
    MODEL.body_ipos[1] = 0.0, 0.0, -numbers["length"]
    mujoco.mj_setConst(MODEL, DATA)
    torque = np.empty(len(time))
    for i in range(len(time)):
        DATA.qpos[0], DATA.qvel[0], DATA.qacc[0] = inputs[0][i], law.rate[i], law.acceleration[i]
        mujoco.mj_inverse(MODEL, DATA)
        torque[i] = DATA.qfrc_inverse[0]
    return torque + law(inputs[0], law.rate)


PARAMETERS = (
    gc.Parameter("m", "kg", 1.5, 0.5, 4.0),
    gc.Parameter("length", "m", 0.3, fixed=True),
)
ELBOW = gc.simulator_base("mujoco_elbow", {"angle": "rad"}, {"torque": "N m"}, run, dynamic=True, acts_on="angle")
