# ruff: noqa: E501  the table is a table
"""Drawings with a mistake each, and the message that it must lead to."""

from pathlib import Path

from dqpaint.diagnostics.diagnostic import Diagnostic
from dqpaint.language import ScriptError, parse

# The text (~ ends a line), the code, line:column and the caret's text, and what comes with it: a
# help, a fix. Unsaved are texts that are no files. The wording is in tests/snapshots/messages.txt.
CATALOGUE = r"""
move to (1, 2) mm;|E101|1:18 ;|help fix
let π = 3|E101|1:5 π|help fix
line to (2r, 0)|E102|1:10 2r|help
period 10tool ms|E102|1:8 10tool|help fix
line to (2,000, 0) mm|E102|1:12 000|help fix
hold 007.5 s|E102|1:6 007.5|help fix
line to (0,05, 2) cm|E102|1:12 05|help fix
let a = 1.2.3|E102|1:9 1.2.3|help
line to (1, 0) inch|E102|1:16 inch|help
line to (0, 0, 70 mm|E103|1:9 (|help
line to (0, 0, 70 mm~line by (1, 0) mm|E103|1:9 (|help
line to (0, 0)) mm|E104|1:15 )|help fix
arc via (1,2) mm to end|E105|1:21 end|help
speed = 40 mm/s|E105|1:7 =|help
light "red|E107|1:7 "|help
light #ff8800|E108|1:1 light|help fix
light 40%|E108|1:7 40|help
line to (1 2) mm|E109|1:12 2|help fix
let|E109|1:1 let|help
start at (9,0) mm~arc centre (0,0) angel 90 deg|E110|2:18 angel|help fix
move by (1,0) mm light red|E110|1:18 light|help
hold 1 s tool keep|E110|1:10 tool|help
line (10, 0) mm|E111|1:6 (|help
line to (1,2) mm 5|E112|1:18 5|
line to (9,0) mm speed 4 mm/s speed 5 mm/s|E113|1:31 speed|help
period 3 ms~period 4 ms|E113|2:1 period|help
let m = 5|E114|1:5 m|help
let angle = 5|E114|1:5 angle|help
arc via (1,2) mm|E115|1:1 arc|help
arc centre (1,2) mm|E115|1:1 arc|help
repeat i from 1 5~end|E116|1:17 5|help fix
traj 2|E118|1:6 2|help
period 3 ms~traj 1|E119|2:1 traj 1|help
r = 3 cm|E120|1:1 r|help fix
lin to (0, 0, 70) mm|E120|1:1 lin|help fix
wait 2 s|E120|1:1 wait|help fix
circle (0, 0)|E111|1:8 (|help
star 2 radius 9 mm|E221|1:6 2|
star 4 radius 9 mm|E115|1:6 4|help
rect width 9 mm|E115|1:1 rect|help
circle radius 0 mm|E220|1:15 0 mm|
light rgb(255, 0, 0)~line by (9, 0) mm|E217|1:11 255|help fix
stroke~circle radius 9 mm~polygon 1001 radius 9 mm~end|E221|3:9 1001|help
color red|E120|1:1 color|help fix
G1 X10|E120|1:1 G1|help
repaet 3~line by (1,0) mm~end|E120|1:1 repaet|help fix
if x > 3~line by (1,0) mm~end|E121|1:1 if|help
text Hello height 3 mm|E109|1:6 Hello|help fix
text 3 height 3 mm|E109|1:6 3|help
text “Ada” height 3 mm|E101|1:6 “|help fix
let café = 3|E101|1:8 é|help fix
let größe = 3|E101|1:7 ö|help
line by (3 — 1, 0)|E101|1:12 —|help fix
café — naïve|E120|1:1 café|help
°é|E120|1:1 °|help
line by (1, 0) mm even|E110|1:19 even|help
line by (1, 0) mm light even|E108|1:25 even|help fix
include "plain.svg"|E272|1:9 "plain.svg"|help
text "Ada" font scripts height 3 mm|E109|1:17 scripts|help fix
text "Ada" height 3 mm align middle|E109|1:30 middle|help fix
path "points.csv" unit inch|E109|1:24 inch|help fix
path points.csv unit mm|E101|1:12 .|help fix
text "Hello"|E115|1:1 text|help
path "points.csv"|E115|1:1 path|help
path "points.csv" unit mm height 3 mm|E248|1:19 unit|help
path "a" "b" "c" "d" unit mm|E248|1:18 "d"|help
svg "plain.svg" "words.svg"|E248|1:17 "words.svg"|help
text "Ada" height 3 mm tool follow|E254|1:29 follow|help
text "Ada" font "script" height 3 mm|E260|1:17 "script"|help fix
text "Ada" font "comic" height 3 mm|E260|1:17 "comic"|help
text "3 €" height 3 mm|E261|1:9 €|help fix
text "Ada" "λ=3" height 3 mm|E261|1:13 λ|help
text "日本" height 3 mm|E261|1:7 日|help
stroke in 5 s~text "Ada" height 3 mm~end|E283|2:1 text|help
text "  " height 3 mm|E262|1:6 "  "|help
path "flat.csv" height 3 mm|E263|1:24 3 mm|help
path "points.csv" unit mm|E292|1:6 "points.csv"|help unsaved
path "/etc/passwd" unit mm|E292|1:6 "/etc/passwd"|help
path "../files/points.csv" unit mm|E292|1:6 "../files/points.csv"|help
path "none.csv" unit mm|E293|1:6 "none.csv"|help
path "bad.csv" unit mm|E295|1:6 "bad.csv"|help
path "one.csv" unit mm|E296|1:6 "one.csv"|help
path "one.csv" "three.csv" unit mm|E296|1:16 "three.csv"|help
path "one.csv" "flat.csv" unit mm|E296|1:16 "flat.csv"|help
svg "words.svg"|E298|1:5 "words.svg"|help
svg "bomb.svg"|E298|1:5 "bomb.svg"|help
svg "points.csv"|E298|1:5 "points.csv"|help
svg "flat.svg" height 1e8 m|E201|1:1 svg "flat.svg" height 1e8 m|
photo "plain.svg" as hatch|E297|1:7 "plain.svg"|help
photo "grey.webp" as hatch max 60 s|W423|1:32 60 s|help
photo "grey.webp" as hatch max 1 s|E297|1:32 1 s|help
photo "grey.webp" as hatch light off|E297|1:28 light|
photo "grey.webp" as hatch colours 2|E297|1:36 2|help
photo "grey.webp" as hatch detail 0.01 mm|E297|1:35 0.01 mm|help
photo "grey.webp" as hatch detail 150 mm|E297|1:35 150 mm|help
photo "grey.webp" as hatch dark 100%|E297|1:1 photo "grey.webp" as hatch dark 100%|help
photo "grey.webp" as hatch dark 0.1|E109|1:33 0.1|help
photo "grey.webp" as hatch colours red|E109|1:36 red|help
photo "grey.webp" as hatching|E109|1:22 hatching|help fix
photo "grey.webp"|E115|1:1 photo|help
photo "grey.webp" "plain.svg" as hatch|E248|1:19 "plain.svg"|help
svg "passed.svg"|W421|1:5 "passed.svg"|help
svg "otherwise.svg"|W422|1:5 "otherwise.svg"|help
svg "unread.svg"|E298|1:5 "unread.svg"|help
svg "plain.svg"|W420|1:5 "plain.svg"|help
with rotate 3 deg~period 3 ms~end|E123|2:1 period|help
line by (1,0) mm~place at (0, 0)|E124|2:1 place|help
repeat 3~line by (1,0) mm|E130|1:1 repeat|help
# nothing|E140||help
let a = 9^9^9|E201|1:9 9^9^9|
let a = 1e300*1e300|E201|1:9 1e300*1e300|
line to (0,5, 1,0) mm|E202|1:9 (0,5, 1,0) mm|help fix
let a = 1/0|E203|1:11 0|
line to (1 mm, 20, 3)|E204|1:16 20|help fix
let r = 3 mm~line to (radius, 0)|E205|2:10 radius|help fix
line to (radius, 0)|E205|1:10 radius|help
let a = sinn(3)|E206|1:9 sinn|help fix
let a = rpy(1 deg, 2 deg)|E207|1:9 rpy(1 deg, 2 deg)|help
let r = 5 mm~let q = r + 5|E208|2:13 5|help fix
let q = 5 - 3 s|E208|1:9 5|help fix
let q = 3 mm * red|E209|1:16 red|
line to (1 mm, 2 mm) cm|E210|1:22 cm|help
let a = 2^3 mm|E211|1:11 3 mm|help
let a = sqrt(-1)|E212|1:14 -1|
let a = sin(30)|E213|1:13 30|help
start at (0, 0) tool quat(1, 1, 0, 0)|E214|1:22 quat(1, 1, 0, 0)|help
start at (0, 0) tool rot((0, 0, 0), 3 deg)|E215|1:26 (0, 0, 0)|
light "#ff88"|E216|1:7 "#ff88"|help
light red 140%|E217|1:11 140%|help
line to (0, 0, 70)|E218|1:9 (0, 0, 70)|help fix
speed 40 mm|E218|1:7 40 mm|help fix
period 20|E218|1:8 20|help fix
hold 20|E218|1:6 20|help fix
line to 5 mm|E218|1:9 5 mm|help
line to (1,2) mm light red to (3,4) mm|E218|1:31 (3,4) mm|help
hold 0 s|E220|1:6 0 s|
text "Ada" height 1e-300 mm|E220|1:19 1e-300 mm|
line by (1,0) mm samples 2.5|E221|1:26 2.5|
repeat i from 5 to 1~end|E222|1:20 1|help
let r = 1 mm~let r = 2 mm|E230|2:5 r|help
curve polar(t*mm, t*rad) for t from 0 to 1 light hsv(t) to red|E109|1:50 hsv(t) to red|help
curve polar(t*mm, t*rad) for t from 0 to 1 light red in t*1 s|E205|1:57 t|help
line to () mm|E105|1:10 )|help
line to (1,) mm|E105|1:12 )|help
line to (1,,2) mm|E105|1:12 ,|help
text "Hello~  world" height 20 mm|E107|1:6 "|help
text "Hello~world~again" height 20 mm|E107|1:6 "|help
text "Hello" font "scripts~text "world" height 20 mm|E107|1:19 "|help
-- a comment|E120|1:1 -|help
// a comment|E120|1:1 /|help
% a comment|E120|1:1 %|help
; a comment|E101|1:1 ;|help
line by (1, 0) mm ; a comment|E101|1:19 ;|help
line by (1, 0) mm -- comment|E205|1:22 comment|help
svg "packed.svgz"|E298|1:5 "packed.svgz"|help
svg "nosize.svg"|E298|1:5 "nosize.svg"|help
svg "inner.svg"|W421|1:5 "inner.svg"|help
curve (hsv(t), 0) for t from 0 to 1 turn|E231|1:12 t|help
line to (9,0) mm in 2 s samples 30|E241|1:25 samples|help
curve (t, t) for t from 3 mm to 3 mm|E242|1:33 3 mm|
curve (mm/t, 0) for t from 0 to 1|E243|1:7 (mm/t, 0)|help
curve (sqrt(t)*mm, 0) for t from 0 to 1|E243|1:7 (sqrt(t)*mm, 0)|help
start at (9,0) mm~arc centre (0,0) angle 0|E244|2:24 0|help
start at (0,0)~arc via (80, 10) mm to (0, 0)|E245|2:24 (0, 0)|help
arc via (1,1) mm to (2,2) mm|E246|1:9 (1,1) mm|help
start at (1,0) mm~arc centre (0,0) to (0, 1) mm|E247|2:18 to|help
arc via (1,2) mm to (3,0) mm angle 3 deg|E248|1:30 angle|help
arc centre (0,0) angle 90 deg|E249|1:12 (0,0)|help
start at (9,0) mm~arc centre (0,0) angle 90 deg grow -20 mm|E250|2:36 -20 mm|help
line by (1,0) mm tool look (0, 0)|E251|1:1 line by (1,0) mm tool look (0, 0)|help
start at (-50, 0) mm~line to (50, 0) mm tool look (0, 0)|E251|2:1 line to (50, 0) mm tool look (0, 0)|help
start at (-50, 0) mm~curve (t*mm, 0) for t from -50 to 50 tool look (0, 0)|E251|2:1 curve (t*mm, 0) for t from -50 to 50 tool look (0, 0)|help
start at (-50, 0, 10) mm~line to (50, 0, 10) mm tool look (0, 0) up z|E252|2:1 line to (50, 0, 10) mm tool look (0, 0) up z|help
start at (-50, 0) mm~line to (50, 0) mm tool look line (0, 0) along y|E253|2:1 line to (50, 0) mm tool look line (0, 0) along y|help
line by (1,0) mm tool look (0, 5) mm|E252|1:1 line by (1,0) mm tool look (0, 5) mm|help
line by (1,0) mm tool look line (0,0) along x|E253|1:1 line by (1,0) mm tool look line (0,0) along x|help
curve (0, 0, t) for t from 0 to 1 mm tool follow|E254|1:7 (0, 0, t)|help
screw to (1,2) mm|E255|1:10 (1,2) mm|help
profile linear|E205|1:9 linear|help fix
profile fancy|E205|1:9 fancy|help
light rbg(255, 0, 0)|E206|1:7 rbg|help fix
curve (10 mm*sin(t), 0) for t from 0 to 1|E213|1:18 t|help
line to 50 mm, 0 mm|E112|1:14 ,|help fix
period 20 s|E257|1:8 20 s|help
task line|E267|1:6 line|help
keep inside box (0,0,0) mm to (30,30,0) mm|E268|1:31 (30,30,0) mm|help
face viewer within 180 deg|E268|1:20 180 deg|help
wall below z = -50 mm by (0,10) mm|E268|1:26 (0,10) mm|help
circle radius 30 mm fill 0.001 mm|E269|1:26 0.001 mm|help
wall under z = 0|E109|1:6 under|help
keep away from ball|E109|1:16 ball|help
keep away from sphere at (0,0,0) mm|E115|1:1 keep away from sphere at (0,0,0) mm|help
keep links apart 0 mm|E220|1:18 0 mm|label
repeat 2~wall below z = 0~line by (1,0) mm~end|E123|2:1 wall|help
profile cubic(1e300 mm/s, 0 mm/s)|E201|1:15 1e300 mm/s|
profile smooth(2 m/s/s)|E207|1:9 smooth(2 m/s/s)|help
profile smooth(2 m/s/s, 0)|E220|1:25 0|
profile smooth(2 m/s, 3 m/s/s/s)|E213|1:16 2 m/s|help
profile smooth(2, 3)|E213|1:16 2|help
profile smooth(1e-300 m/s/s, 3 m/s/s/s)|E201|1:16 1e-300 m/s/s|
line by (5,0) mm by (0,5) mm samples 1|E256|1:1 line by (5,0) mm by (0,5) mm samples 1|help
repeat 10001~line by (1,0) mm~end|E303|1:8 10001|help
brush disc 3 mm|E264|1:7 disc|help
brush fiber|E264|1:7 fiber|help fix
brush 3 mm|E109|1:7 3|help
line by (1, 0) mm brush bar 20 mm leds light red|E105|1:40 light|help
brush bar 120 mm led 40|E265|1:18 led|help fix
brush bar 120 mm wide 40|E265|1:18 wide|help
brush ribbon leds 3|E265|1:14 leds|help
brush bar 120 mm leds 40 leds 3|E113|1:26 leds|help
brush bar 120 mm leds 1|E258|1:23 1|help
brush bar 120 mm leds 2.5|E221|1:23 2.5|
brush bar 120 mm along (0, 0)|E215|1:24 (0, 0)|
brush bar 120 mm colours red to 3|E218|1:33 3|help
brush pixelstick image 3|E218|1:24 3|help
brush pixelstick image "none.png"|E293|1:24 "none.png"|
brush pixelstick image "../a.png"|E292|1:24 "../a.png"|help
brush bar 120|E218|1:11 120|help fix
brush bar 0 mm|E258|1:11 0 mm|help
brush bar 20 m|E258|1:11 20 m|help
strobe 10|E218|1:8 10|help fix
strobe 0 Hz|E220|1:8 0 Hz|
strobe 1e9 Hz|E259|1:8 1e9 Hz|help
strobe 10 Hz 0%|E217|1:14 0%|help
strobe 10 Hz 130%|E217|1:14 130%|help
strobe 10 Hz 30|E109|1:14 30|help
blend 5|E218|1:7 5|help fix
include foo.traj|E109|1:9 foo.traj|help
include "foo.traj"|E271|1:9 "foo.traj"|help unsaved
let f(3) = 2|E109|1:7 3|help
let f(a, a) = 2|E230|1:10 a|help
let f(a) = a*f(a)|E232|1:12 a*f(a)|help
let f(a) = a*2~line by (f, 0)|E206|2:10 f|help
let f(a) = a*2~line by (f(1, 2)*mm, 0)|E207|2:10 f(1, 2)|help
let f(a) = a + 1~line by (f(3 mm), 0)|E208|1:16 1|help fix
let f(a) = a*2~line by (ff(1)*mm, 0)|E206|2:10 ff|help fix
let f(a) = a~f(3)|E206|2:1 f|help
let r = 3 mm~r(3)|E206|2:1 r|
leaf(20 mm)|E120|1:1 leaf|help
staar(20 mm)~def star(r)~line by (r, 0)~end|E120|1:1 staar|help fix
def leaf(r)~line by (r, 0)~end~leaf()|E207|4:1 leaf()|help
def star(r)~line by (r, 0)~end~star(5)|E218|2:9 (r, 0)|help fix
def star(r)~line by (r, 0)~star(r)~end|E232|3:1 star(r)|help
def star(r)~line by (r, 0)~end~line by (star(3), 0)|E206|4:10 star|help
def star(r)~line by (r, 0)~end~line by (star, 0)|E206|4:10 star|help
def star(r)~period 3 ms~end~star(3)|E123|2:1 period|help
def (r)~end|E109|1:5 (|help
def line(r)~end|E114|1:5 line|help
frame leaf|E115|1:1 frame|help
frame leaf rotate 3 deg|E110|1:12 rotate|help
with frame leaf~line by (1, 0) mm~end|E205|1:12 leaf|help
let r = 3 mm~with frame r~line by (1, 0) mm~end|E218|2:12 r|help
frame leaf at (3, 0) mm~line by leaf|E218|2:9 leaf|help
stroke in 3 s speed 4 mm/s~line by (1, 0) mm~end|E241|1:15 speed|help
stroke~stroke~line by (1, 0) mm~end~end|E280|2:1 stroke|help
stroke~line by (1, 0) mm in 3 s~end|E281|2:19 in|help
stroke~speed 3 mm/s~line by (1, 0) mm~end|E281|2:1 speed|help
stroke~with profile constant~line by (1, 0) mm~end~end|E281|2:6 profile|help
stroke~line by (9, 0) mm~hold 1 s~end|E282|3:1 hold 1 s|help
stroke~line by (9, 0) mm~line by (0, 0) tool rpy(0, 0, 3 deg)~end|E282|3:1 line by (0, 0) tool rpy(0, 0, 3 deg)|help
stroke~line by (9, 0) mm~curve (t, 3 mm) for t from 9 mm to 12 mm~end|E283|3:1 curve (t, 3 mm) for t from 9 mm to 12 mm|help
blend 5 mm~line by (8, 0) mm by (0, 8) mm by (8, 0) mm|E284|2:1 line by (8, 0) mm by (0, 8) mm by (8, 0) mm|help
blend 5 mm~line by (4, 0) mm by (0, 8) mm|E284|2:1 line by (4, 0) mm by (0, 8) mm|help
blend 5 mm~line by (8, 0) mm by (-8, 0) mm|E286|2:1 line by (8, 0) mm by (-8, 0) mm|help
blend 5 mm~line by (8, 0) mm~curve (8 mm, t) for t from 0 to 9 mm|E285|2:1 line by (8, 0) mm|help
blend 1 mm~line by (8, 0) mm in 2 s~line by (0, 8) mm in 3 s|E287|3:1 line by (0, 8) mm in 3 s|help
blend 1 mm~line by (8, 0) mm~line by (0, 8) mm speed 3 mm/s|E287|3:1 line by (0, 8) mm speed 3 mm/s|help
blend 1 mm~line by (8, 0) mm~line by (0, 8) mm profile quintic|E287|3:1 line by (0, 8) mm profile quintic|help
arc radius 20 mm left|E115|1:1 arc|help
arc radius 20 mm to (9, 0) mm|E115|1:1 arc|help
arc radius 20 mm to (9, 0) mm left right|E248|1:36 right|help
arc radius 20 mm to (9, 0) mm left angle 30 deg|E248|1:36 angle|help
arc radius 20 mm to (50, 0) mm left|E291|1:12 20 mm|help
arc radius 20 mm to (9, 0, 3) mm left|E290|1:21 (9, 0, 3) mm|help
arc radius 20 mm to (0, 0) left|E245|1:21 (0, 0)|help
arc centre (9, 0) mm angle 30 deg left|E248|1:35 left|help
arc centre (0,0) radius 20 mm angle 1 turn|E248|1:18 radius|help
arc r 20 mm to (9, 0) mm left|E110|1:5 r|help
arc via (3, 3) mm to (9, 0) mm long|E248|1:32 long|help
line by (1, 0) mm~end|E131|2:1 end|help
arc center (0,0) radius 20 mm angle 1 turn|E248|1:18 radius|help
include ""|E109|1:9 ""|help
stroke~line by (9, 0) mm~line by (9, 0) mm tool look (0, 0, -50) mm up y~end|E283|3:1 line by (9, 0) mm tool look (0, 0, -50) mm up y|help
line by (0, 0)~line by (1,0) mm|W401|1:9 (0, 0)|help
curve (42 mm, t) for t from 0 to 3 mm|W402|1:7 (42 mm, t)|help
start at (0,0) tool rpy(0,0,0)~line by (1,0) mm tool look (0,0,-5) mm up y|W404|2:1 line by (1,0) mm tool look (0,0,-5) mm up y|help
move to (1,0) mm in 3 s~line by (1,0) mm|W405|1:18 in|help
line by (1,0) mm~step to (9,9) mm|W406|2:1 step to (9,9) mm|help
"""

