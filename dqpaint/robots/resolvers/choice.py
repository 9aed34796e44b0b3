"""Settings and a drawing -> task and resolver of a run; an option goes before a statement."""

from dqpaint.program import Program
from dqpaint.robots.model import Task, find_task
from dqpaint.robots.resolvers.resolver import DEFAULT_RESOLVER
from dqpaint.settings import Settings


def task_of(settings: Settings, program: Program) -> Task:
    """The task of a run.

    Raises:
        UnknownNameError: there is none of that name.
    """
    return find_task(settings.task or program.task or "pose")


def resolver_of(settings: Settings, program: Program) -> str:
    """The resolver of a run, as text: the one that is chosen, else the one that holds walls."""
    return settings.resolver or ("qp" if program.walls else DEFAULT_RESOLVER)
