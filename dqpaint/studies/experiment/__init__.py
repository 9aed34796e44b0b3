"""Axes of choices and results of runs -> cells with figures, means and tests."""

from dqpaint.studies.experiment.axes import Axis, parse_axis, parse_laws, parse_list
from dqpaint.studies.experiment.cells import check_figure

__all__ = ["Axis", "check_figure", "parse_axis", "parse_laws", "parse_list"]
