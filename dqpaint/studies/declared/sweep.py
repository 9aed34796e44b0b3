"""Parameters of `sweep` -> a finished sweep."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

from dqpaint.settings import COMMANDS, Option
from dqpaint.studies.declared.study import STUDIES, VARY, StudyOfAlternatives, figure_option

if TYPE_CHECKING:
    from dqpaint.studies.kinds import StudyRequest
    from dqpaint.studies.kinds.sweep import Sweep


@STUDIES.add("sweep")
class SweepStudy(StudyOfAlternatives):
    """Run a drawing over one or two axes of values: table, and a curve or a heat map.

    Points without a result are marked. A sweep that was stopped resumes.
    """

    groups = COMMANDS["sweep"]
    examples = """Examples:

  dqpaint sweep star --controller p --vary k=5..400:log:9

  dqpaint sweep star --vary gamma_T=0.01..1:log:5 --vary disturb.twist.x=0,0.01,0.02
"""

    vary: Annotated[
        Any,
        Option(
            "a gain, plant, robot, disturb.NAME.VALUE ...: k=5,10,20 or k=1..100:log:9; once or "
            "twice",
            "NAME=VALUES",
            many=True,
            python=VARY,
        ),
    ] = None
    figure: Annotated[
        str, figure_option("figure that is tested and drawn: see dqpaint list figures")
    ] = "position_error_rms_m"

    x: Annotated[
        str | None,
        Option("of two axes the one to draw lines over", "AXIS", unsaid="a heat map"),
    ] = None
    scale: Annotated[
        Literal["auto", "linear", "log"], Option("of the figure", "auto|linear|log")
    ] = "auto"
    x_scale: Annotated[
        Literal["auto", "linear", "log"], Option("of the axis it is drawn over", "auto|linear|log")
    ] = "auto"

    def carry_out(self, request: "StudyRequest") -> "Sweep":
        """Sweep."""
        from dqpaint.studies.experiment import requests
        from dqpaint.studies.kinds.sweep import SweepShape, sweep

        axes, base = requests.read_sweep(self.vary or (), request.choices, self.several)
        shape = SweepShape(self.x, self.scale, self.x_scale)
        return sweep(request, axes, base, self.runs, self.figure, shape)
