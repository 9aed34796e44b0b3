"""A run -> columns of the table and figures of the summary."""

from dqpaint.metrics.attenuation import Attenuation, attenuation
from dqpaint.metrics.run_metrics import Metrics, Table, asked_columns, measure, motion_columns
from dqpaint.metrics.stability import instability
from dqpaint.metrics.step_response import Response, SetPoint, set_points

__all__ = [
    "Attenuation",
    "Metrics",
    "Response",
    "SetPoint",
    "Table",
    "asked_columns",
    "attenuation",
    "instability",
    "measure",
    "motion_columns",
    "set_points",
]
