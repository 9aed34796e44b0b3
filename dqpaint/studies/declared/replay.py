"""Parameters of `replay` -> a paper's experiment, done again."""

from typing import TYPE_CHECKING, Annotated

from dqpaint.settings import COMMANDS, Option, read_choices
from dqpaint.studies.declared.study import STUDIES, Study, Subject

if TYPE_CHECKING:
    from dqpaint.studies.kinds import StudyRequest
    from dqpaint.studies.kinds.replay import Replay


@STUDIES.add("replay")
class ReplayStudy(Study):
    """Repeat a paper's experiment: its numbers beside ours, and which of its claims hold.

    Every verdict follows from the numbers of this run; the paper's own are judged alike.
    """

    subject = Subject("NAME", "see: dqpaint list replays")
    groups = COMMANDS["replay"]
    whole = False
    examples = """Examples:

  dqpaint replay thesis-spiral --runs 10

  dqpaint replay ozgur-cost
"""

    runs: Annotated[
        int | None, Option("runs of each choice, with the seeds that follow --seed", "N")
    ] = None

    def carry_out(self, request: "StudyRequest") -> "Replay":
        """Replay."""
        from dqpaint.studies.kinds.replay import replay
        from dqpaint.studies.replay.measures import MeasureRequest

        measured = MeasureRequest(
            request.folder, self.runs, request.jobs, read_choices(request.choices),
            request.reporter,
        )  # fmt: skip
        return replay(str(request.subject), measured)
