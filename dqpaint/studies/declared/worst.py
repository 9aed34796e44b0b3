"""Parameters of `worst` -> the disturbances that laws answer worst."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from dqpaint.settings import COMMANDS, DEFAULT_CONTROLLER, Option
from dqpaint.studies.declared.study import STUDIES, Study

if TYPE_CHECKING:
    from dqpaint.studies.kinds import StudyRequest
    from dqpaint.studies.kinds.worst import Worst


@STUDIES.add("worst")
class WorstStudy(Study):
    """Seek the disturbance of a given size that a law answers worst, beside what it promises.

    First in the loop of the law alone, up the gradient; then on the arm. What is found is a CSV
    that --disturb twist=FILE.csv takes.
    """

    groups = COMMANDS["tune"]
    replaced = ("controller", "plant", "disturb", "recorded")
    examples = """Examples:

  dqpaint worst lag --plants ideal,compliant --controllers hinf,p

  dqpaint worst lag --plants ideal --controllers "hinf(K_T=62.5,K_O=125)" --turn 37
"""

    controllers: Annotated[
        Any,
        Option(
            "the laws, with gains of their own; they command twists",
            "A,B(GAIN=VALUE),...",
            unsaid=DEFAULT_CONTROLLER,
            python="Sequence[str] | str",
        ),
    ] = None
    plants: Annotated[
        Any,
        Option("the plants", "A,B(KEY=VALUE),...", unsaid="ideal", python="Sequence[str] | str"),
    ] = None
    error: Annotated[
        Literal["translation", "rotation", "both"],
        Option("which error is to be large", "translation|rotation|both"),
    ] = "both"
    size: Annotated[
        float | None,
        Field(gt=0, le=1e3),
        Option(
            "rms of the disturbance, m/s or rad/s",
            "X",
            unsaid="0.01 m/s; 0.1 rad/s, and K_O where the law has one",
        ),
    ] = None
    turn: Annotated[
        float,
        Field(ge=0, le=1e3, allow_inf_nan=False),
        Option("rad/s at which it may turn the tool besides, where translation is sought", "X"),
    ] = 0.0
    rounds: Annotated[
        int, Field(ge=0, le=10_000), Option("of the search in the loop of the law alone", "N")
    ] = 20
    trials: Annotated[
        int, Field(ge=1, le=10_000), Option("runs on each plant other than ideal", "N")
    ] = 9

    def carry_out(self, request: "StudyRequest") -> "Worst":
        """Seek."""
        from dqpaint.studies.kinds.worst import seek

        return seek(request, self)
