"""What studies ask -> runs -> tables, charts and verdicts; `declared` has their parameters."""

from dqpaint.studies.experiment.cells import find_figure
from dqpaint.studies.kinds.study_request import StudyRequest
from dqpaint.studies.kinds.study_result import StudyResult
from dqpaint.studies.report.charts import HeatMap, Line, Panel
from dqpaint.studies.report.page import Charts, Map
from dqpaint.studies.runner.run import Run

__all__ = [
    "Charts", "HeatMap", "Line", "Map", "Panel", "Run", "StudyRequest", "StudyResult",
    "find_figure",
]
