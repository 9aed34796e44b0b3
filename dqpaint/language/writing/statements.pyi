"""The statements as methods of a drawing, for editors and type checkers.

Written by python -m tests.tools.generated from the tables of the language.
"""

# ruff: noqa: E501
# fmt: off
from contextlib import AbstractContextManager
from typing import Any

class Statements:
    def traj(self, *values: Any) -> None:
        """The version of the language: `d.traj("1")`."""
    def robot(self, *values: Any) -> None:
        """The arm the drawing is for: `d.robot("iiwa")`."""
    def task(self, *values: Any) -> None:
        """What of the tool's pose is controlled: `d.task("beam")`."""
    def include(self, *values: Any) -> None:
        """The lines of another file: `d.include("f.traj")`."""
    def let(self, *values: Any) -> None:
        """A name for a value, or a function: `d.let("r", "70 mm")`."""
    def frame(self, *values: Any, at: Any = ..., turned: Any = ...) -> None:
        """A name for a place and a turn, for 'with frame': `d.frame("leaf", at="(30, 0) mm", turned="45 deg")`."""
    def place(self, *values: Any, at: Any = ..., turned: Any = ...) -> None:
        """The drawing frame in the robot's base frame, or auto: where it fits best: `d.place(at="(600, 0, 500) mm")`."""
    def start(self, *, at: Any = ..., tool: Any = ...) -> None:
        """Where the drawing begins: `d.start(at="(0, 0, 0)", tool="rpy(0 deg, 0 deg, 0 deg)")`."""
    def wall(self, *values: Any, for_: Any = ..., base: bool = ..., by: Any = ..., in_: Any = ...) -> None:
        """A wall that the arm does not pass, below or above x, y or z: `d.wall("below z = -50 mm")`."""
    def keep(self, *values: Any, to: Any = ..., at: Any = ..., along: Any = ..., radius: Any = ..., scale: Any = ..., for_: Any = ..., base: bool = ..., by: Any = ..., in_: Any = ...) -> None:
        """Where the arm stays: inside a box, away from an obstacle, its links apart: `d.keep("away from sphere", at="(0, 0, 80) mm", radius="30 mm")`."""
    def face(self, *values: Any, within: Any = ..., base: bool = ...) -> None:
        """Where the tool's z axis points: to the viewer, or along a direction: `d.face("viewer", within="50 deg")`."""
    def period(self, *values: Any) -> None:
        """The time between two samples: `d.period("8 ms")`."""
    def speed(self, *values: Any) -> None:
        """The speed the tool cruises at, from here on: `d.speed("40 mm/s")`."""
    def turnspeed(self, *values: Any) -> None:
        """The speed of a turn on the spot, from here on: `d.turnspeed("60 deg/s")`."""
    def profile(self, *values: Any) -> None:
        """How the speed goes along a stroke, from here on: `d.profile("trapezoid")`."""
    def tool(self, *values: Any) -> None:
        """What the tool does meanwhile, from here on: `d.tool("look (0, 0, 300) mm")`."""
    def blend(self, *values: Any) -> None:
        """Corners rounded within this distance, from here on: `d.blend("5 mm")`."""
    def corner(self, *values: Any) -> None:
        """How far the path leaves a corner it runs through, from here on: `d.corner("0.1 mm")`."""
    def light(self, *values: Any) -> None:
        """The colour, or from one colour to another, from here on: `d.light("red")`."""
    def brush(self, *values: Any) -> None:
        """What shines, with its values, from here on: `d.brush("bar 120 mm along x")`."""
    def strobe(self, *values: Any) -> None:
        """The light flashes, for a part of the time, from here on: `d.strobe("10 Hz 30%")`."""
    def line(self, *, to: Any = ..., by: Any = ..., in_: Any = ..., samples: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> None:
        """A straight stroke, or several: `d.line(to="(10, 0) mm")`."""
    def move(self, *, to: Any = ..., by: Any = ..., in_: Any = ..., samples: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ...) -> None:
        """A straight way in the dark: `d.move(to="(10, 0) mm")`."""
    def arc(self, *, via: Any = ..., to: Any = ..., centre: Any = ..., center: Any = ..., axis: Any = ..., angle: Any = ..., rise: Any = ..., grow: Any = ..., radius: Any = ..., left: bool = ..., right: bool = ..., long: bool = ..., in_: Any = ..., samples: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> None:
        """An arc, circle, helix or flat spiral: `d.arc(centre="(30, 0) mm", angle="360 deg")`."""
    def circle(self, *, radius: Any = ..., at: Any = ..., fill: Any = ..., angle: Any = ..., in_: Any = ..., samples: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> None:
        """A circle around its middle: `d.circle(radius="30 mm")`."""
    def ellipse(self, *, width: Any = ..., height: Any = ..., at: Any = ..., fill: Any = ..., angle: Any = ..., in_: Any = ..., samples: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> None:
        """An ellipse around its middle: `d.ellipse(width="60 mm", height="30 mm")`."""
    def rect(self, *, width: Any = ..., height: Any = ..., at: Any = ..., fill: Any = ..., angle: Any = ..., in_: Any = ..., samples: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> None:
        """A rectangle around its middle: `d.rect(width="60 mm", height="30 mm")`."""
    def polygon(self, *values: Any, radius: Any = ..., at: Any = ..., fill: Any = ..., angle: Any = ..., in_: Any = ..., samples: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> None:
        """A polygon of equal sides; its first corner is the topmost: `d.polygon("6", radius="30 mm")`."""
    def star(self, *values: Any, radius: Any = ..., inner: Any = ..., at: Any = ..., fill: Any = ..., angle: Any = ..., in_: Any = ..., samples: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> None:
        """A star with so many points, the first one upwards: `d.star("5", radius="30 mm", inner="12 mm")`."""
    def screw(self, *, about: Any = ..., along: Any = ..., angle: Any = ..., pitch: Any = ..., to: Any = ..., in_: Any = ..., samples: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> None:
        """A screw motion of the whole tool: `d.screw(about="(0, 0, 0)", along="z", angle="90 deg", pitch="50 mm/turn")`."""
    def curve(self, *values: Any, in_: Any = ..., samples: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> None:
        """Any formula: `d.curve("polar(40 mm, t)", "t", 0, "360 deg")`."""
    def step(self, *, to: Any = ..., tool: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> None:
        """A jump of the set point: `d.step(to="(50, 50, -20) mm")`."""
    def text(self, *values: Any, font: Any = ..., height: Any = ..., width: Any = ..., at: Any = ..., align: Any = ..., fill: Any = ..., angle: Any = ..., in_: Any = ..., samples: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> None:
        """Lettering; a further string in quotes is a further line: `d.text("Ada", height="30 mm")`."""
    def path(self, *values: Any, unit: Any = ..., height: Any = ..., width: Any = ..., at: Any = ..., smooth: bool = ..., in_: Any = ..., samples: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> None:
        """A line through the points in a file, or in a file for each axis: `d.path("orbit.csv", unit="cm")`."""
    def svg(self, *values: Any, height: Any = ..., width: Any = ..., at: Any = ..., order: Any = ..., fill: Any = ..., angle: Any = ..., in_: Any = ..., samples: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> None:
        """The lines of an SVG drawing, in its own colours: `d.svg("logo.svg", height="80 mm")`."""
    def photo(self, *values: Any, height: Any = ..., width: Any = ..., at: Any = ..., as_: Any = ..., detail: Any = ..., angle: Any = ..., cross: bool = ..., colours: Any = ..., max: Any = ..., dark: Any = ..., in_: Any = ..., samples: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> None:
        """A photograph, its light solved for: `d.photo("astronaut.jpg", height="200 mm", as_="hatch")`."""
    def hold(self, *values: Any, light: Any = ..., brush: Any = ..., strobe: Any = ...) -> None:
        """A pause: `d.hold("1 s")`."""
    def repeat(self, *values: Any) -> AbstractContextManager[None]:
        """Its lines, several times: `d.repeat("i", 1, 5), or d.repeat(5)`."""
    def block(self, *, rotate: Any = ..., about: Any = ..., mirror: Any = ..., shift: Any = ..., scale: Any = ..., frame: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> AbstractContextManager[None]:
        """Its lines, turned, mirrored, moved, scaled or set differently: `d.block(rotate="30 deg", shift="(80, 0) mm")`."""
    def stroke(self, *, in_: Any = ..., samples: Any = ..., speed: Any = ..., turnspeed: Any = ..., profile: Any = ..., tool: Any = ..., blend: Any = ..., corner: Any = ..., light: Any = ..., brush: Any = ..., strobe: Any = ...) -> AbstractContextManager[None]:
        """Its lines in one go, without a stop between them: `d.stroke(in_="5 s")`."""
    def define(self, *values: Any) -> AbstractContextManager[None]:
        """Lines with a name, drawn where it is called: star(20 mm): `d.define("star", "r")`."""
