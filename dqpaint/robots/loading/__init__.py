"""A name, `.urdf` or `.toml` -> a checked card, with defaults for missing parts."""

from dqpaint.robots.loading.lookup import CARD_FOLDERS, card_for, find_card, plugin_cards, with_tool

__all__ = ["CARD_FOLDERS", "card_for", "find_card", "plugin_cards", "with_tool"]
