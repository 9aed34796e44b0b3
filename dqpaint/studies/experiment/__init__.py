"""Axes of choices and results of runs -> cells with figures, means and tests."""

from dqpaint.studies.experiment.cells import check_figure
from dqpaint.studies.experiment.statistics import paired_verdict

__all__ = ["check_figure", "paired_verdict", "requests"]
