"""Names of colours, hex digits, HSV or temperatures -> linear RGB, 1 for full brightness.

Names are those of CSS Color Module Level 4 (W3C); they and `#ff8800` are sRGB (IEC 61966-2-1).
"""

import colorsys

Colour = tuple[float, float, float]  # linear RGB, 1 for full brightness

_CSS = """
aliceblue f0f8ff antiquewhite faebd7 aqua 00ffff aquamarine 7fffd4 azure f0ffff beige f5f5dc
bisque ffe4c4 black 000000 blanchedalmond ffebcd blue 0000ff blueviolet 8a2be2 brown a52a2a
burlywood deb887 cadetblue 5f9ea0 chartreuse 7fff00 chocolate d2691e coral ff7f50
cornflowerblue 6495ed cornsilk fff8dc crimson dc143c cyan 00ffff darkblue 00008b darkcyan 008b8b
darkgoldenrod b8860b darkgray a9a9a9 darkgreen 006400 darkgrey a9a9a9 darkkhaki bdb76b
darkmagenta 8b008b darkolivegreen 556b2f darkorange ff8c00 darkorchid 9932cc darkred 8b0000
darksalmon e9967a darkseagreen 8fbc8f darkslateblue 483d8b darkslategray 2f4f4f
darkslategrey 2f4f4f darkturquoise 00ced1 darkviolet 9400d3 deeppink ff1493 deepskyblue 00bfff
dimgray 696969 dimgrey 696969 dodgerblue 1e90ff firebrick b22222 floralwhite fffaf0
forestgreen 228b22 fuchsia ff00ff gainsboro dcdcdc ghostwhite f8f8ff gold ffd700
goldenrod daa520 gray 808080 green 008000 greenyellow adff2f grey 808080 honeydew f0fff0
hotpink ff69b4 indianred cd5c5c indigo 4b0082 ivory fffff0 khaki f0e68c lavender e6e6fa
lavenderblush fff0f5 lawngreen 7cfc00 lemonchiffon fffacd lightblue add8e6 lightcoral f08080
lightcyan e0ffff lightgoldenrodyellow fafad2 lightgray d3d3d3 lightgreen 90ee90 lightgrey d3d3d3
lightpink ffb6c1 lightsalmon ffa07a lightseagreen 20b2aa lightskyblue 87cefa
lightslategray 778899 lightslategrey 778899 lightsteelblue b0c4de lightyellow ffffe0 lime 00ff00
limegreen 32cd32 linen faf0e6 magenta ff00ff maroon 800000 mediumaquamarine 66cdaa
mediumblue 0000cd mediumorchid ba55d3 mediumpurple 9370db mediumseagreen 3cb371
mediumslateblue 7b68ee mediumspringgreen 00fa9a mediumturquoise 48d1cc mediumvioletred c71585
midnightblue 191970 mintcream f5fffa mistyrose ffe4e1 moccasin ffe4b5 navajowhite ffdead
navy 000080 oldlace fdf5e6 olive 808000 olivedrab 6b8e23 orange ffa500 orangered ff4500
orchid da70d6 palegoldenrod eee8aa palegreen 98fb98 paleturquoise afeeee palevioletred db7093
papayawhip ffefd5 peachpuff ffdab9 peru cd853f pink ffc0cb plum dda0dd powderblue b0e0e6
purple 800080 rebeccapurple 663399 red ff0000 rosybrown bc8f8f royalblue 4169e1
saddlebrown 8b4513 salmon fa8072 sandybrown f4a460 seagreen 2e8b57 seashell fff5ee sienna a0522d
silver c0c0c0 skyblue 87ceeb slateblue 6a5acd slategray 708090 slategrey 708090 snow fffafa
springgreen 00ff7f steelblue 4682b4 tan d2b48c teal 008080 thistle d8bfd8 tomato ff6347
turquoise 40e0d0 violet ee82ee wheat f5deb3 white ffffff whitesmoke f5f5f5 yellow ffff00
yellowgreen 9acd32
"""


def linear(encoded: float) -> float:
    """One sRGB channel, 0 to 1, as linear light (IEC 61966-2-1)."""
    return encoded / 12.92 if encoded <= 0.04045 else ((encoded + 0.055) / 1.055) ** 2.4


def encoded(light: float) -> float:
    """Linear light, 0 to 1, as an sRGB channel: the inverse of `linear`."""
    return 12.92 * light if light <= 0.0031308 else 1.055 * light ** (1.0 / 2.4) - 0.055


