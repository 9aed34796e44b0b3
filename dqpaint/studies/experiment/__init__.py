"""Axes of choices and results of runs -> cells with figures, means and tests."""

from dqpaint.studies.experiment.cells import check_figure

__all__ = ["check_figure", "requests"]
