"""What the command line and the Python table both promise: the columns of area.csv in their order."""

COLUMNS = [
    "time [s]",
    "threshold [mm]",
    "area_fixed [mm^2]",
    "area_moving [mm^2]",
    "min_distance [mm]",
    "max_penetration_fixed [mm]",
    "centroid_x [mm]",
    "centroid_y [mm]",
    "centroid_z [mm]",
    "area_fixed_lower [mm^2]",
    "area_fixed_upper [mm^2]",
    "signed",
]
SPLIT = ["area_fixed_medial [mm^2]", "area_fixed_lateral [mm^2]"]
"""These follow with a split."""

FILES = {"area.csv", "area.png", "area.svg", "report.html", "run.json"}
"""What every run leaves in its folder."""
