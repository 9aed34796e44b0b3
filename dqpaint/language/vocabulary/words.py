"""Words of the language -> their syntax, values and examples, as tables.

The parser, its messages and its suggestions all read these tables, and so does whatever is made
from them: the reference, completion, grammars for editors. A new word is a line here first.
"""

from dqpaint.core import record


@record
class PartWord:
    """A word within a statement that takes a value, such as `to` or `speed`.

    Attributes:
        word: as it is written.
        takes: the kind of value: a dimension or a kind of value; or `tool`, `light`, `brush`,
            `strobe`, `blend`, `corner`, which have a grammar of their own; or `flag`, for no value.
        meaning: its meaning in one line.
        example: the word with a value, ready to paste.
    """

    word: str
    takes: str
    meaning: str
    example: str


@record
class StatementWord:
    """A word that begins a line.

    Attributes:
        word: as it is written.
        meaning: its meaning in one line.
        example: a whole line, ready to paste.
        head: kind of the values between the word and its parts; empty for none.
        parts: the parts it may have.
        needs: the required parts.
        many: the parts that may be repeated.
        block: whether it holds the lines up to an `end`.
        moves: whether the tool moves or time passes.
    """

    word: str
    meaning: str
    example: str
    head: str = ""
    parts: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()
    many: tuple[str, ...] = ()
    block: bool = False
    moves: bool = False


SHAPES = ("circle", "ellipse", "rect", "polygon", "star")  # closed, around their middle
LAMP = ("light", "brush", "strobe")  # what shines, and how
MODAL = (
    "speed",
    "turnspeed",
    "profile",
    "tool",
    "blend",
    "corner",
    *LAMP,
)  # each holds until it is set again
TIMES = ("in", "samples")
TIMING_WORDS = (*TIMES, "speed", "turnspeed", "profile")  # set by a `stroke` for all of its lines
CLAUSES = (*TIMES, *MODAL)
FILL = ("fill", "angle")
DARK_CLAUSES = tuple(word for word in CLAUSES if word not in LAMP)

