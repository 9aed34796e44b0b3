"""Rows of text -> tables in LaTeX, with the rules of booktabs, for a paper to take in."""

import re
from collections.abc import Sequence

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?(?: ± \d+(?:\.\d+)?(?:e[+-]?\d+)?)?")
POWER = re.compile(r"e([+-]?)0*(\d+)")
SPECIAL = {
    "\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_",
    "{": r"\{", "}": r"\}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
    "±": r"$\pm$", "°": r"$^\circ$", "<": r"$<$", ">": r"$>$", "|": r"$|$",
}  # fmt: skip
WIDEST = 9  # columns: a table that has more is turned round, a line a column
HEAD = "% \\usepackage{booktabs} in the preamble; needs UTF-8, as LaTeX has by default\n"


def tables(several: Sequence[tuple[str, Sequence[Sequence[str]]]]) -> bytes:
    """Tables with their titles; each begins with a row of headings.

    Columns of numbers stand right, others left.
    """
    parts = [HEAD]
    for title, lines in several:
        head, *rows = zip(*lines, strict=True) if len(lines[0]) > WIDEST else lines
        kinds = [
            "r" if any(map(NUMBER.fullmatch, column)) else "l" for column in zip(*rows, strict=True)
        ]
        text = [_row(head), r"\midrule", *map(_row, rows)]
        parts.append(
            "\\begin{table}\n\\centering\n"
            f"\\caption{{{_text(title)}}}\n"
            f"\\begin{{tabular}}{{{''.join(kinds)}}}\n\\toprule\n"
            + "\n".join(text)
            + "\n\\bottomrule\n\\end{tabular}\n\\end{table}\n"
        )
    return "\n".join(parts).encode()


def _row(cells: Sequence[str]) -> str:
    return " & ".join(map(_cell, cells)) + r" \\"


def _cell(text: str) -> str:
    if not NUMBER.fullmatch(text):
        return _text(text)
    powers = POWER.sub(lambda f: rf" \cdot 10^{{{f[1].strip('+')}{f[2]}}}", text)
    return f"${powers.replace('±', chr(92) + 'pm')}$"


def _text(text: str) -> str:
    return "".join(SPECIAL.get(letter, letter) for letter in " ".join(text.split()))
