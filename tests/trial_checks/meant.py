"""What has to be said of each damage of the battery: words of the check, or of the reader, that it is made for."""

from __future__ import annotations

AXES = r"unless the person lies, try `axes`|y must be up: turn the file with `axes`"
CLOCK = r"one clock"
COMMA = r"is not a number; use decimal points|\(decimal commas\?\)"
COURSE = r"leaves its course by|jumps by 150 mm at"
EXCHANGED = r"take each other's place at"
FLOOR = r"above the floor while standing; is the floor at"
HANDED = r"right side are on the left of the body|left and right are exchanged"
MASS = r"(check `mass`|check mass) and its unit|check mass in \S+, and that no plate is missing"
SPAN = r"is the unit in the file's head right"
UNDER = r"centre of pressure is .* (m from|beside the line|ahead of)|no plate under the foot"

MEANT = {
    "standing trial 25 % larger": r"are both trials of one person|mm apart, the keel is .* is the unit right",
    "standing trial with another floor": FLOOR,
    "right and left mirrored": HANDED,
    "z is up": AXES,
    "a jump of 150 mm": COURSE,
    "labels exchanged half-way": EXCHANGED,
    "the walk with another floor": r"have both trials one origin, and one floor",
    "both with another floor": FLOOR,
    "the standing trial twice": r"give two different recordings",
    "mass x 0.7": MASS,
    "mass in pounds": r"check `mass` and its unit",
    "force in kN": r"(is the force|is it) in N|its force is never 5 N",
    "force / 2": MASS,
    "the gain of one plate x 1.3": r"over a step; by the plates it is .* and each plate's gain",
    "sign of the force along the walk": r"is the sign of the force along the walk turned",
    "sign of all forces": r"turn the sign of forces and torques",
    "plates 0.1 s late": CLOCK,
    "plates 0.1 s early": CLOCK,
    "centre of pressure in mm": UNDER + r"|passes # m from the origin",
    "the other plate": r"each foot needs a plate of its own|give another plate|is it the plate of this foot",
    "axes of the plates exchanged": r"are the plate's axes exchanged|and y up\?",
    "plates 0.2 m aside": UNDER,
    "plates mirrored": UNDER,
    "a clock that runs twice as fast": CLOCK,
    "the plates' time in ms": r"is its time in s, not in ms|one clock for both",
    "a free moment in N mm": r"is it in N m, and about the centre of pressure",
    "decimal comma in the plates": COMMA,
    "decimal comma in the markers": COMMA,
    "markers in m, called mm": SPAN,
    "markers in cm, called mm": r"is its unit of length right",
    "pounds": r"are it and the lengths in kg and m",
    "a child's mass": r"are it and the lengths in kg and m",
    "two of one arm exchanged half-way": EXCHANGED,
    "in inches": SPAN,
    "decimal comma": COMMA,
    "mass x 1.2857": MASS,
    "mass x 2.2": MASS,
    "feet and chair exchanged": r"check that the plate was set to zero|check that this is the chair's plate",
    "the chair's plate missing": r"is a plate missing, of a chair or a foot",
    "another trial's plates": CLOCK,
    "radians, called degrees": r"are they radians",
    "degrees, called radians": r"too much for the radians that the header declares",
    "foot in mm": r"is it in m, not in mm",
    "time in ms": r"is its time in s, not in ms|put plates and markers on one clock",
    "height in feet": r"check the value and its unit",
    "a child's height": r"are it and the lengths in kg and m, of one person",
    "plates 0.1 m aside": r"do plates and coordinates have one origin",
    "sign of the rates": r"is its sign turned",
    "rates in degrees, called radians": r"is it in degrees and not in radians",
    "one trial twice": r"name the files of each trial's own recording",
    "in m, called mm": SPAN,
    "a jump of an angle": COURSE,
    "columns exchanged half-way": COURSE,
    "shifts in mm": r"is it in m, not in mm",
    "torque in N mm": r"is it in N m, and about the centre of pressure",
    "axes of the plate exchanged": r"are the plate's axes exchanged",
    "the plate's time in ms": r"is its time in s, not in ms",
    "decimal comma in the plate": COMMA,
    "floor +50 mm": r"is the floor at the same height in plates and markers",
    "the foot elsewhere": UNDER,
    "decimal comma in the motion": COMMA,
    "pitch in degrees, called radians": r"is it in degrees\?",
    "x in mm, called m": r"x reaches # m; is it in mm\?",
    "the same files twice": r"name the files of that trial's own recording",
    "the same plates twice": r"name the files of each trial's own recording",
    "the same plates on another clock": r"sample by sample: trials that are one count twice",
    "inputs 1 s late": r"put both on one clock",
    "inputs 0.1 s late": CLOCK,
    "decimal comma in the inputs": COMMA,
}
"""Patterns by the name of the damage."""