PARTS = {
    part.word: part
    for part in (
        PartWord("to", "place", "the point to go to", "to (10, 0) mm"),
        PartWord("by", "shift", "how far to go from here", "by (10, 0) mm"),
        PartWord("via", "place", "a point the arc goes through", "via (10, 10) mm"),
        PartWord("at", "place", "where", "at (0, 0) mm"),
        PartWord("centre", "place", "the centre of the arc", "centre (0, 0)"),
        PartWord("center", "place", "the same as centre", "center (0, 0)"),
        PartWord("axis", "direction", "what the arc turns about; z if not said", "axis z"),
        PartWord("angle", "angle", "how far it turns, by the right-hand rule", "angle 360 deg"),
        PartWord("radius", "length", "the radius of an arc to a point", "radius 20 mm"),
        PartWord("inner", "length", "how far in a star's inner corners lie", "inner 10 mm"),
        PartWord("left", "flag", "the arc turns left, against the clock", "left"),
        PartWord("right", "flag", "the arc turns right, with the clock", "right"),
        PartWord("long", "flag", "the longer of two arcs: more than half a turn", "long"),
        PartWord("rise", "length", "how far it advances along the axis in all", "rise 7 cm"),
        PartWord("grow", "length", "how much the radius grows in all", "grow -3 cm"),
        PartWord("about", "place", "a point of the axis", "about (0, 0, 0)"),
        PartWord("along", "direction", "the direction of the axis", "along z"),
        PartWord("pitch", "pitch", "the advance for each turn", "pitch 150 mm/turn"),
        PartWord("rotate", "rotation", "the block, turned", "rotate 30 deg"),
        PartWord("mirror", "direction", "the block, mirrored along this direction", "mirror x"),
        PartWord("shift", "shift", "the block, moved", "shift (80, 0) mm"),
        PartWord("scale", "number", "the block, larger or smaller", "scale 0.5"),
        PartWord("frame", "frame", "the block, in a frame that has a name", "frame leaf"),
        PartWord("turned", "rotation", "which way round", "turned rpy(0 deg, 0 deg, 90 deg)"),
        PartWord("in", "time", "how long it takes", "in 2 s"),
        PartWord("samples", "count", "how many samples it takes", "samples 300"),
        PartWord("speed", "speed", "the speed the tool cruises at", "speed 40 mm/s"),
        PartWord("turnspeed", "turnspeed", "the speed of a turn on the spot", "turnspeed 60 deg/s"),
        PartWord("profile", "profile", "how the speed goes along a stroke", "profile trapezoid"),
        PartWord("tool", "tool", "what the tool does meanwhile", "tool look (0, 0, 300) mm"),
        PartWord("blend", "blend", "corners rounded within this distance", "blend 5 mm"),
        PartWord(
            "corner", "corner", "how far the path leaves a corner it runs through", "corner 0.1 mm"
        ),
        PartWord("light", "light", "the colour, or from one colour to another", "light red"),
        PartWord("fill", "length", "lines inside what is closed, this far apart", "fill 2 mm"),
        PartWord("font", "font", "which letters; see: dqpaint list fonts", 'font "scripts"'),
        PartWord("height", "length", "how high: a capital letter, a whole drawing", "height 30 mm"),
        PartWord("width", "length", "how wide: the longest line, a whole drawing", "width 90 mm"),
        PartWord("align", "alignment", "which end of each line stands at `at`", "align centre"),
        PartWord("unit", "unit", "of the numbers in a file", "unit mm"),
        PartWord("order", "order", "which line comes when: kept, not shortened", "order as drawn"),
        PartWord("as", "style", "how a photo is painted: hatch or spiral", "as hatch"),
        PartWord("detail", "length", "how far apart its strokes are", "detail 0.8 mm"),
        PartWord("cross", "flag", "drawn a second time, across", "cross"),
        PartWord("colours", "colours", "of the lamp: a number, or full", "colours full"),
        PartWord("max", "time", "how long it may take: coarser if need be", "max 300 s"),
        PartWord("dark", "share", "the tone below which it stays black", "dark 5%"),
        PartWord("smooth", "flag", "bends from point to point, but for sharp corners", "smooth"),
        PartWord("within", "angle", "how far off it may point", "within 50 deg"),
        PartWord("for", "holder", "what is kept: tool or beam; else all links", "for tool"),
        PartWord("base", "flag", "coordinates are those of the robot's base", "base"),
        PartWord("brush", "brush", "what shines, with its values", "brush bar 120 mm along x"),
        PartWord(
            "strobe", "strobe", "the light flashes, for a part of the time", "strobe 10 Hz 30%"
        ),
    )
}

