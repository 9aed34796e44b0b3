"""The studies by their names -> their parameters; what runs them is in `kinds`.

A new study is a class under `@STUDIES.add("name")` in a file here, or of another package by entry
points of the group `dqpaint.studies`: its command, its call from Python and its line in
`dqpaint list studies` follow from it.
"""

from dqpaint.studies.declared.study import (
    STUDIES, RepeatedStudy, Study, StudyOfAlternatives, Subject, figure_option, run_study,
)

__all__ = [
    "STUDIES", "RepeatedStudy", "Study", "StudyOfAlternatives", "Subject", "figure_option",
    "run_study",
]
