"""What papers measured and claim: a TOML file a replay -> its experiment, numbers and tables.

A new replay of a drawing under some laws is a new file here alone.
"""

from dqpaint.studies.replay.papers.paper import (
    Cell,
    Claim,
    Figure,
    Paper,
    find_paper_drawing,
    paper_names,
    read_paper,
)

__all__ = [
    "Cell",
    "Claim",
    "Figure",
    "Paper",
    "find_paper_drawing",
    "paper_names",
    "read_paper",
]
