# ruff: noqa: E501  the table is a table
"""Drawings with a mistake each, and the message that it must lead to."""

from pathlib import Path

from dqpaint.language import ScriptError, parse

# The text (~ ends a line), the code, line:column and the caret's text, message, label, help.
CATALOGUE = r"""
move to (1, 2) mm;|E101|1:18 ;|unexpected character ';'||no ; is needed: one statement per line
let π = 3|E101|1:5 π|unexpected character 'π'||write pi
line to (2r, 0)|E102|1:10 2r|'r' straight after the number 2 is not a unit||units are mm, cm, m, s, ms, deg, °, rad, turn, turns, Hz, K; a product is written 2*r
period 10tool ms|E102|1:8 10tool|'tool' straight after the number 10 is not a unit||put a blank between: 10 tool
line to (2,000, 0) mm|E102|1:12 000|'000' is not a number||commas stand between the numbers of a point; a large one has none: 2000
hold 007.5 s|E102|1:6 007.5|'007.5' is not a number||write 7.5
line to (0,05, 2) cm|E102|1:12 05|'05' is not a number||commas stand between the numbers of a point; a decimal has a point: 0.05
let a = 1.2.3|E102|1:9 1.2.3|'1.2.3' is not a number||write one decimal point
line to (1, 0) inch|E102|1:16 inch|'inch' is not a unit of this language||1 inch is 25.4 mm; units are mm, cm, m, s, ms, deg, °, rad, turn, turns, Hz, K
line to (0, 0, 70 mm|E103|1:9 (|this '(' is never closed|opened here|add ')' before the end of the line
line to (0, 0, 70 mm~line by (1, 0) mm|E103|1:9 (|this '(' is never closed|opened here|add ')' before the end of the line
line to (0, 0)) mm|E104|1:15 )|this ')' closes nothing||take it away, or add '(' before it
arc via (1,2) mm to end|E105|1:21 end|expected a value after 'to' but found 'end'||'end' is a word of the language; it can't be used as a name
speed = 40 mm/s|E105|1:7 =|expected a value after 'speed' but found '='||only 'let' has a '='; for example: speed 40 mm/s
light "red|E107|1:7 "|this text is never closed|opened here|add " before the end of the line
light #ff8800|E108|1:1 light|'light' needs a colour||a # starts a comment; put the colour in quotes: light "#ff8800"
light 40%|E108|1:7 40|'light' needs a colour||the brightness follows the colour: light white 40%
line to (1 2) mm|E109|1:12 2|expected ',' or ')' but found the number 2||put a comma between the numbers of a point, a * between the factors of a product
let|E109|1:1 let|expected a name after 'let' but found the end of the line||for example: let r = 70 mm
start at (9,0) mm~arc centre (0,0) angel 90 deg|E110|2:18 angel|'arc' has no part called 'angel'||did you mean 'angle'?
move by (1,0) mm light red|E110|1:18 light|'move' is always dark, so it has no 'light'||to shine on the way, use: line to …
hold 1 s tool keep|E110|1:10 tool|'hold' has no part called 'tool'||to turn on the spot, use: line by (0, 0) tool …
line (10, 0) mm|E111|1:6 (|'line' needs 'to' or 'by' before the point||line to (…) goes to that point; line by (…) goes that far from here
line to (1,2) mm 5|E112|1:18 5|expected the end of the line but found the number 5||
line to (9,0) mm speed 4 mm/s speed 5 mm/s|E113|1:31 speed|'speed' is given twice|second (first: 1:18)|keep one of them
period 3 ms~period 4 ms|E113|2:1 period|'period' is given twice|second (first: 1:1)|keep one of them
let m = 5|E114|1:5 m|'m' can't be used as a name|'m' is the unit metre|choose another name, for example 'm1'
let angle = 5|E114|1:5 angle|'angle' can't be used as a name|'angle' is a word of the language|choose another name, for example 'angle1'
arc via (1,2) mm|E115|1:1 arc|this 'arc' has no 'to'||an arc through three points ends at the last: via POINT to POINT
arc centre (1,2) mm|E115|1:1 arc|this 'arc' has no 'angle'||add how far it turns: angle 360 deg
repeat i from 1 5~end|E116|1:17 5|expected 'to' but found the number 5||write: repeat i from 1 to 5
traj 2|E118|1:6 2|this file is written in traj 2, which this dqpaint does not know||it knows: traj 1
period 3 ms~traj 1|E119|2:1 traj 1|'traj' is not the first statement||the version of the language comes before all other lines
r = 3 cm|E120|1:1 r|unknown statement 'r'||to name a value, write: let r = 3 cm
lin to (0, 0, 70) mm|E120|1:1 lin|unknown statement 'lin'||did you mean 'line'?
wait 2 s|E120|1:1 wait|unknown statement 'wait'||did you mean 'hold'?
circle (0, 0)|E120|1:1 circle|unknown statement 'circle'||did you mean 'arc centre POINT angle 360 deg'?
color red|E120|1:1 color|unknown statement 'color'||did you mean 'light'?
G1 X10|E120|1:1 G1|unknown statement 'G1'||did you mean 'line to'?
repaet 3~line by (1,0) mm~end|E120|1:1 repaet|unknown statement 'repaet'||did you mean 'repeat'?
if x > 3~line by (1,0) mm~end|E121|1:1 if|.traj has no conditions||use repeat, min/max, or write two files
text Hello height 3 mm|E109|1:6 Hello|expected a text in quotes after 'text' but found 'Hello'||put it in quotes: text "Hello"
text 3 height 3 mm|E109|1:6 3|expected a text in quotes after 'text' but found the number 3||for example: text "Ada" height 30 mm
text “Ada” height 3 mm|E101|1:6 “|unexpected character '“'||a text stands in plain double quotes: "Ada"
let café = 3|E101|1:8 é|unexpected character 'é'||names are made of the letters a to z, digits and _: cafe
let größe = 3|E101|1:7 ö|unexpected character 'ö'||names are made of the letters a to z, digits and _
line by (3 — 1, 0)|E101|1:12 —|unexpected character '—'||write the plain sign -
café — naïve|E120|1:1 café|unknown statement 'café'||a line begins with a word such as line, arc or let, and a comment with #
°é|E120|1:1 °|unknown statement '°'||a line begins with a word such as line, arc or let, and a comment with #
line by (1, 0) mm even|E110|1:19 even|'even' belongs to a light, behind its colour||write: light white even
line by (1, 0) mm light even|E108|1:25 even|'light' needs a colour||the colour comes before it: light white even
include "plain.svg"|E272|1:9 "plain.svg"|only drawings in .traj are included, and this is a .svg file||write: svg "plain.svg"
text "Ada" font scripts height 3 mm|E109|1:17 scripts|expected a name in quotes after 'font' but found 'scripts'||write: font "scripts"
text "Ada" height 3 mm align middle|E109|1:30 middle|expected left, centre or right after 'align' but found 'middle'||did you mean 'centre'?
path "points.csv" unit inch|E109|1:24 inch|expected mm, cm or m after 'unit' but found 'inch'||did you mean 'mm'?
path points.csv unit mm|E101|1:12 .|unexpected character '.'||the name of a file stands in quotes: "points.csv"
text "Hello"|E115|1:1 text|this 'text' has no 'height'||say how high its capitals are: height 30 mm
path "points.csv"|E115|1:1 path|this 'path' has no 'unit'||numbers in a file have no unit; write: unit mm, or height 80 mm
path "points.csv" unit mm height 3 mm|E248|1:19 unit|'unit' and 'height' both say how large it is||keep one of them
path "a" "b" "c" "d" unit mm|E248|1:18 "d"|'path' takes at most 3 files||one file, or one for each of x, y and z
svg "plain.svg" "words.svg"|E248|1:17 "words.svg"|'svg' takes one file||one drawing to a line
text "Ada" height 3 mm tool follow|E254|1:29 follow|the tool can't follow a 'text': it would jump at every corner||use: tool keep
text "Ada" font "script" height 3 mm|E260|1:17 "script"|there is no font "script"||did you mean "scripts"? (dqpaint list fonts shows all)
text "Ada" font "comic" height 3 mm|E260|1:17 "comic"|there is no font "comic"||the fonts are: cursive, futural, futuram, gothiceng, greeks, scripts, timesi, timesr
text "Müller" height 3 mm|E261|1:8 ü|font "futural" has no letter 'ü'|here|use "Mueller"
text "Ada" "λ=3" height 3 mm|E261|1:13 λ|font "futural" has no letter 'λ'|here|font "greeks" has it
text "日本" height 3 mm|E261|1:7 日|font "futural" has no letter '日'|here|take it away; the fonts have the letters of ASCII, and Greek
stroke in 5 s~text "Ada" height 3 mm~end|E283|2:1 text|this 'text' lifts its pen between its 7 lines, and a 'stroke' does not stop||write it outside of the stroke: each of its lines runs through by itself; text … in 5 s
text "  " height 3 mm|E262|1:6 "  "|this text has no letters||to wait, use: hold 1 s
path "flat.csv" height 3 mm|E263|1:24 3 mm|its height is 0, so it can't be scaled to 3 mm||say its width instead
path "points.csv" unit mm|E292|1:6 "points.csv"|a text that is no file can't read one||save it beside the other file
path "/etc/passwd" unit mm|E292|1:6 "/etc/passwd"|a file is named from the folder of the drawing, with / between||for example: "passwd"
path "../files/points.csv" unit mm|E292|1:6 "../files/points.csv"|this file is outside of the drawing's folder||only files beside the drawing or below can be read; copy it there
path "none.csv" unit mm|E293|1:6 "none.csv"|can't read none.csv: no such file or directory||there are: bad.csv, flat.csv, one.csv, points.csv, still.csv, three.csv
path "bad.csv" unit mm|E295|1:6 "bad.csv"|bad.csv, line 3: this row has 'x' where a number should be||a row is 2 or 3 numbers; a comma as decimal sign needs semicolons between the columns
path "one.csv" unit mm|E296|1:6 "one.csv"|one.csv has 1 column||a point has 2 or 3; an axis to a file is written: path "x.txt" "y.txt"
path "one.csv" "three.csv" unit mm|E296|1:16 "three.csv"|three.csv has 3 values, one.csv has 2||each file needs a value for each point
path "one.csv" "flat.csv" unit mm|E296|1:16 "flat.csv"|flat.csv has 2 columns||of several files each is one axis: one value a line
svg "words.svg"|E298|1:5 "words.svg"|can't draw words.svg: there are no lines in it||in the program it was made with, convert texts to paths
svg "bomb.svg"|E298|1:5 "bomb.svg"|can't draw bomb.svg: with every 'use' it has about 10^10 elements||draw a part of it, or make it simpler
svg "points.csv"|E298|1:5 "points.csv"|can't draw points.csv: line 1: syntax error||it is not well-formed XML
svg "flat.svg" height 1e8 m|E201|1:1 svg "flat.svg" height 1e8 m|this goes too far away||
svg "passed.svg"|W421|1:5 "passed.svg"|passed over in passed.svg, as SVG says: line 3: stroke: 'blu' is no colour; line 4: there is no 'nope' to be used; line 5: a <rect> without a size|and 1 more|mend it in the file, or leave it: browsers draw it so, too
svg "otherwise.svg"|W422|1:5 "otherwise.svg"|drawn otherwise than in otherwise.svg: 1 clip-path (line 4), 1 gradient (line 4), 2 stroke-dasharray (from line 3)||what a clip or a mask would hide is drawn, too; a gradient is drawn in its mean colour; dashes are drawn as whole lines
svg "unread.svg"|E298|1:5 "unread.svg"|can't draw unread.svg: line 3: d of a <path>: 'nan' stands where a number of its L is expected||mend it, or save the drawing as plain SVG in the program it was made with
svg "plain.svg"|W420|1:5 "plain.svg"|left out of plain.svg: 1 text (line 2)||in the program it was made with, convert texts to paths
with rotate 3 deg~period 3 ms~end|E123|2:1 period|'period' stands outside of all blocks||write it at the top of the file
line by (1,0) mm~place at (0, 0)|E124|2:1 place|'place' comes too late: the tool has moved already|(first movement: 1:1)|write it before the first movement
repeat 3~line by (1,0) mm|E130|1:1 repeat|this 'repeat' has no 'end'|opened here|add a line 'end' after the last line of the block
# nothing|E140||this file draws nothing||a drawing can be as short as: line to (100, 0) mm
let a = 9^9^9|E201|1:9 9^9^9|this number is too large||
let a = 1e300*1e300|E201|1:9 1e300*1e300|this number is too large||
line to (0,5, 1,0) mm|E202|1:9 (0,5, 1,0) mm|a point has 2 or 3 numbers, this has 4||write decimals with a point, not a comma: 0.5
let a = 1/0|E203|1:11 0|division by zero|this is 0|
line to (1 mm, 20, 3)|E204|1:16 20|the numbers of one point must have the same unit|20 is a plain number|one unit after the bracket is enough: (1, 20, 3) mm
let r = 3 mm~line to (radius, 0)|E205|2:10 radius|'radius' is not known||did you mean 'r'?
line to (radius, 0)|E205|1:10 radius|'radius' is not known||name it first: let radius = …
let a = sinn(3)|E206|1:9 sinn|there is no function 'sinn'||did you mean 'sin'?
let a = rpy(1 deg, 2 deg)|E207|1:9 rpy(1 deg, 2 deg)|rpy takes 3 values, not 2||write: rpy(ANGLE, ANGLE, ANGLE)
let r = 5 mm~let q = r + 5|E208|2:13 5|can't add a length and a plain number|a plain number|did you mean 5 mm?
let q = 5 - 3 s|E208|1:9 5|can't subtract a time from a plain number|a plain number|did you mean 5 s?
let q = 3 mm * red|E209|1:16 red|can't multiply a length by a colour|a colour|
line to (1 mm, 2 mm) cm|E210|1:22 cm|'cm' can't follow here: the value in the brackets is already a length||give the unit once: to each number, or here
let a = 2^3 mm|E211|1:11 3 mm|an exponent is a plain number, this is a length||a unit binds tightest; to give it to the power, write: (2^3) mm
let a = sqrt(-1)|E212|1:14 -1|the square root of a negative number does not exist|this is -1|
let a = sin(30)|E213|1:13 30|sin needs an angle, this is a plain number||say which: sin(30 deg) or sin(30 rad)
start at (0, 0) tool quat(1, 1, 0, 0)|E214|1:22 quat(1, 1, 0, 0)|this quaternion has length 1.414; an orientation needs length 1||the order is quat(w, x, y, z)
start at (0, 0) tool rot((0, 0, 0), 3 deg)|E215|1:26 (0, 0, 0)|a direction can't be (0, 0, 0)||
light "#ff88"|E216|1:7 "#ff88"|"#ff88" is not a colour||a # and 3 or 6 digits from 0 to f: "#ff8800"
light red 140%|E217|1:11 140%|the brightness goes from 0% to 100%||for a brighter picture expose it longer
line to (0, 0, 70)|E218|1:9 (0, 0, 70)|'to' needs a length, but this has no unit|no unit|write (0, 0, 70) mm
speed 40 mm|E218|1:7 40 mm|'speed' needs a speed, but this is a length||write 40 mm/s
period 20|E218|1:8 20|'period' needs a time, but this has no unit|no unit|write 20 ms
hold 20|E218|1:6 20|'hold' needs a time, but this has no unit|no unit|write 20 s
line to 5 mm|E218|1:9 5 mm|'to' needs a point, but this is a length||a point has 2 or 3 numbers in brackets: (5 mm, 0)
line to (1,2) mm light red to (3,4) mm|E218|1:31 (3,4) mm|'light' needs a colour, but this is a point||after a colour, 'to' says which colour comes next; write 'light' after the point
hold 0 s|E220|1:6 0 s|'hold' needs a time greater than 0|this is 0|
line by (1,0) mm samples 2.5|E221|1:26 2.5|'samples' needs a whole number, this is 2.5||
repeat i from 5 to 1~end|E222|1:20 1|'repeat' counts up, but 1 is less than 5||write: repeat i from 1 to 5, and count down with -i
let r = 1 mm~let r = 2 mm|E230|2:5 r|'r' already has a value|(first: 1:5)|values never change; choose another name
curve polar(t*mm, t*rad) for t from 0 to 1 light hsv(t)|E205|1:54 t|'t' has a value in the formula of the curve alone||what stands behind the formula holds for the whole curve; to change on the way, write: light red to blue
curve polar(t*mm, t*rad) for t from 0 to 1 light red in t*1 s|E205|1:57 t|'t' has a value in the formula of the curve alone||what stands behind the formula holds for the whole curve
line to () mm|E105|1:10 )|expected a value after '(' but found ')'||a comma stands between two numbers, as in (10, 20) mm
line to (1,) mm|E105|1:12 )|expected a value after ',' but found ')'||a comma stands between two numbers, as in (10, 20) mm
line to (1,,2) mm|E105|1:12 ,|expected a value after ',' but found ','||a comma stands between two numbers, as in (10, 20) mm
text "Hello~  world" height 20 mm|E107|1:6 "|this text is never closed|opened here|each line of a text has quotes of its own: "Hello" "world"
text "Hello~world~again" height 20 mm|E107|1:6 "|this text is never closed|opened here|each line of a text has quotes of its own: "Hello" "world" "again"
text "Hello" font "scripts~text "world" height 20 mm|E107|1:19 "|this text is never closed|opened here|add " before the end of the line
-- a comment|E120|1:1 -|expected a statement but found '-'||a comment begins with #
// a comment|E120|1:1 /|expected a statement but found '/'||a comment begins with #
% a comment|E120|1:1 %|expected a statement but found '%'||a comment begins with #
; a comment|E101|1:1 ;|unexpected character ';'||a comment begins with #
line by (1, 0) mm ; a comment|E101|1:19 ;|unexpected character ';'||a line holds one statement; a comment begins with #
line by (1, 0) mm -- comment|E205|1:22 comment|'comment' is not known||a comment begins with #
svg "packed.svgz"|E298|1:5 "packed.svgz"|can't draw packed.svgz: it is compressed (.svgz), not a plain SVG||unpack it, or save it as plain SVG in the program it was made with
svg "nosize.svg"|E298|1:5 "nosize.svg"|can't draw nosize.svg: line 1: it has no size, so SVG shows nothing of it||give its viewBox the width and height of what it shows, or take it away
svg "inner.svg"|W421|1:5 "inner.svg"|passed over in inner.svg, as SVG says: line 2: an <svg> without a size||mend it in the file, or leave it: browsers draw it so, too
curve (hsv(t), 0) for t from 0 to 1 turn|E231|1:12 t|hsv can't change along a curve||for a tool that turns on the way, use: tool follow, or tool look
line to (9,0) mm in 2 s samples 30|E241|1:25 samples|the time is given twice|second|use one of: in TIME, samples N, speed V
curve (t, t) for t from 3 mm to 3 mm|E242|1:33 3 mm|this curve ends at the same value where it starts||
curve (mm/t, 0) for t from 0 to 1|E243|1:7 (mm/t, 0)|the curve has no place at t = 0||choose the ends so that they leave this value out
curve (sqrt(t)*mm, 0) for t from 0 to 1|E243|1:7 (sqrt(t)*mm, 0)|the curve has no speed at t = 0||choose the ends so that they leave this value out
start at (9,0) mm~arc centre (0,0) angle 0|E244|2:24 0|an arc of 0 deg goes nowhere||for a full circle write: angle 360 deg
start at (0,0)~arc via (80, 10) mm to (0, 0)|E245|2:24 (0, 0)|this arc ends where it starts, so 'via' does not say in which plane it lies|same as the start point|for a full circle write: arc centre POINT angle 360 deg
arc via (1,1) mm to (2,2) mm|E246|1:9 (1,1) mm|start, via and end lie on one straight line; no circle goes through them||use line to, or move the via point sideways
start at (1,0) mm~arc centre (0,0) to (0, 1) mm|E247|2:18 to|'arc centre' takes an angle, not an end point||centre and end point could contradict each other; write: angle 90 deg
arc via (1,2) mm to (3,0) mm angle 3 deg|E248|1:30 angle|'arc via' goes through two points; it takes no 'angle'||write: arc via POINT to POINT, or: arc centre POINT angle ANGLE
arc centre (0,0) angle 90 deg|E249|1:12 (0,0)|the centre of this arc is where the tool is now: the radius is 0||move to a point of the circle first
start at (9,0) mm~arc centre (0,0) angle 90 deg grow -20 mm|E250|2:36 -20 mm|the radius of this arc would become less than 0|the radius is 9 mm at the start|the least is: grow -9 mm
line by (1,0) mm tool look (0, 0)|E251|1:1 line by (1,0) mm tool look (0, 0)|the tool can't look at the point where it is||look at a point the tool does not go through
start at (-50, 0) mm~line to (50, 0) mm tool look (0, 0)|E251|2:1 line to (50, 0) mm tool look (0, 0)|the tool can't look at the point where it is||look at a point the tool does not go through
start at (-50, 0) mm~curve (t*mm, 0) for t from -50 to 50 tool look (0, 0)|E251|2:1 curve (t*mm, 0) for t from -50 to 50 tool look (0, 0)|the tool can't look at the point where it is||look at a point the tool does not go through
start at (-50, 0, 10) mm~line to (50, 0, 10) mm tool look (0, 0) up z|E252|2:1 line to (50, 0, 10) mm tool look (0, 0) up z|the tool looks along 'up' here, so nothing says how it is turned about that||say another direction: tool look POINT up y
start at (-50, 0) mm~line to (50, 0) mm tool look line (0, 0) along y|E253|2:1 line to (50, 0) mm tool look line (0, 0) along y|the tool can't look at the line it is on||look at a line the tool does not go through
line by (1,0) mm tool look (0, 5) mm|E252|1:1 line by (1,0) mm tool look (0, 5) mm|the tool looks along 'up' here, so nothing says how it is turned about that||say another direction: tool look POINT up z
line by (1,0) mm tool look line (0,0) along x|E253|1:1 line by (1,0) mm tool look line (0,0) along x|the tool can't look at the line it is on||look at a line the tool does not go through
curve (0, 0, t) for t from 0 to 1 mm tool follow|E254|1:7 (0, 0, t)|the curve stands still or goes along the axis, so it has no heading to follow||use: tool keep, or tool look
screw to (1,2) mm|E255|1:10 (1,2) mm|'screw to' needs to know how the tool is held at the end||add: tool rpy(0 deg, 0 deg, 90 deg); to keep the tool as it is, use: line to
profile linear|E205|1:9 linear|'linear' is not known||did you mean 'constant'?
profile fancy|E205|1:9 fancy|'fancy' is not known||the profiles are: constant, trapezoid, cubic, quintic
light rgb(255,0,0)|E206|1:7 rgb|there is no function 'rgb'||write the colour in quotes: "#ff8800"
curve (10 mm*sin(t), 0) for t from 0 to 1|E213|1:18 t|sin needs an angle, this is a plain number||say which: sin(t*deg) or sin(t*rad)
line to 50 mm, 0 mm|E112|1:14 ,|expected the end of the line but found ','||a point stands in brackets: (50, 0) mm; parts of a line need no commas
period 20 s|E257|1:8 20 s|a period is from 0.01 ms to 10 s||an arm is controlled every few milliseconds: period 8 ms
profile cubic(1e300 mm/s, 0 mm/s)|E201|1:15 1e300 mm/s|this number is too large||
line by (5,0) mm by (0,5) mm samples 1|E256|1:1 line by (5,0) mm by (0,5) mm samples 1|2 legs need at least 2 samples||write: samples 2
repeat 10001~line by (1,0) mm~end|E303|1:8 10001|more than 10,000 passes of one 'repeat'|this is 10,001|draw a formula instead: curve … for t from … to …
brush disc 3 mm|E109|1:7 disc|expected a kind of brush but found 'disc'||write: brush point, or brush bar 120 mm along x
brush bar|E105|1:7 bar|'brush bar' needs its length|nothing follows|for example: brush bar 120 mm along x
brush bar 120|E218|1:11 120|'brush bar' needs a length, but this has no unit|no unit|write 120 mm
brush bar 0 mm|E220|1:11 0 mm|'brush bar' needs a length greater than 0|this is 0|
brush bar 20 m|E258|1:11 20 m|a lamp is at most 10 m large||for example: brush bar 120 mm along x
strobe 10|E218|1:8 10|'strobe' needs a frequency, but this has no unit|no unit|write 10 Hz
strobe 0 Hz|E220|1:8 0 Hz|'strobe' needs a frequency greater than 0|this is 0|
strobe 1e9 Hz|E259|1:8 1e9 Hz|a strobe flashes 0.001 to 1,000,000 times a second||for example: strobe 10 Hz 30%
strobe 10 Hz 0%|E217|1:14 0%|a strobe shines for more than 0% and at most 100% of the time||to turn the light off, write: light off
strobe 10 Hz 130%|E217|1:14 130%|a strobe shines for more than 0% and at most 100% of the time||for a steady light write: strobe off; else strobe 10 Hz 30%
strobe 10 Hz 30|E109|1:14 30|expected '%' after the part of the time but found the end of the line||for example: strobe 10 Hz 30%
blend 5|E218|1:7 5|'blend' needs a length, but this has no unit|no unit|write 5 mm
include foo.traj|E109|1:9 foo.traj|the name of a file stands in quotes||write: include "foo.traj"
include "foo.traj"|E271|1:9 "foo.traj"|a text that is no file can't include one||save it beside the other file
let f(3) = 2|E109|1:7 3|expected a name after '(' but found the number 3||for example: let f(x) = 2*x
let f(a, a) = 2|E230|1:10 a|'a' comes twice in these brackets|second|choose another name
let f(a) = a*f(a)|E232|1:12 a*f(a)|'f' can't call itself||repeat and curve go through many values
let f(a) = a*2~line by (f, 0)|E206|2:10 f|'f' is a function||write: f(a)
let f(a) = a*2~line by (f(1, 2)*mm, 0)|E207|2:10 f(1, 2)|f takes 1 value, not 2||write: f(a)
let f(a) = a + 1~line by (f(3 mm), 0)|E208|1:16 1|can't add a length and a plain number|a plain number|did you mean 1 mm?
let f(a) = a*2~line by (ff(1)*mm, 0)|E206|2:10 ff|there is no function 'ff'||did you mean 'f'?
let f(a) = a~f(3)|E206|2:1 f|'f' is a function: it gives a value and draws nothing||use it in a value, or write a 'def'
let r = 3 mm~r(3)|E206|2:1 r|'r' is no 'def', so it can't be drawn||
star(20 mm)|E120|1:1 star|unknown statement 'star'||did you mean 'start'?
staar(20 mm)~def star(r)~line by (r, 0)~end|E120|1:1 staar|unknown statement 'staar'||did you mean 'star'?
def star(r)~line by (r, 0)~end~star()|E207|4:1 star()|star takes 1 value, not 0||write: star(r)
def star(r)~line by (r, 0)~end~star(5)|E218|2:9 (r, 0)|'by' needs a length, but this has no unit|no unit|write (r, 0) mm
def star(r)~line by (r, 0)~star(r)~end|E232|3:1 star(r)|'star' can't call itself||repeat draws its lines several times
def star(r)~line by (r, 0)~end~line by (star(3), 0)|E206|4:10 star|'star' is drawn, it has no value||a call of it is a line of its own
def star(r)~line by (r, 0)~end~line by (star, 0)|E206|4:10 star|'star' is drawn, it has no value||a call of it is a line of its own
def star(r)~period 3 ms~end~star(3)|E123|2:1 period|'period' stands outside of all blocks||write it at the top of the file
def (r)~end|E109|1:5 (|expected a name after 'def' but found '('||for example: def star(r)
def line(r)~end|E114|1:5 line|'line' can't be used as a name|'line' is a word of the language|choose another name, for example 'line1'
frame leaf|E115|1:1 frame|this 'frame' has no 'at'||for example: frame leaf at (30, 0) mm turned 45 deg
frame leaf rotate 3 deg|E110|1:12 rotate|'frame' has no part called 'rotate'||its parts are: at, turned
with frame leaf~line by (1, 0) mm~end|E205|1:12 leaf|'leaf' is not known||name it first: frame leaf at (30, 0) mm
let r = 3 mm~with frame r~line by (1, 0) mm~end|E218|2:12 r|'frame' needs a frame, but this is a length||name one first: frame leaf at (30, 0) mm turned 45 deg
frame leaf at (3, 0) mm~line by leaf|E218|2:9 leaf|'by' needs a point, but this is a frame||a point has 2 or 3 numbers in brackets: (10, 20) mm
stroke in 3 s speed 4 mm/s~line by (1, 0) mm~end|E241|1:15 speed|the time is given twice|second|use one of: in TIME, samples N, speed V
stroke~stroke~line by (1, 0) mm~end~end|E280|2:1 stroke|a stroke within a stroke||one 'stroke' takes any number of lines
stroke~line by (1, 0) mm in 3 s~end|E281|2:19 in|'in' belongs to the whole stroke||write it on its first line: stroke in 2 s
stroke~speed 3 mm/s~line by (1, 0) mm~end|E281|2:1 speed|'speed' belongs to the whole stroke||write it on its first line: stroke speed 40 mm/s
stroke~with profile constant~line by (1, 0) mm~end~end|E281|2:6 profile|'profile' belongs to the whole stroke||write it on its first line: stroke profile trapezoid
stroke~line by (9, 0) mm~hold 1 s~end|E282|3:1 hold 1 s|a pause can't be part of a stroke, which does not stop||end the stroke before it
stroke~line by (9, 0) mm~line by (0, 0) tool rpy(0, 0, 3 deg)~end|E282|3:1 line by (0, 0) tool rpy(0, 0, 3 deg)|a turn on the spot can't be part of a stroke, which does not stop||end the stroke before it
stroke~line by (9, 0) mm~curve (t, 3 mm) for t from 9 mm to 12 mm~end|E283|3:1 curve (t, 3 mm) for t from 9 mm to 12 mm|the tool would have to stop within this stroke||let this line begin where the one before it ends, and the tool look there
blend 5 mm~line by (8, 0) mm by (0, 8) mm by (8, 0) mm|E284|2:1 line by (8, 0) mm by (0, 8) mm by (8, 0) mm|this stroke is too short for its rounded corners: it is 8 mm long|blend 5 mm takes that much from each end|at most: blend 4 mm
blend 5 mm~line by (4, 0) mm by (0, 8) mm|E284|2:1 line by (4, 0) mm by (0, 8) mm|this stroke is too short for its rounded corners: it is 4 mm long|blend 5 mm takes that much from its end|at most: blend 4 mm
blend 5 mm~line by (8, 0) mm by (-8, 0) mm|E286|2:1 line by (8, 0) mm by (-8, 0) mm|the way turns back here, which no arc rounds||switch it off before: blend off
blend 5 mm~line by (8, 0) mm~curve (8 mm, t) for t from 0 to 9 mm|E285|2:1 line by (8, 0) mm|this corner can't be rounded: only those between lines and arcs can||switch it off before: blend off
blend 1 mm~line by (8, 0) mm in 2 s~line by (0, 8) mm in 3 s|E287|3:1 line by (0, 8) mm in 3 s|a rounded corner joins two strokes with different times||say it once for both: stroke … end, or switch it off before: blend off
blend 1 mm~line by (8, 0) mm~line by (0, 8) mm speed 3 mm/s|E287|3:1 line by (0, 8) mm speed 3 mm/s|a rounded corner joins two strokes with different times||say it once for both: stroke … end, or switch it off before: blend off
blend 1 mm~line by (8, 0) mm~line by (0, 8) mm profile quintic|E287|3:1 line by (0, 8) mm profile quintic|a rounded corner joins two strokes with different profiles||say it once for both: stroke … end, or switch it off before: blend off
arc radius 20 mm left|E115|1:1 arc|this 'arc' has no 'to'||add where it ends: arc radius 20 mm to (10, 0) mm left
arc radius 20 mm to (9, 0) mm|E115|1:1 arc|this 'arc' does not say which way it turns||add left (against the clock) or right
arc radius 20 mm to (9, 0) mm left right|E248|1:36 right|an arc turns left or right, not both||keep one of them
arc radius 20 mm to (9, 0) mm left angle 30 deg|E248|1:36 angle|'arc radius' goes from here to a point; it takes no 'angle'||with a centre, the radius is the distance from here to it
arc radius 20 mm to (50, 0) mm left|E291|1:12 20 mm|no circle of radius 20 mm goes through both points|they are 50 mm apart|the least is: radius 25 mm
arc radius 20 mm to (9, 0, 3) mm left|E290|1:21 (9, 0, 3) mm|the end lies 3 mm outside of the plane of this arc||say what it turns about with axis, or use: arc via POINT to POINT
arc radius 20 mm to (0, 0) left|E245|1:21 (0, 0)|this arc ends where it starts, so nothing says where its centre is|same as the start point|for a full circle write: arc centre POINT angle 360 deg
arc centre (9, 0) mm angle 30 deg left|E248|1:35 left|'left' belongs to an arc with a radius||write: arc radius 20 mm to (10, 0) mm left
arc centre (0,0) radius 20 mm angle 1 turn|E248|1:18 radius|'arc centre' takes no 'radius'||the radius is the distance from here to the centre: first move to the circle
arc r 20 mm to (9, 0) mm left|E110|1:5 r|'arc' has no part called 'r'||the radius is the distance from here to the centre: first move to the circle
arc via (3, 3) mm to (9, 0) mm long|E248|1:32 long|'arc via' goes through two points; it takes no 'long'||write: arc via POINT to POINT, or: arc centre POINT angle ANGLE
line by (1, 0) mm~end|E131|2:1 end|'end' without a block to close||only repeat, with, stroke and def are closed with 'end'
arc center (0,0) radius 20 mm angle 1 turn|E248|1:18 radius|'arc centre' takes no 'radius'||the radius is the distance from here to the centre: first move to the circle
include ""|E109|1:9 ""|this text has no name of a file in it||write: include "f.traj"
stroke~line by (9, 0) mm~line by (9, 0) mm tool look (0, 0, -50) mm up y~end|E283|3:1 line by (9, 0) mm tool look (0, 0, -50) mm up y|the tool would have to stop within this stroke||let this line begin where the one before it ends, and the tool look there
line by (0, 0)~line by (1,0) mm|W401|1:9 (0, 0)|this line has no length|already here|to wait, use: hold 1 s
curve (42 mm, t) for t from 0 to 3 mm|W402|1:7 (42 mm, t)|the curve starts 42 mm away from where the tool is||a light-off move is added; write a move to choose its speed
start at (0,0) tool rpy(0,0,0)~line by (1,0) mm tool look (0,0,-5) mm up y|W404|2:1 line by (1,0) mm tool look (0,0,-5) mm up y|the tool turns by 180 deg before this, to look at the point||a light-off turn is added; to avoid it, write: start at (…) tool look …
move to (1,0) mm in 3 s~line by (1,0) mm|W405|1:18 in|the first 'move' only says where the drawing starts; 'in' does nothing||take it away
"""