STATEMENTS = {
    statement.word: statement
    for statement in (
        StatementWord("traj", "the version of the language", "traj 1", head="version"),
        StatementWord("robot", "the arm the drawing is for", "robot iiwa", head="robot"),
        StatementWord("task", "what of the tool's pose is controlled", "task beam", head="task"),
        StatementWord("include", "the lines of another file", 'include "f.traj"', head="include"),
        StatementWord("let", "a name for a value, or a function", "let r = 70 mm", head="let"),
        StatementWord(
            "frame",
            "a name for a place and a turn, for 'with frame'",
            "frame leaf at (30, 0) mm turned 45 deg",
            head="frame",
            parts=("at", "turned"),
        ),
        StatementWord(
            "place",
            "the drawing frame in the robot's base frame, or auto: where it fits best",
            "place at (600, 0, 500) mm",
            head="place",
            parts=("at", "turned"),
        ),
        StatementWord(
            "start",
            "where the drawing begins",
            "start at (0, 0, 0) tool rpy(0 deg, 0 deg, 0 deg)",
            parts=("at", "tool"),
            needs=("at",),
        ),
        StatementWord(
            "wall",
            "a wall that the arm does not pass, below or above x, y or z",
            "wall below z = -50 mm",
            head="wall",
            parts=("for", "base", "by", "in"),
        ),
        StatementWord(
            "keep",
            "where the arm stays: inside a box, away from an obstacle, its links apart",
            "keep away from sphere at (0, 0, 80) mm radius 30 mm",
            head="keep",
            parts=("to", "at", "along", "radius", "scale", "for", "base", "by", "in"),
        ),
        StatementWord(
            "face",
            "where the tool's z axis points: to the viewer, or along a direction",
            "face viewer within 50 deg",
            head="face",
            parts=("within", "base"),
            needs=("within",),
        ),
        StatementWord("period", "the time between two samples", "period 8 ms", head="value"),
        *(
            StatementWord(word, f"{PARTS[word].meaning}, from here on", PARTS[word].example, word)
            for word in MODAL
        ),
        StatementWord(
            "line",
            "a straight stroke, or several",
            "line to (10, 0) mm",
            parts=("to", "by", *CLAUSES),
            many=("to", "by"),
            moves=True,
        ),
        StatementWord(
            "move",
            "a straight way in the dark",
            "move to (10, 0) mm",
            parts=("to", "by", *DARK_CLAUSES),
            many=("to", "by"),
            moves=True,
        ),
        StatementWord(
            "arc",
            "an arc, circle, helix or flat spiral",
            "arc centre (30, 0) mm angle 360 deg",
            parts=(
                *("via", "to", "centre", "center", "axis", "angle", "rise", "grow"),
                *("radius", "left", "right", "long"),
                *CLAUSES,
            ),
            moves=True,
        ),
        *(
            StatementWord(
                word,
                meaning,
                example,
                head="value" if word in ("polygon", "star") else "",
                parts=(*needs, *more, "at", *FILL, *CLAUSES),
                needs=needs,
                moves=True,
            )
            for word, meaning, example, needs, more in (
                ("circle", "a circle around its middle", "circle radius 30 mm", ("radius",), ()),
                (
                    "ellipse",
                    "an ellipse around its middle",
                    "ellipse width 60 mm height 30 mm",
                    ("width", "height"),
                    (),
                ),
                (
                    "rect",
                    "a rectangle around its middle",
                    "rect width 60 mm height 30 mm",
                    ("width", "height"),
                    (),
                ),
                (
                    "polygon",
                    "a polygon of equal sides; its first corner is the topmost",
                    "polygon 6 radius 30 mm",
                    ("radius",),
                    (),
                ),
                (
                    "star",
                    "a star with so many points, the first one upwards",
                    "star 5 radius 30 mm inner 12 mm",
                    ("radius",),
                    ("inner",),
                ),
            )
        ),
        StatementWord(
            "screw",
            "a screw motion of the whole tool",
            "screw about (0, 0, 0) along z angle 90 deg pitch 50 mm/turn",
            parts=("about", "along", "angle", "pitch", "to", *CLAUSES),
            moves=True,
        ),
        StatementWord(
            "curve",
            "any formula",
            "curve polar(40 mm, t) for t from 0 to 360 deg",
            head="formula",
            parts=CLAUSES,
            moves=True,
        ),
        StatementWord(
            "step",
            "a jump of the set point",
            "step to (50, 50, -20) mm",
            parts=("to", "tool", *LAMP),
            needs=("to",),
            moves=True,
        ),
        StatementWord(
            "text",
            "lettering; a further string in quotes is a further line",
            'text "Ada" height 30 mm',
            head="texts",
            parts=("font", "height", "width", "at", "align", *FILL, *CLAUSES),
            moves=True,
        ),
        StatementWord(
            "path",
            "a line through the points in a file, or in a file for each axis",
            'path "orbit.csv" unit cm',
            head="texts",
            parts=("unit", "height", "width", "at", "smooth", *CLAUSES),
            moves=True,
        ),
        StatementWord(
            "svg",
            "the lines of an SVG drawing, in its own colours",
            'svg "logo.svg" height 80 mm',
            head="texts",
            parts=("height", "width", "at", "order", *FILL, *CLAUSES),
            moves=True,
        ),
        StatementWord(
            "photo",
            "a photograph, its light solved for",
            'photo "astronaut.jpg" height 200 mm as hatch',
            head="texts",
            parts=(
                *("height", "width", "at", "as", "detail", "angle", "cross"),
                *("colours", "max", "dark"),
                *CLAUSES,
            ),
            needs=("as",),
            moves=True,
        ),
        StatementWord("hold", "a pause", "hold 1 s", head="value", parts=LAMP, moves=True),
        StatementWord(
            "repeat", "its lines, several times", "repeat i from 1 to 5", head="repeat", block=True
        ),
        StatementWord(
            "with",
            "its lines, turned, mirrored, moved, scaled or set differently",
            "with rotate 30 deg shift (80, 0) mm",
            parts=("rotate", "about", "mirror", "shift", "scale", "frame", *MODAL),
            many=("rotate", "about", "mirror", "shift", "scale", "frame"),
            block=True,
        ),
        StatementWord(
            "stroke",
            "its lines in one go, without a stop between them",
            "stroke in 5 s",
            parts=CLAUSES,
            block=True,
        ),
        StatementWord(
            "def",
            "lines with a name, drawn where it is called: star(20 mm)",
            "def star(r)",
            head="def",
            block=True,
        ),
        StatementWord("end", "closes a block", "end"),
    )
}

