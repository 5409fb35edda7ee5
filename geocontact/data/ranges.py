"""What the quantities that several analyses ask for can be: wide enough for whole bodies and for single implants.

What is possible is generous, so that nobody is kept from work; it finds metres taken for millimetres, N/mm for N/m and
degrees for radians. What is usual is what recordings of people, implants and exoskeletons hold.
"""

from __future__ import annotations

from geocontact.data.plausible import HZ, KG, M_PER_S, N_PER_M, N_S_PER_M, PLAIN, ByPlace, N, Plausible, S
from geocontact.data.units import MPa, deg, kPa, mm, mmHg, percent

THRESHOLD = Plausible("a threshold of contact", mm, (0.0, 200.0), (0.01, 20.0), or_zero=True)
LAYER = Plausible("the thickness of a layer", mm, (0.01, 1000.0), (0.2, 100.0))
PIECE = Plausible("the edge of a piece of a surface", mm, (1e-3, 100.0), (0.02, 10.0))
FITTED = Plausible("the radius within which curvatures are fitted", mm, (0.05, 200.0), (0.5, 20.0))
RADIUS = Plausible("the radius of a contact", mm, (0.1, 10_000.0), (1.0, 1000.0))
STRIP = Plausible("the length of a contact", mm, (0.1, 10_000.0), (1.0, 1000.0))
BORDER = Plausible("the border of a mat", mm, (0.0, 500.0), (0.0, 100.0))
DEPTH = Plausible("a depth of contact", mm, (1e-3, 200.0), (0.05, 30.0))
SHIFT = Plausible("how far things are off", mm, (0.0, 500.0), (0.0, 50.0))

YOUNG = Plausible("Young's modulus", MPa, (1e-4, 2e6), (1e-3, 5e5))
TOUCH = Plausible("the pressure of a touch", kPa, (1e-3, 1e4), (0.05, 100.0))
CUFF = Plausible("the pressure of a cuff", mmHg, (0.0, 2000.0), (0.0, 300.0))
LAYER_RATIO = Plausible("Poisson's ratio of a layer, below 0.5", PLAIN, (0.0, 0.4999))
POISSON = Plausible("Poisson's ratio", PLAIN, (-0.9999, 0.5), (0.0, 0.5))

TURN = Plausible("a small turn", deg, (-45.0, 45.0))
TILT = Plausible("how far an angle is off", deg, (0.0, 90.0), (0.0, 20.0))
JOINT_ANGLE = Plausible("an angle of a joint", deg, (-720.0, 720.0))
BIN = Plausible("a width of bins", deg, (0.1, 30.0))

FORCE = Plausible("the force of a person", N, (0.0, 1e5), (0.1, 1e4), or_zero=True)
LIMIT = Plausible("the largest force on a limb", N, (1e-6, 1e5), (1e-3, 2000.0))
NOISE = Plausible("the noise of a force", N, (0.0, 1e4), (0.0, 100.0))
ATTACHMENT = Plausible("the stiffness of an attachment", N_PER_M, (1.0, 1e7), (10.0, 1e5))
DAMPING = Plausible("a damping", N_S_PER_M, (0.0, 1e6), (0.0, 1e4))
SPEED = Plausible("a speed of sliding", M_PER_S, (1e-6, 20.0), (1e-4, 2.0))
FRICTION = Plausible("a coefficient of friction", PLAIN, (0.0, 10.0), (0.0, 2.0))
MASS = Plausible("the mass of a person", KG, (0.1, 1000.0), (3.0, 300.0))

CUTOFF = Plausible("a cut-off frequency", HZ, (0.0, 2000.0), (0.5, 100.0), or_zero=True)
BAND = Plausible("a frequency of movement", HZ, (1e-6, 1000.0), (1e-3, 20.0))
RATE = Plausible("a sampling rate", HZ, (5.0, 1e4))
FRAME_RATE = Plausible("a frame rate", HZ, (1e-3, 1e5), (0.5, 5000.0))
DELAY = Plausible("a lag of clocks", S, (-3600.0, 3600.0), (-60.0, 60.0))
GAP = Plausible("a gap in a recording", S, (0.0, 60.0), (0.0, 2.0))
LENGTH_OF_TRIAL = Plausible("the length of a trial", S, (1.0, 3600.0))
MEMORY = Plausible("a correlation time", S, (0.0, 600.0), (0.0, 30.0))

SHARE = Plausible("a share", percent, (1e-10, 100.0))
DIFFERENCE = Plausible("a relative difference", percent, (1e-7, 1e5))

DISPLACEMENT = ByPlace((SHIFT, TILT))
POSE = ByPlace((SHIFT, SHIFT, SHIFT, TILT, TILT, TILT))