FILES = Path(__file__).parents[1] / "language/files"
ENTRIES = [line.split("|") for line in CATALOGUE.strip().split("\n")]

LARGE = {  # texts too long for the table, the code, the beginning of the message
    "let a = " + "(" * 70 + "1" + ")" * 70: ("E106", "more than 64 brackets or signs"),
    "let a = " + "-" * 70 + "1": ("E106", "more than 64 brackets or signs"),
    "with rotate 1 deg\n" * 33 + "end\n" * 33: ("E126", "more than 32 blocks"),
    "repeat 9000\nline by (1,0) mm" + " by (-1,0) mm by (1,0) mm" * 4 + "\nend": (
        "E301",
        "more than 50,000 strokes in all",
    ),
    "repeat 9999\n" * 3 + "line by (1,0) mm\n" + "end\n" * 3: (
        "E304",
        "more than 1,000,000 statements in all",
    ),
    " " * 2_000_001: ("E305", "this file is larger than 2 MB"),
    "\n" * 100_001: ("E306", "this file has more than 100,000 lines"),
    "line by\0(1,0) mm": ("E307", "this is not a text"),
    '\n<svg width="9">': ("E307", "this is a drawing in SVG, not a .traj text"),
    '<?xml version="1.0"?>': ("E307", "this is a drawing in SVG, not a .traj text"),
    "let a = 1" + "+1" * 60_000: ("E314", "this line has more than 100,000 words"),
    f'text "{"A" * 1001}" height 3 mm': ("E262", "a text has at most 1,000 letters"),
    "def d0\nhold 1 s\nend\n"
    + "".join(f"def d{i}\nd{i - 1}()\nend\n" for i in range(1, 80))
    + "d79()": ("E127", "more than 64 blocks, calls and files within each other"),
    "let f0(a) = a\n"
    + "".join(f"let f{i}(a) = f{i - 1}(a)\n" for i in range(1, 80))
    + "line by (f79(1)*mm, 0)": ("E308", "too many functions that call each other in turn"),
    "let f0(a) = a\n"
    + "".join(f"let f{i}(a) = f{i - 1}(a) + f{i - 1}(a)\n" for i in range(1, 30))
    + "line by (f29(1)*mm, 0)": ("E309", "the functions of this file have too much to do"),
    "curve (1 mm" + " + 0.001*t" * 5_000 + ", 0) for t from 0 to 1 mm": (
        "E309",
        "a formula of more than 10,000 numbers and signs",
    ),
}


