"""Equations in plain text -> Unicode and LaTeX."""

import pytest

from dqpaint.core.texts.explanations import read_sections
from dqpaint.core.texts.mathematics import latex_equation, unicode_equation, unicode_prose
from tests.support.latex import is_latex

PAIRS = [
    ("q_dot = J_w^+ u", "q̇ = J_w⁺ u", r"\dot{q} = J_{w}^{+} u"),
    ("x_d_ddot", "ẍ_d", r"\ddot{x}_{d}"),
    ("x^* x_d", "x* x_d", "x^{*} x_{d}"),
    ("R^-1 P e", "R⁻¹ P e", "R^{-1} P e"),
    ("e' Q e", "eᵀ Q e", r"e^{\top} Q e"),
    ("J_8' e", "J₈ᵀ e", r"J_{8}^{\top} e"),
    ("[a; b]", "[a; b]", r"\begin{bmatrix} a \\ b \end{bmatrix}"),
    ("[a, [b; c]]", "[a, [b; c]]", r"[a, \; \begin{bmatrix} b \\ c \end{bmatrix}]"),
    ("sqrt(gamma_O1^-2 + 2)", "√(γ_O1⁻² + 2)", r"\sqrt{\gamma_{O1}^{-2} + 2}"),
    ("||v_w||_2 <= |p|", "‖v_w‖₂ ≤ |p|", r"\lVert v_{w}\rVert_{2} \leq \lvert p\rvert"),
    ("1/2 p", "½ p", r"\tfrac{1}{2} p"),
    ("11/2 and 1/20", "11/2 and 1/20", r"11/2 \mathrm{and} 1/20"),
    ("w cross (v cross t)", "w × (v × t)", r"w \times (v \times t)"),
    ("int_0^t_f e dt", "∫₀^t_f e dt", r"\int_{0}^{t_{f}} e \mathrm{dt}"),
    ("t_(k+1) - t_k", "t_(k+1) - t_k", "t_{k+1} - t_{k}"),
    ('"so to_say" eps', "so to_say ε", r"\text{so to\_say} \varepsilon"),
    ("H_minus(x) + R^8", "H⁻(x) + R⁸", r"\overset{-}{H}(x) + R^{8}"),
    ("Ad(x) xi_d_dot", "Ad(x) ξ̇_d", r"\operatorname{Ad} (x) \dot{\xi}_{d}"),
]  # fmt: skip


@pytest.mark.parametrize(("plain", "shown", "set_"), PAIRS)
def test_one_source_two_forms(plain, shown, set_):
    assert unicode_equation(plain) == shown
    assert latex_equation(plain) == set_


def test_words_stay_words():
    text = "the paper's law: `x_e_dot` and feed_forward=1, with x_e_dot = 0, k T <= 2 and eta small"
    assert unicode_prose(text) == (
        "the paper's law: `x_e_dot` and feed_forward=1, with ẋ_e = 0, k T ≤ 2 and η small"
    )


def test_a_docstring_taken_apart():
    found = read_sections(
        """First line.

        Equation:
            a = b
            c = d
        Idea:
            One
            two.

        More of it.
        Try:
            dqpaint list plants

        Args:
            x: no section.
        """
    )
    assert found.summary == "First line."
    assert found.equations == ("a = b", "c = d")
    assert found.texts == {"idea": "One two."}
    assert found.try_ == ("dqpaint list plants",)
    assert found.missing(("equation", "idea", "fails")) == ["fails"]
    assert read_sections(None).missing(("try",)) == ["try"]


@pytest.mark.parametrize("plain", [plain for plain, _, _ in PAIRS])
def test_the_latex_is_latex(plain):
    assert is_latex(latex_equation(plain))
