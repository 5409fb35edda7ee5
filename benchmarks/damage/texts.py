"""Small settings files and tables that nothing else holds."""

DEVICE = """\
name = "lucy with a wide cuff"
based_on = "lucy"

[numbers]
cuff_length = { value = 160, unit = "mm", source = "invented", note = "longer padding" }
elevation_upper = { value = 165, unit = "deg" }
"""
PERSON = """\
upper_arm = { value = 310, unit = "mm" }
shoulder_width = { value = 390, unit = "mm" }
"""
OVERHEAD = """\
[tasks.T1]
tool = { value = 1.3, unit = "kg" }
push = { value = 35, unit = "N" }

[persons.P1]
mass = { value = 82, unit = "kg" }
sex = "male"
dominant = "right"
upper_arm = { value = 296, unit = "mm" }

[[trials]]
name = "P1T1S100"
person = "P1"
task = "T1"
markers = "walk.trc"
tool = "parameters.csv"
level = "100%"
"""
CONTACT_PARAMETERS = "parameter,unit,value,lower,upper\nk,N/m,5000,4000,6000\nb,N s/m,120,100,140\n"
PROFILE = "side,flexion [deg],radius [mm]\nall,0,36\nall,10,35\nall,20,34\nall,30,32\n"
MARKER_MAP = "recorded,model\nRHEE,R.Heel\nRTOE,R.Toe\n# a note\nLHEE=L.Heel\n"
JSON = {
    "fit.json": {"shape": "cylinder", "radius_mm": 20.0, "axis": [0.0, 0.0, 1.0], "point_mm": [1.0, 2.0, 3.0]},
    "elbow.json": {
        "numbers": {
            "k_N_per_m": 222.4,
            "x_mm": 48.0,
            "y_mm": 59.0,
            "l_mm": 169.0,
            "z_mm": 127.0,
            "b_N_s_per_m": 20.0,
            "s_per_mmHg": 0.01,
        },
        "pressure_mmHg": 30.0,
    },
    "run.json": {
        "command": "area",
        "options": {"unit": "mm", "threshold_mm": [4.0, 5.0]},
        "inputs": [{"file": "ball.stl", "sha256": "0" * 64}],
        "results": {"seconds": 1.0},
    },
}