def from_hex(digits: str) -> Colour | None:
    """The colour of `ff8800` or `f80`; None if the text is not a colour."""
    if len(digits) == 3:
        digits = "".join(2 * digit for digit in digits)
    if len(digits) != 6 or not set(digits) <= set("0123456789abcdefABCDEF"):
        return None
    red, green, blue = (linear(int(digits[i : i + 2], 16) / 255) for i in (0, 2, 4))
    return red, green, blue


DIGITS: dict[str, str] = dict(zip(_CSS.split()[::2], _CSS.split()[1::2], strict=True))
NAMES: dict[str, Colour] = {
    name: colour for name, digits in DIGITS.items() if (colour := from_hex(digits)) is not None
}
WHITE: Colour = (1.0, 1.0, 1.0)
DARK: Colour = (0.0, 0.0, 0.0)


def from_hsv(turn: float, saturation: float, value: float) -> Colour:
    """The colour of hue (1 is a full turn), saturation and value in sRGB, as in CSS tools."""
    red, green, blue = colorsys.hsv_to_rgb(turn % 1.0, saturation, value)
    return linear(red), linear(green), linear(blue)


def to_hsv(colour: Colour) -> tuple[float, float, float]:
    """Hue (1 is a full turn), saturation and value of a colour: the inverse of `from_hsv`."""
    return colorsys.rgb_to_hsv(*map(encoded, colour))


def by_hue(first: Colour, last: Colour, share: float, long: bool) -> Colour:
    """The colour at a share, 0 to 1, of the way between two round the circle of hues.

    Hue, saturation and value change evenly; the hue of a grey is that of the other colour.

    Args:
        first: at 0.
        last: at 1.
        share: of the way.
        long: the longer way round, all of it where the hues are the same; else the shorter.
    """
    (h, s, v), (k, t, w) = to_hsv(first), to_hsv(last)
    h, k = (k if s == 0.0 else h), (h if t == 0.0 else k)
    turn = (k - h + 0.5) % 1.0 - 0.5
    if long:
        turn += 1.0 if turn <= 0.0 else -1.0
    return from_hsv(h + share * turn, s + share * (t - s), v + share * (w - v))


# Once round the hues, from red to violet.
RAINBOW = (from_hsv(0.0, 1.0, 1.0), from_hsv(280.0 / 360.0, 1.0, 1.0))


COLDEST, HOTTEST = 1000.0, 15000.0  # [K] of `from_temperature`


def from_temperature(kelvin: float) -> Colour:
    """The colour of a black body at a temperature [K], with its brightest channel 1.

    Chromaticity on the Planckian locus by the polynomials of Krystek, A., "An algorithm to
    calculate correlated colour temperature", Color Res. Appl. 10 (1985) 38, good from 1000 K to
    15000 K; to linear sRGB by the matrix of IEC 61966-2-1. Below about 1900 K the colour lies
    outside what sRGB can show and is clipped.
    """
    t = kelvin
    u = (0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t * t) / (
        1.0 + 8.42420235e-4 * t + 7.08145163e-7 * t * t
    )
    v = (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t * t) / (
        1.0 - 2.89741816e-5 * t + 1.61456053e-7 * t * t
    )
    # CIE 1960 (u, v) to (x, y), then to X, Z with Y = 1.
    x, y = 3.0 * u / (2.0 * u - 8.0 * v + 4.0), 2.0 * v / (2.0 * u - 8.0 * v + 4.0)
    big_x, big_z = x / y, (1.0 - x - y) / y
    channels = (
        3.2404542 * big_x - 1.5371385 - 0.4985314 * big_z,
        -0.9692660 * big_x + 1.8760108 + 0.0415560 * big_z,
        0.0556434 * big_x - 0.2040259 + 1.0572252 * big_z,
    )
    brightest = max(channels)
    red, green, blue = (max(0.0, channel / brightest) for channel in channels)
    return red, green, blue


def mix(first: Colour, last: Colour, share: float) -> Colour:
    """The colour at a share, 0 to 1, between two colours."""
    return (
        first[0] + (last[0] - first[0]) * share,
        first[1] + (last[1] - first[1]) * share,
        first[2] + (last[2] - first[2]) * share,
    )


def dim(colour: Colour, brightness: float) -> Colour:
    """A colour with its light multiplied by `brightness`."""
    return colour[0] * brightness, colour[1] * brightness, colour[2] * brightness