# Words of drawings of earlier versions, and what `dqpaint fmt` writes for them.
RENAMED = {"law": "profile"}

LITTLE_WORDS = (
    *("from", "for", "on", "off", "even", "keep", "follow", "look", "up", "point", "bar", "auto"),
    *("jump", "hue", "rainbow"),
)

# What a task controls: the names that `task` takes.
TASKS = ("pose", "beam", "point", "place-first")

CONSTANTS = ("pi", "x", "y", "z")
# Profiles, each with what may stand in brackets after it.
PROFILES = {
    "constant": ("",),
    "trapezoid": ("",),
    "cubic": ("", "(v0, v1)"),
    "quintic": ("", "(v0, v1, a0, a1)"),
    "smooth": ("", "(a, j)"),
}

# How each function is called, for messages and completion.
FUNCTIONS = {
    "sin": "sin(ANGLE)",
    "cos": "cos(ANGLE)",
    "tan": "tan(ANGLE)",
    "asin": "asin(NUMBER)",
    "acos": "acos(NUMBER)",
    "atan": "atan(NUMBER)",
    "sqrt": "sqrt(VALUE)",
    "abs": "abs(VALUE)",
    "min": "min(VALUE, VALUE)",
    "max": "max(VALUE, VALUE)",
    "exp": "exp(NUMBER)",
    "ln": "ln(NUMBER)",
    "polar": "polar(RADIUS, ANGLE)",
    "rgb": "rgb(RED, GREEN, BLUE)",
    "hsv": "hsv(HUE) or hsv(HUE, SATURATION, VALUE)",
    "rpy": "rpy(ANGLE, ANGLE, ANGLE)",
    "rot": "rot(AXIS, ANGLE)",
    "quat": "quat(W, X, Y, Z)",
}

# Never part of an expression: a value was forgotten if one of them is found there.
# But these have a meaning in a few statements only, and `let radius = …` is common; shapes may be
# the names of a `def`, too, since drawings had their own before there were these.
FREE = (
    *SHAPES,
    *("as", "base", "colours", "corner", "cross", "dark", "detail", "fill", "height", "hue"),
    *("inner", "jump", "left", "long", "max", "mirror", "order", "radius", "rainbow", "right"),
    *("smooth", "unit", "width", "within"),
)
RESERVED = frozenset(
    (*STATEMENTS, *PARTS, *RENAMED, *LITTLE_WORDS, "if", "else", "while")
).difference(FREE)
