"""Every error a user can meet has one base. What a drawing's text has wrong is a `ScriptError`."""


class DqpaintError(Exception):
    """A fault in an input or a result: exit code 1, one clear sentence, never a traceback."""


class UsageError(DqpaintError):
    """A fault in how a command was called: exit code 2, with the known names or values."""


class UnknownNameError(UsageError):
    """A name that no registry knows."""

    def __init__(self, kind: str, name: str, known: list[str]) -> None:
        super().__init__(f"no {kind} named '{name}'; known: {', '.join(known)}")


class OutputError(DqpaintError):
    """A place that cannot be written."""


class TimeLimitError(DqpaintError):
    """A run that takes longer than it may."""


class UnstableError(DqpaintError):
    """A run whose numbers grew beyond what numbers can hold."""
