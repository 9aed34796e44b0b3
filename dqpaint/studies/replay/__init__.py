"""A paper's numbers and our runs -> claims, each with how it was measured and whether it holds."""

__all__ = ["papers"]
