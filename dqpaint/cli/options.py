"""The options of `draw`, most shared by other commands: drawing, arm, law, camera, light."""

from typing import Annotated, Any

import typer

Drawing = Annotated[str, typer.Argument(metavar="FILE", help="a .traj file, or an example's name")]
Law = Annotated[
    str,
    typer.Option(
        metavar="NAME|FILE.py[:NAME]",
        help="control law: see dqpaint list controllers; or a function of your own",
    ),
]
Gain = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME=VALUE",
        help="a gain of that law in SI units; repeatable; 5..20@10% is a ramp in the first 10 %",
    ),
]
Robot = Annotated[
    str | None,
    typer.Option(
        metavar="NAME|FILE",
        help="the arm, or its .urdf or .toml [default: the drawing's, else iiwa]",
    ),
]
Tool = Annotated[
    str | None,
    typer.Option(
        metavar="X,Y,Z[,R,P,Y]",
        help="where the light sits on the flange, m and deg, or with units: 0,0,80mm",
    ),
]
PlaceAt = Annotated[
    str | None,
    typer.Option("--place", metavar="auto", help="put the drawing where it fits the arm best"),
]
Recorded = Annotated[
    str | None,
    typer.Option(
        metavar="RUN.csv", help="paint a real arm's run: t_s and joints or poses, see README"
    ),
]
PlantName = Annotated[
    str | None,
    typer.Option(
        metavar="NAME[:KEY=VALUE,...]",
        help="how the arm answers, such as compliant:frequency=60 [default: stiff, or torque for "
        "its laws]",
    ),
]
Disturb = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME=VALUE,...",
        help="a disturbance, repeatable, such as twist=sine,x=0.02,frequency=2",
    ),
]
Seed = Annotated[int, typer.Option(help="of everything random")]
Null = Annotated[
    str,
    typer.Option(
        metavar="NAME[,gain=VALUE]",
        help="what a redundant arm does with its freedom: see dqpaint list null",
    ),
]
OnLimit = Annotated[
    str,
    typer.Option(
        metavar="clip|slow|stop",
        help="where a joint would pass a limit: hold it back, slow the drawing down, or end",
    ),
]
From = Annotated[str, typer.Option("--from", metavar="first|home", help="where the arm begins")]
Size = Annotated[str, typer.Option(metavar="WxH", help="of the picture, in pixels")]
View = Annotated[
    str,
    typer.Option(
        metavar="VIEW",
        help="front, iso, side, top, or AZ,EL: degrees to its right and above; stereo[:VIEW], "
        "orbit[:N[:EL]], at:X:Y:Z[:X:Y:Z] m; several with commas",
    ),
]
Ev = Annotated[float, typer.Option(help="exposure in stops, on top of the automatic one")]
Brush = Annotated[
    str | None,
    typer.Option(metavar="NAME[:KEY=VALUE,...]", help="what shines; see: dqpaint list brushes"),
]
Pwm = Annotated[float, typer.Option(metavar="HZ", help="dim the lamps by pulses; 0: evenly")]
Exposure = Annotated[
    str | None,
    typer.Option(
        metavar="SETTINGS",
        help="a camera's, in any order: f/8,iso100,35mm,nd3,0.1cd,2.2m [default: automatic]",
    ),
]
Look = Annotated[
    str, typer.Option(metavar="NAME", help="how it is developed; see: dqpaint list looks")
]
Starburst = Annotated[int, typer.Option(metavar="BLADES", help="of an aperture that draws rays")]
Noise = Annotated[int | None, typer.Option(metavar="SEED", help="of the sensor's noise")]
ColourBy = Annotated[
    str | None,
    typer.Option(
        metavar="FIGURE[:END]",
        help="that the colours tell: position-error, orientation-error, speed, manipulability, "
        "line; END of the scale, such as position-error:20",
    ),
]
Overlay = Annotated[bool, typer.Option(help="the asked drawing beneath")]
Magnify = Annotated[float, typer.Option(metavar="N", help="deviations, N times as large")]
Ghost = Annotated[bool, typer.Option(help="the arm in the picture, and room for it")]
MotionGhost = Annotated[
    bool, typer.Option("--motion-ghost", help="the arm as a veil, seen all through its motion")
]
Occlusion = Annotated[
    bool | None,
    typer.Option(help="the arm's body hides light from the camera [default: as --ghost]"),
]
MaxSamples = Annotated[
    int, typer.Option(metavar="N", help="that the drawing may have; each takes about 1 kB")
]
SettingsFile = Annotated[
    str | None,
    typer.Option(
        "--settings",
        metavar="FILE",
        help="a TOML of these options, or the JSON of a run; what is typed wins",
    ),
]
Out = Annotated[
    str | None,
    typer.Option(metavar="PATH", help="a folder, or the stem of the files [default: here]"),
]
Save = Annotated[
    str, typer.Option(metavar="A,B,...", help="formats to write; see: dqpaint list formats")
]


def typed(context: typer.Context, **choices: Any) -> dict[str, Any]:
    """The choices that were typed, by name; None for those that were left to their defaults."""
    typed_in = {
        name for name in context.params
        if (source := context.get_parameter_source(name)) and source.name == "COMMANDLINE"
    }  # fmt: skip
    return {name: value if name in typed_in else None for name, value in choices.items()}
