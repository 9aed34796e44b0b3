"""A commanded twist, a task and limits -> joint rates: resolvers, by their names."""

from dqpaint.robots.resolvers.choice import resolver_of, task_of
from dqpaint.robots.resolvers.pseudo_inverses import PseudoInverse
from dqpaint.robots.resolvers.qp import USUAL_APPROACH, Bounds, Held, Qp
from dqpaint.robots.resolvers.resolver import (
    DEFAULT_RESOLVER, RESOLVERS, Resolver, Setup, State, make_resolver, planning_resolver,
    read_resolver,
)

__all__ = [
    "DEFAULT_RESOLVER", "RESOLVERS", "USUAL_APPROACH", "Bounds", "Held", "PseudoInverse", "Qp",
    "Resolver", "Setup", "State", "make_resolver", "planning_resolver", "read_resolver",
    "resolver_of", "task_of",
]
