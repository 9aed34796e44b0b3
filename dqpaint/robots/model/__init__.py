"""The data of an arm: card, tool mount; Denavit-Hartenberg rows or screws -> a chain."""

from dqpaint.robots.model.card import DEFAULT_ROBOT, Card, card_names, installed_names, read_card
from dqpaint.robots.model.fields import Mount
from dqpaint.robots.model.task import POSE, TASKS, Task, find_task
from dqpaint.robots.model.tool_mount import parse_tool

__all__ = [
    "DEFAULT_ROBOT", "POSE", "TASKS", "Card", "Mount", "Task", "card_names", "find_task",
    "installed_names", "parse_tool", "read_card",
]
