"""LaTeX of equations -> whether a reader of formulas takes it."""

import re

from matplotlib.mathtext import MathTextParser


def is_latex(text):
    """Whether matplotlib's reader takes it, which knows no matrices and no text in formulas."""
    text = text.replace(r"\begin{bmatrix}", "[").replace(r"\end{bmatrix}", "]").replace(r"\\", ";")
    text = re.sub(r"\\[lr]([vV]ert)", r"\\\1", text)
    text = re.sub(r"\\text\{((?:[^{}]|\\_)*)\}", r"\\mathrm{w}", text)
    MathTextParser("path").parse(f"${text.replace(chr(92) + 'tfrac', chr(92) + 'frac')}$")
    return True
