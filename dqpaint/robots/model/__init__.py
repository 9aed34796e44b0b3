"""The data of an arm: card, tool mount; Denavit-Hartenberg rows or screws -> a chain."""

from dqpaint.robots.model.card import DEFAULT_ROBOT, Card, card_names, installed_names, read_card
from dqpaint.robots.model.fields import Mount
from dqpaint.robots.model.tool_mount import parse_tool

__all__ = [
    "DEFAULT_ROBOT", "Card", "Mount", "card_names", "installed_names", "parse_tool", "read_card",
]
