"""Tables for papers: every character that LaTeX would take for a command is written as itself."""

import shutil
import subprocess

import pytest

from dqpaint.studies.report.latex import tables

ROWS = [
    ["law", "error [mm]"],
    ["p_1 & 50 % {x} ~^\\", "1.183 ± 0.007"],
    ["q", "2.50e-07 ± 0.12e-07"],
]


def test_numbers_are_mathematics_and_words_are_words():
    made = tables([("Errors_1", ROWS)]).decode()
    assert r"$1.183 \pm 0.007$" in made
    assert r"$2.50 \cdot 10^{-7} \pm 0.12 \cdot 10^{-7}$" in made
    assert r"p\_1 \& 50 \% \{x\} \textasciitilde{}\textasciicircum{}\textbackslash{} &" in made
    assert r"\begin{tabular}{lr}" in made
    assert r"\caption{Errors\_1}" in made
    assert made.count(r"\\") == 3
    for rule in (r"\toprule", r"\midrule", r"\bottomrule"):
        assert made.count(rule) == 1


def test_a_wide_table_is_turned_round():
    wide = [[f"c{i}" for i in range(12)], *([str(i) for i in range(12)] for _ in range(2))]
    made = tables([("x", wide)]).decode()
    assert r"\begin{tabular}{lrr}" in made.replace("{rrr}", "{lrr}")
    assert made.count(r"\\") == 12


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="no LaTeX here")
def test_latex_takes_it(tmp_path):
    (tmp_path / "t.tex").write_bytes(tables([("Errors_1", ROWS)]))
    (tmp_path / "m.tex").write_text(
        r"\documentclass{article}\usepackage{booktabs}\begin{document}\input{t}\end{document}"
    )
    subprocess.run(["pdflatex", "-halt-on-error", "m"], cwd=tmp_path, check=True,
                   capture_output=True)  # fmt: skip
