"""One recording per format, typed from the descriptions of the formats: no writer of this project made them."""

from __future__ import annotations

from pathlib import Path

from geocontact.io.mats.layout import MatLayout, read_layout

GRID = """\
# synthetic, 2 x 3 cells
time [s],1,2,3,4,5,6
0.00,0.5,1.0,1.5,2.0,2.5,3.0
0.02,10,20,30,40,50,60
"""

GRID_LAYOUT = """\
rows = 2
columns = 3
pitch_mm = [10, 20]
unit = "kPa"
"""

PEDAR = """\
file name:  walk_01.sol\tdate/time  01.02.26 10.49
sensor type:  y-1865l-1870r-pxf306-11mar2021
total time [secs]:  0.020\ttime per frame [secs]:  0.01000\tscanning rate [Hz]:   100
pressure values in  kPa

mask definition:\x20
left insole: 1,2,3,5,
right insole: 1,2,4,

time[secs]    \t      1\t      2\t      3\t      5\t      1\t      2\t      4
     0.01000\t 32.500\t 40.000\t  0.000\t 20.000\t 25.000\t105.000\t 72.500\t
     0.02000\t 35.000\t 42.500\t  2.500\t 22.500\t 27.500\t107.500\t 75.000\t
"""

PEDAR_LAYOUT = """\
rows = 2
columns = 3
pitch_mm = 15
cell_area_mm2 = 150
[sensors]
left = [[1, 0], [1, 1], [1, 2], [0, 0], [0, 2]]
right = [[1, 2], [1, 1], [1, 0], [0, 2], [0, 0]]
"""

PLIANCE = """\
\tfile name: test.asc\tdate/time 29.01.13 11.30
sensor type: S2073_11-ROUND-200KPa
total time [secs]: 0.040\ttime per frame [secs]: 0.020\tscanning rate [Hz]:  50
pressure values in kPa

electrical:
time[secs]
0.000\t1.0\t2.0\t3.0\t4.0\t5.0\t6.0
0.020\t0.0\t10.0\t0.0\t0.0\t0.0\t0.5
"""

TEKSCAN = """\
DATA_TYPE MOVIE
VERSION Tekscan Pressure Measurement System 7.00-22
FILENAME C:\\walks\\seat.fsx
SENSOR_TYPE 5315
ROWS 3
COLS 4
ROW_SPACING 10.16 mm
COL_SPACING 5.08 mm
SENSEL_AREA 51.6128 mm2
NOISE_THRESHOLD 3
SECONDS_PER_FRAME 0.02
SCALE_FACTOR 1
EXPONENT 1
SATURATION_PRESSURE 207 KPa
SENSITIVITY S-27
START_FRAME 6
END_FRAME 7
UNITS KPa
MIRROR_ROW 0
MIRROR_COL 0
ASCII_DATA @@

Frame 6
B,1,2.5,B
3,4,5,6
7,8,9,207

Frame 7
B,11,12.5,B
13,14,15,16
17,18,19,0
@@
"""

XSENSOR = """\
Frame:,"1"
Date:,"2026-02-03"
Time:,"23:59:59,900"
Sensor:,"Seat"
Rows:,"2"
Columns:,"3"
Sensel Width (in):,"0,5"
Sensel Height (in):,"0,4"
Sensel Area (in²):,"0,2"
Average Pressure (mmHg):,"12,5"
Contact Area (in²):,"1,0"
Units:,"mmHg"
COP Row:,"1,2"
COP Column:,"2,1"
Sensels:
"0,00","1,25","2,50"
"3,75","5,00","6,25"

Sensor:,"Back"
Rows:,"1"
Columns:,"2"
Sensel Width (in):,"1,0"
Sensel Height (in):,"1,0"
Units:,"psi"
"0,5","1,5"

Frame:,"2"
Time:,"00:00:00,000"
Sensor:,"Seat"
"10,00","11,25","12,50"
"13,75","15,00","16,25"

Sensor:,"Back"
"2,5","3,5"
"""


def write(folder: Path, text: str | bytes, name: str = "recording.csv") -> Path:
    """A file of this content."""
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def layout(folder: Path, text: str) -> MatLayout:
    """The layout that a file of this content describes."""
    return read_layout(write(folder, text, "layout.toml"))
