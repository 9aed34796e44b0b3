"""A painting -> its numbers: tables and the summary."""

import json
from typing import TYPE_CHECKING

from dqpaint.outputs.registry import writer

if TYPE_CHECKING:
    from dqpaint.painting import paint


@writer("csv", ".csv")
def csv(painting: "paint.Painting") -> bytes:
    """One row a control step: reference, true and measured state, command."""
    from dqpaint.outputs.tables import encode_csv

    return encode_csv(painting.table)


@writer("motion", "-motion.csv")
def motion(painting: "paint.Painting") -> bytes:
    """The reference, with twist and acceleration: a CSV."""
    from dqpaint.metrics import motion_columns
    from dqpaint.outputs.tables import encode_csv

    return encode_csv(motion_columns(painting.motion))


@writer("json", ".json")
def summary(painting: "paint.Painting") -> bytes:
    """The settings of the run and its figures."""
    from dqpaint.outputs.summary import summarise

    return (json.dumps(summarise(painting), indent=2, allow_nan=False) + "\n").encode()
