"""Unit words -> dimensions and SI factors, and the names of dimensions in messages."""

import math

# Exponents of length, time, angle and temperature.
Dimension = tuple[float, float, float, float]

PLAIN: Dimension = (0.0, 0.0, 0.0, 0.0)
LENGTH: Dimension = (1.0, 0.0, 0.0, 0.0)
TIME: Dimension = (0.0, 1.0, 0.0, 0.0)
ANGLE: Dimension = (0.0, 0.0, 1.0, 0.0)
TEMPERATURE: Dimension = (0.0, 0.0, 0.0, 1.0)
SPEED: Dimension = (1.0, -1.0, 0.0, 0.0)
TURNSPEED: Dimension = (0.0, -1.0, 1.0, 0.0)
ACCELERATION: Dimension = (1.0, -2.0, 0.0, 0.0)
JERK: Dimension = (1.0, -3.0, 0.0, 0.0)
TURN_ACCELERATION: Dimension = (0.0, -2.0, 1.0, 0.0)
PITCH: Dimension = (1.0, 0.0, -1.0, 0.0)
FREQUENCY: Dimension = (0.0, -1.0, 0.0, 0.0)

LARGEST_EXPONENT = 24.0  # of a unit; nothing in a drawing has mm^25

# Each unit in SI, its dimension and its name in words.
UNITS: dict[str, tuple[float, Dimension, str]] = {
    "mm": (1e-3, LENGTH, "millimetre"),
    "cm": (1e-2, LENGTH, "centimetre"),
    "m": (1.0, LENGTH, "metre"),
    "s": (1.0, TIME, "second"),
    "ms": (1e-3, TIME, "millisecond"),
    "deg": (math.pi / 180.0, ANGLE, "degree"),
    "°": (math.pi / 180.0, ANGLE, "degree"),
    "rad": (1.0, ANGLE, "radian"),
    "turn": (2.0 * math.pi, ANGLE, "turn"),
    "turns": (2.0 * math.pi, ANGLE, "turn"),
    "Hz": (1.0, FREQUENCY, "hertz"),
    "K": (1.0, TEMPERATURE, "kelvin"),
}

# Units people write that are not ours, and what to write instead.
FOREIGN_UNITS = {
    "sec": "s",
    "second": "s",
    "seconds": "s",
    "min": "s",
    "us": "ms",
    "degree": "deg",
    "degrees": "deg",
    "radians": "rad",
    "rads": "rad",
    "rev": "turn",
    "revs": "turn",
    "meter": "m",
    "metre": "m",
    "meters": "m",
    "km": "m",
    "inch": "mm",
    "px": "mm",
    "pt": "mm",
    "MM": "mm",
    "CM": "cm",
    "M": "m",
    "S": "s",
    "hz": "Hz",
    "HZ": "Hz",
    "k": "K",
}

# Those of them that are the same by another name, so that no number changes.
SAME_UNITS = {
    word: unit
    for word, unit in FOREIGN_UNITS.items()
    if word not in ("min", "us", "km", "inch", "px", "pt")
}
_ONE_OF_THEM = {"min": "60 s", "us": "0.001 ms", "km": "1000 m", "inch": "25.4 mm"}


def instead_of(word: str) -> str:
    """The unit of this language to write in place of a unit of other languages."""
    known = f"units are {', '.join(UNITS)}"
    if word in _ONE_OF_THEM:
        return f"1 {word} is {_ONE_OF_THEM[word]}; {known}"
    return f"did you mean '{FOREIGN_UNITS[word]}'? {known}"


NAMES = {
    PLAIN: "a plain number",
    LENGTH: "a length",
    TIME: "a time",
    ANGLE: "an angle",
    TEMPERATURE: "a temperature",
    SPEED: "a speed",
    TURNSPEED: "a turning speed",
    ACCELERATION: "an acceleration",
    JERK: "a jerk",
    TURN_ACCELERATION: "a turning acceleration",
    PITCH: "a length per angle",
    FREQUENCY: "a frequency",
    (2.0, 0.0, 0.0, 0.0): "an area",
    (1.0, 0.0, 1.0, 0.0): "a length times an angle",
}


def dimension_name(dimension: Dimension) -> str:
    """The name of a dimension with its article: `a length`, `a quantity in m^3/s`."""
    name = NAMES.get(dimension)
    if name is not None:
        return name
    above, below = "", ""
    for exponent, unit in zip(dimension, ("m", "s", "rad", "K"), strict=True):
        size = abs(exponent)
        if size:
            power = unit if size == 1 else f"{unit}^{size:g}"
            if exponent > 0:
                above += ("*" if above else "") + power
            else:
                below += "/" + power
    return f"a quantity in {above or '1'}{below}"


def plausible_unit(value: float, dimension: Dimension, word: str = "") -> str:
    """The most likely unit of a number without one: `period 20` means ms, not s."""
    size = abs(value)
    if dimension == LENGTH:
        return "mm" if size >= 1 or size == 0 else "m"
    if dimension == TIME:
        return "ms" if word == "period" and size >= 0.5 else "s"
    if dimension == ANGLE:
        return "deg" if size >= 7 or float(value).is_integer() else "rad"
    return {
        SPEED: "mm/s" if size >= 1 or size == 0 else "m/s",
        TURNSPEED: "deg/s" if size >= 7 or float(value).is_integer() else "rad/s",
        PITCH: "mm/turn",
        FREQUENCY: "Hz",
        ACCELERATION: "mm/s/s" if size >= 20 else "m/s/s",
        JERK: "mm/s/s/s" if size >= 500 else "m/s/s/s",
        TURN_ACCELERATION: "deg/s/s",
        TEMPERATURE: "K",
    }.get(dimension, "")
