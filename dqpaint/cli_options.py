"""The options that several commands share: which drawing, which arm, which law."""

from typing import Annotated

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
        metavar="NAME", help="how the arm answers [default: stiff, or torque for its laws]"
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
From = Annotated[str, typer.Option("--from", metavar="first|home", help="where the arm begins")]
Out = Annotated[
    str | None,
    typer.Option(metavar="PATH", help="a folder, or the stem of the files [default: here]"),
]
