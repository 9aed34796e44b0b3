"""A run -> columns of the table and figures of the summary.

A new metric is a function in `columns` under `@column`, or in `figures` under `@figure`, with its
name, unit, title and meaning: tables, summaries, studies, colours and pages then have it. Other
packages bring theirs by entry points of the group `dqpaint.metrics`.
"""

from dqpaint.metrics import (  # noqa: F401  the order of table and summary
    columns, figures, step_figures, walls,
)
from dqpaint.metrics.attenuation import Attenuation, attenuation
from dqpaint.metrics.registry import (
    METRICS, Column, Figure, Metric, Table, Values, all_columns, all_figures, column, figure,
    motion_column, unit_suffix,
)
from dqpaint.metrics.run_metrics import Metrics, measure, motion_columns, reference_columns
from dqpaint.metrics.judgement import Fault, Judgement, judge, limits_text
from dqpaint.metrics.step_response import (
    PartResponse, StepCurve, StepResponse, step_curves, step_responses,
)

__all__ = [
    "METRICS", "Attenuation", "Column", "Fault", "Figure", "Judgement", "Metric", "Metrics",
    "PartResponse", "StepCurve", "StepResponse", "Table", "Values", "all_columns", "all_figures",
    "attenuation", "column", "figure", "judge", "limits_text", "measure", "motion_column",
    "motion_columns", "reference_columns", "step_curves", "step_responses", "unit_suffix",
]
