"""Parameters of `tune` -> a finished search for gains."""

from typing import TYPE_CHECKING, Annotated, Any

from dqpaint.settings import COMMANDS, Option
from dqpaint.studies.declared.study import STUDIES, VARY, RepeatedStudy, figure_option

if TYPE_CHECKING:
    from dqpaint.studies.kinds import StudyRequest
    from dqpaint.studies.kinds.tuning import Tuning


def _ranges(vary: Any) -> list[str]:
    from dqpaint.studies.experiment.requests import vary_texts

    return vary_texts(vary, span=True)


@STUDIES.add("tune")
class Tune(RepeatedStudy):
    """Find the gains with the least error within an effort bound, and the trade-off of the two.

    The bound is 1 for the effort of an arm that follows the drawing exactly. Seeded; a search that
    was stopped resumes.
    """

    groups = COMMANDS["tune"]
    examples = """Examples:

  dqpaint tune circle --controller p --vary k=2..200 --effort 1.05

  dqpaint tune star --controller hinf --plant compliant --runs 3 --disturb noise=0.0005
"""

    vary: Annotated[
        Any,
        Option(
            "range of a gain, repeatable",
            "GAIN=LOW..HIGH[:lin]",
            unsaid="all of the law's, from a tenth to ten times the default value",
            many=True,
            read=_ranges,
            python=VARY,
        ),
    ] = None
    effort: Annotated[
        float, Option("bound on the effort, times what the drawing itself needs", "X")
    ] = 1.1
    figure: Annotated[str, figure_option("figure to minimise, as in the JSON")] = "error_integral"
    effort_figure: Annotated[str, figure_option("figure that is bounded")] = "command_integral_rad"
    budget: Annotated[int, Option("largest number of runs", "N")] = 300

    def carry_out(self, request: "StudyRequest") -> "Tuning":
        """Tune."""
        from dqpaint.studies.kinds.tune import tune

        return tune(
            request, self.vary or (), self.effort, self.figure, self.effort_figure, self.runs,
            self.budget,
        )  # fmt: skip
