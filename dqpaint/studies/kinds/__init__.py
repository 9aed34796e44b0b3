"""The studies, one a file: drawings and choices -> runs -> tables, charts and verdicts.

A new study is a class under `@STUDIES.add("name")` in a file here, or of another package by entry
points of the group `dqpaint.studies`: its command, its call from Python and its line in
`dqpaint list studies` follow from it.
"""

from dqpaint.studies.experiment.cells import find_figure
from dqpaint.studies.kinds.study import (
    STUDIES, RepeatedStudy, Study, StudyOfAlternatives, StudyRequest, Subject, figure_option,
    run_study,
)
from dqpaint.studies.kinds.study_result import StudyResult
from dqpaint.studies.report.charts import HeatMap, Line, Panel
from dqpaint.studies.report.page import Charts, Map
from dqpaint.studies.runner.run import Run

__all__ = [
    "STUDIES", "Charts", "HeatMap", "Line", "Map", "Panel", "RepeatedStudy", "Run", "Study",
    "StudyOfAlternatives", "StudyRequest", "StudyResult", "Subject", "figure_option", "find_figure",
    "run_study",
]
