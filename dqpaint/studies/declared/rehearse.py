"""Parameters of `rehearse` -> a finished rehearsal."""

from typing import TYPE_CHECKING, Annotated, ClassVar

from pydantic import Field

from dqpaint.settings import COMMANDS, Option
from dqpaint.studies.declared.study import STUDIES, Study

if TYPE_CHECKING:
    from dqpaint.studies.kinds import StudyRequest
    from dqpaint.studies.kinds.rehearse import Rehearsal


@STUDIES.add("rehearse")
class Rehearse(Study):
    """Draw, learn from the error, draw again: each trial follows a path that the last one taught.

    What is learned is a path, whatever the law: --learned follows it. It stops where a trial is
    worse than the one before. With --recordings a real arm rehearses: the first file is its run of
    the drawing, each other one its run along the path that those before have taught.
    """

    groups = COMMANDS["compare"]
    replaced = ("recorded", "learned")
    defaults: ClassVar = {"size": "640x360"}
    examples = """Examples:

  dqpaint rehearse lag --controller p --plant compliant

  dqpaint rehearse star --recordings first.csv,second.csv
"""

    trials: Annotated[int, Field(ge=1, le=100), Option("at most so many", "N")] = 6
    gamma: Annotated[
        float,
        Field(gt=0, lt=2, allow_inf_nan=False),
        Option("share of the error that a trial takes off", "X"),
    ] = 0.7
    cutoff: Annotated[
        float,
        Field(ge=0, le=1e5, allow_inf_nan=False),
        Option("corner of the low pass over what is learned; 0: no filter", "HZ"),
    ] = 6.0
    lead: Annotated[
        int | None,
        Field(ge=0, le=10000),
        Option("periods by which the arm answers late", "N", unsaid="measured in the first trial"),
    ] = None
    recordings: Annotated[
        str | None,
        Option("runs of a real arm, in their order, instead of simulated ones", "A.csv,B.csv,..."),
    ] = None

    def carry_out(self, request: "StudyRequest") -> "Rehearsal":
        """Rehearse."""
        from dqpaint.studies.kinds.rehearse import rehearse

        return rehearse(request, self)