def found(text: str, path: Path | None = FILES / "a.traj") -> tuple:
    """The messages about a text, be it wrong or only odd."""
    try:
        return parse(text, "a.traj", path).notes
    except ScriptError as error:
        return error.diagnostics


CHAIN = {f"{i}.traj": f'include "{i + 1}.traj"' for i in range(12)} | {"12.traj": "hold 1 s"}


# The files, and of the message: file, line:column, the caret's words, what it says.
OF_FILES = {
    "E271": [
        ({"a.traj": 'include "/etc/hosts"'}, "a.traj", '1:9 "/etc/hosts"', "a file to include is"),
        ({"a.traj": 'include "../b.traj"'}, "a.traj", '1:9 "../b.traj"', "this file is outside"),
        ({"a.traj": 'include "in/../../b.traj"'}, "a.traj", "1:9", "this file is outside"),
        (
            {"a.traj": 'include "in/b.traj"', "in/b.traj": '\n  include "../../c.traj"'},
            "in/b.traj",
            '2:11 "../../c.traj"',
            "this file is outside",
        ),
    ],
    "E272": [
        ({"a.traj": 'include "b.traj"'}, "a.traj", '1:9 "b.traj"', "can't read "),
        ({"a.traj": 'include "."'}, "a.traj", '1:9 "."', "can't read "),
        ({"a.traj": 'include "b.traj"', "b.traj": "\0"}, "a.traj", "1:9", ""),
        ({"a.traj": 'include "b.traj"', "b.traj": "\n# \xfc"}, "a.traj", "1:9", ""),
    ],
    "E273": [
        (
            {"a.traj": 'include "b.traj"', "b.traj": 'include "in/c.traj"',
             "in/c.traj": 'let a = 1\ninclude "../b.traj"'},
            "in/c.traj",
            '2:9 "../b.traj"',
            "this include goes in a circle: b.traj includes in/c.traj includes b.traj",
        ),
        ({"a.traj": 'include "a.traj"'}, "a.traj", "1:9",
         "this include goes in a circle: a.traj includes a.traj"),
    ],
    "E274": [
        ({**CHAIN, "a.traj": 'include "0.traj"'}, "7.traj", '1:9 "8.traj"',
         "more than 8 files within each other"),
    ],
    "E205": [
        ({"a.traj": 'hold 1 s\ninclude "b.traj"', "b.traj": "# b\n\nline to (nix, 0)"},
         "b.traj", "3:10 nix", "'nix' is not known"),
    ],
    "E120": [
        ({"a.traj": 'include "b.traj"', "b.traj": "lin to (1, 0) mm"}, "b.traj", "1:1 lin",
         "unknown statement 'lin'"),
    ],
    "E305": [
        ({"a.traj": 'include "b.traj"\n' + "#" * 1_500_000, "b.traj": "#" * 600_000},
         "a.traj", "1:9", "all files together are larger than 2 MB"),
    ],
    "E306": [
        ({"a.traj": 'include "b.traj"' + "\n" * 60_000, "b.traj": "\n" * 60_000},
         "a.traj", "1:9", "all files together have more than 100,000 lines"),
    ],
}  # fmt: skip


def write(folder: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(text.encode("latin-1"))
    return folder / "a.traj"