FILES = Path(__file__).parents[1] / "language/files"

ENTRIES = [line.split("|") for line in CATALOGUE.strip().split("\n")]
LARGE = {  # texts too long for the table, the code, line:column
    "brackets": ("let a = " + "(" * 70 + "1" + ")" * 70, "E106", "1:73"),
    "signs": ("let a = " + "-" * 70 + "1", "E106", "1:73"),
    "blocks": ("with rotate 1 deg\n" * 33 + "end\n" * 33, "E126", "33:1"),
    "strokes": (
        "repeat 9000\nline by (1,0) mm" + " by (-1,0) mm by (1,0) mm" * 4 + "\nend", "E301", "2:1",
    ),
    "statements": ("repeat 9999\n" * 3 + "line by (1,0) mm\n" + "end\n" * 3, "E304", "1:1"),
    "size": (" " * 2_000_001, "E305", ""),
    "lines": ("\n" * 100_001, "E306", ""),
    "zero": ("line by\0(1,0) mm", "E307", "1:8"),
    "svg": ('\n<svg width="9">', "E307", "2:1"),
    "xml": ('<?xml version="1.0"?>', "E307", "1:1"),
    "words": ("let a = 1" + "+1" * 60_000, "E314", "1:1"),
    "letters": (f'text "{"A" * 1001}" height 3 mm', "E262", "1:6"),
    "calls": (
        "def d0\nhold 1 s\nend\n"
        + "".join(f"def d{i}\nd{i - 1}()\nend\n" for i in range(1, 80))
        + "d79()", "E127", "50:1",
    ),
    "functions": (
        "let f0(a) = a\n"
        + "".join(f"let f{i}(a) = f{i - 1}(a)\n" for i in range(1, 80))
        + "line by (f79(1)*mm, 0)", "E308", "31:14",
    ),
    "work": (
        "let f0(a) = a\n"
        + "".join(f"let f{i}(a) = f{i - 1}(a) + f{i - 1}(a)\n" for i in range(1, 30))
        + "line by (f29(1)*mm, 0)", "E309", "4:21",
    ),
    "formula": ("curve (1 mm" + " + 0.001*t" * 5_000 + ", 0) for t from 0 to 1 mm", "E309", "1:7"),
}  # fmt: skip


