"""A docstring -> its sections, with equations as Unicode or LaTeX."""

from dqpaint.core.texts.explanations import Sections, read_sections
from dqpaint.core.texts.mathematics import latex_equation, unicode_equation, unicode_prose

__all__ = ["Sections", "latex_equation", "read_sections", "unicode_equation", "unicode_prose"]
