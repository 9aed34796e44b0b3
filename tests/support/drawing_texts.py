"""Drawings as texts, which use all of the language, and words to spoil them with."""

import re
from pathlib import Path

from dqpaint.language.vocabulary.units import UNITS
from dqpaint.language.vocabulary.words import FUNCTIONS, LITTLE_WORDS, PARTS, PROFILES, STATEMENTS

STAR = """# star.traj - a five-pointed star, one colour per edge
period 10 ms
speed 60 mm/s
let r = 80 mm

move to polar(r, 90 deg)
repeat i from 1 to 5
  line to polar(r, 90 deg + i*144 deg) light hsv(i*72 deg)
end
"""

ROSE = """period 10 ms
profile constant
let a = 30 mm

repeat k from 0 to 5
  with rotate k*60 deg shift (80 mm, 0) light hsv(k*60 deg)
    move to (a, 0)
    curve polar(a*cos(3*t), t) for t from 0 to 180 deg in 12 s
  end
end
"""

FOLDER = Path(__file__).parents[2] / "trajectories"

HERE = FOLDER / "fuzz.traj"

MIXED = """start at (0,0,0) mm tool look (5,5,50) mm up y
light red 40% to off
line to (5,0) mm by (0,5) mm tool rpy(0,0,30 deg) in 3 s
arc via (1,2) mm to (9,9,1) mm tool follow
with rotate 30 deg about (1,1) mm scale 2 tool follow
curve (t*mm, t^2*mm, sqrt(1+t)*mm) for t from 0 to 3 samples 50
end
let a = quat(1,0,0,0)*rot(x,3 deg)
let b = min(3 mm, max(2 mm,abs(-3 mm)), sqrt(4 mm*mm))
move to (b, ln(exp(1))*mm) tool a
screw to (3,4,5) mm tool rot((1,1,0), 30 deg) profile cubic(1 deg/s, 0)
light 5600 K to hsv(30 deg, 1, 0.5)
step to (1,1) mm
hold 3 s light on to "#f80"
arc centre (0,0) mm angle -30 deg rise 3 mm grow 1 mm profile quintic(0,0,1 mm/s/s,0)
screw about (0,0) along x+y angle 1 turn pitch 3 mm/turn
text "Ada, 3" "Love" font "scripts" width 30 mm at (1,2) mm align centre light red to blue
path "orbit.csv" height 30 mm smooth at (1,1) mm samples 500
svg "logo.svg" height 3 mm width 2 cm tool look (0,0,300) mm up y
photo "ada.png" height 3 cm as hatch detail 1 mm angle 30 deg cross colours full max 90 s dark 5%
curve polar(1 mm*exp(t/rad/5), t) for t from 0 to 2 turns tool follow speed 30 mm/s
"""

WHOLE = """let f(x, k) = k*x^2*mm
frame leaf at (6, 0) mm turned 30 deg
def star(r, n)
  move to polar(r, 90 deg)
  repeat i from 1 to n
    line to polar(r, 90 deg + i*144 deg) light hsv(i*72 deg) even brush bar 20 mm along x+y
  end
end
star(20 mm, 5)
with frame leaf strobe 10 Hz 30% brush point 2 mm
  star(f(2, 3), 5)
end
strobe off
blend 3 mm
line to (0, 0) to (20, 0) mm to (20, 20) mm to (0, 20) mm
arc radius 15 mm to (9, 0) mm left long
blend off
stroke speed 50 mm/s light red to blue
  line to (0, 40) mm
  arc centre (10, 40) mm angle -180 deg tool follow
  curve (20 + 3*sin(t), 40 + t/rad) mm for t from 0 to 2 rad
  line by (0, -20) mm blend 1 mm
  line by (9, -20) mm
end
move to (0, 0)
arc radius 20 mm axis y to (30, 0, 5) mm right
"""

FILES = [path.read_text("utf-8") for path in sorted(FOLDER.glob("*.traj"))]

PIECES = "0 1 -1 1e300 1e-300 9^9^9 (0,0) (0,0,0)mm red pi a ü % 40% # ( ) , ^ / * - = 180deg t"

SCRAPS = [
    *(*STATEMENTS, *PARTS, *FUNCTIONS, *PROFILES, *LITTLE_WORDS, *UNITS),
    *(*PIECES.split(), '"', "\n", "end\n"),
]

TOKEN = re.compile(r"\s+|\w+|.")
