"""A name, `.urdf` or `.toml` -> a checked card, with defaults for what the file does not say."""

from dqpaint.robots.loading.lookup import card_for, find_card, with_tool

__all__ = ["card_for", "find_card", "with_tool"]
