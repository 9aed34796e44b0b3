"""A law, plant, study or other thing of one's own -> what every one of its kind promises, checked.

    from dqpaint.testing import check_plant
    check_plant("mine")

Each check takes the name under which a thing is registered, or the thing itself; it returns nothing
and raises an AssertionError that says what is not kept. dqpaint's own tests run the same checks
over everything that is built in. A new kind of plugin brings its check here.
"""

from dqpaint.testing.brushes import check_brush
from dqpaint.testing.controllers import check_controller
from dqpaint.testing.disturbances import check_disturbance
from dqpaint.testing.metrics import check_metric
from dqpaint.testing.plants import check_plant
from dqpaint.testing.studies import check_study
from dqpaint.testing.writers import check_writer

__all__ = [
    "check_brush", "check_controller", "check_disturbance", "check_metric", "check_plant",
    "check_study", "check_writer",
]
