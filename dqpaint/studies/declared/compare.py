"""Parameters of `compare` -> a finished comparison."""

from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from dqpaint.settings import COMMANDS, Option
from dqpaint.studies.declared.study import STUDIES, StudyOfAlternatives, figure_option

if TYPE_CHECKING:
    from dqpaint.studies.kinds import StudyRequest
    from dqpaint.studies.kinds.compare import Comparison


@STUDIES.add("compare")
class Compare(StudyOfAlternatives):
    """Paint one drawing by several laws, plants, arms or disturbances: pictures, errors, a table.

    With --runs each is done with several seeds, and the table has means and standard deviations.
    """

    groups = COMMANDS["compare"]
    defaults: ClassVar = {"size": "640x360"}
    examples = """Examples:

  dqpaint compare lag --controllers "hinf,p,p(k=5)"

  dqpaint compare lag --controllers hinf,pff --runs 10 --disturb twist=noise,x=0.02,frequency=5
"""

    figure: Annotated[
        str, figure_option("figure that is tested and drawn: see dqpaint list figures")
    ] = "error_integral"

    baseline: Annotated[
        str | None, Option("a law, plant or arm that all others are tested against", "NAME")
    ] = None
    pairs: Annotated[
        str | None, Option("which are tested: hinf:p,hinf:pff", "A:B,...", unsaid="all of a family")
    ] = None
    test: Annotated[
        Literal["t", "wilcoxon"],
        Option("of runs with the same seeds: Student's paired t, or Wilcoxon's", "t|wilcoxon"),
    ] = "t"

    band: Annotated[
        Literal["std", "quantiles", "none"],
        Option("about the curve of several runs", "std|quantiles|none"),
    ] = "std"
    scale: Annotated[
        Literal["auto", "linear", "log"], Option("of the errors in charts", "auto|linear|log")
    ] = "auto"
    panels: Annotated[
        str | None, Option("a chart for each plant, robot ..., its laws over each other", "AXIS")
    ] = None
    span: Annotated[
        str | None, Option("seconds that charts show, such as 0..0.5", "A..B", unsaid="all")
    ] = None

    def carry_out(self, request: "StudyRequest") -> "Comparison":
        """Compare."""
        from dqpaint.studies.experiment import comparisons, requests
        from dqpaint.studies.kinds.compare import compare
        from dqpaint.studies.report.pictures import ChartChoice

        axes, base = requests.read_comparison(request.choices, self.several, **self.defaults)
        several = [axis for axis in axes if len(axis.texts) > 1] or axes[:1]
        chosen = comparisons.choose(several, self.baseline, self.pairs, self.test)
        shape = ChartChoice(self.band, self.scale, self.panels, requests.read_span(self.span))
        return compare(request, axes, base, self.runs, self.figure, chosen, shape)