def text_and_path(entry: list[str]) -> tuple[str, Path | None]:
    """The text of a row of the table, and where it stands."""
    return entry[0].replace("~", "\n"), None if "unsaved" in entry[3] else FILES / "a.traj"


def only(entry: list[str]) -> Diagnostic:
    """The message that a row of the table leads to; its texts are too short to draw anything."""
    (one,) = (d for d in found(*text_and_path(entry)) if d.code != "E140" or entry[1] == "E140")
    return one


def found(text: str, path: Path | None = FILES / "a.traj") -> tuple[Diagnostic, ...]:
    """The messages about a text, be it wrong or only odd."""
    try:
        return parse(text, "a.traj", path).notes
    except ScriptError as error:
        return error.diagnostics


CHAIN = {f"{i}.traj": f'include "{i + 1}.traj"' for i in range(12)} | {"12.traj": "hold 1 s"}


# The code, the files, and of the message: its file, line:column and the caret's words.
OF_FILES = [
    ("E271", {"a.traj": 'include "/etc/hosts"'}, "a.traj", '1:9 "/etc/hosts"'),
    ("E271", {"a.traj": 'include "../b.traj"'}, "a.traj", '1:9 "../b.traj"'),
    ("E271", {"a.traj": 'include "in/../../b.traj"'}, "a.traj", '1:9 "in/../../b.traj"'),
    ("E271", {"a.traj": 'include "in/b.traj"', "in/b.traj": '\n  include "../../c.traj"'},
     "in/b.traj", '2:11 "../../c.traj"'),
    ("E272", {"a.traj": 'include "b.traj"'}, "a.traj", '1:9 "b.traj"'),
    ("E272", {"a.traj": 'include "."'}, "a.traj", '1:9 "."'),
    ("E272", {"a.traj": 'include "b.traj"', "b.traj": "\0"}, "a.traj", '1:9 "b.traj"'),
    ("E272", {"a.traj": 'include "b.traj"', "b.traj": "\n# \xfc"}, "a.traj", '1:9 "b.traj"'),
    ("E273", {"a.traj": 'include "b.traj"', "b.traj": 'include "in/c.traj"',
              "in/c.traj": 'let a = 1\ninclude "../b.traj"'}, "in/c.traj", '2:9 "../b.traj"'),
    ("E273", {"a.traj": 'include "a.traj"'}, "a.traj", '1:9 "a.traj"'),
    ("E274", {**CHAIN, "a.traj": 'include "0.traj"'}, "7.traj", '1:9 "8.traj"'),
    ("E205", {"a.traj": 'hold 1 s\ninclude "b.traj"', "b.traj": "# b\n\nline to (nix, 0)"},
     "b.traj", "3:10 nix"),
    ("E120", {"a.traj": 'include "b.traj"', "b.traj": "lin to (1, 0) mm"}, "b.traj", "1:1 lin"),
    ("E305", {"a.traj": 'include "b.traj"\n' + "#" * 1_500_000, "b.traj": "#" * 600_000},
     "a.traj", '1:9 "b.traj"'),
    ("E306", {"a.traj": 'include "b.traj"' + "\n" * 60_000, "b.traj": "\n" * 60_000},
     "a.traj", '1:9 "b.traj"'),
]  # fmt: skip


def write(folder: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(text.encode("latin-1"))
    return folder / "a.traj"
