r"""Equations as docstrings have them, plain text -> Unicode for terminals, LaTeX for documents.

    q_dot = J_w^+ (K e + x_e^*)        q̇ = J_w⁺ (K e + x_e*)        \dot{q} = J_{w}^{+} ...

Names are letters with subscripts behind `_`; `_dot` and `_ddot` are dots, names of Greek letters
those letters. `^+`, `^-1`, `^*` stand above, `'` transposes, `1/2` is a half, `[a; b]` a column,
`||v||_2` a norm, `sqrt(...)` a root, `<=` and `->` what they look like, `cross` a vector product,
`int_0^T` and `sum_k` an integral and a sum; words in quotes are words.
"""

import re
from collections.abc import Iterable
from typing import NamedTuple
from unicodedata import normalize

GREEK = dict(
    alpha="α", beta="β", gamma="γ", delta="δ", eps="ε", zeta="ζ", eta="η", theta="θ", kappa="κ",
    mu="μ", xi="ξ", pi="π", rho="ρ", sigma="σ", tau="τ", phi="φ", psi="ψ", omega="ω", lam="λ",
    Delta="Δ", Sigma="Σ", Phi="Φ",
)  # fmt: skip
LATEX_NAMES = {"eps": r"\varepsilon", "lam": r"\lambda"}
HAMILTON = {"H_plus": ("H⁺", r"\overset{+}{H}"), "H_minus": ("H⁻", r"\overset{-}{H}")}
FUNCTIONS = {
    "Ad", "Im", "Re", "vec", "diag", "rms", "std", "mean", "angle", "round", "clip", "tanh", "log",
    "exp", "sin", "cos", "det",
}  # fmt: skip
SIGNS = {  # plain: Unicode, LaTeX
    "<=": ("≤", r"\leq "), ">=": ("≥", r"\geq "), "->": ("→", r"\rightarrow "),
    "!=": ("≠", r"\neq "), "cross": ("×", r"\times "), "inf": ("∞", r"\infty "),
    "deg": ("°", r"^{\circ}"), "min": ("min", r"\min "), "max": ("max", r"\max "),
    "int": ("∫", r"\int"), "sum": ("Σ", r"\sum"), "1/2": ("½", r"\tfrac{1}{2}"),
    "'": ("ᵀ", r"^{\top}"),
}  # fmt: skip
ABOVE = str.maketrans("+-0123456789n", "⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹ⁿ")
BELOW = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
DOTS = {"dot": "\u0307", "ddot": "\u0308"}
TOKEN = re.compile(
    r'"(?P<words>[^"]*)"|(?P<half>(?<!\d)1/2(?!\d))|(?P<name>[A-Za-z][A-Za-z0-9]*(?:_(?:[A-Za-z0-9]+|\([^)]*\)))*)'
    r"|(?P<norm>\|\|?)(?P<order>_\w+)?|\^(?P<above>\*|\+|-?\w+)|(?P<sign><=|>=|->|!=|'(?![a-z]))"
    r"|(?P<space>\s+)|(?P<other>.)"
)


class Name(NamedTuple):
    """A name's letter, its dots (`dot`, `ddot` or none) and its subscripts."""

    letter: str
    dots: str
    below: str


def unicode_equation(text: str) -> str:
    """An equation, or prose with parts of some, in Unicode."""
    return normalize("NFC", TOKEN.sub(_unicode, text))


def unicode_prose(text: str) -> str:
    """Sentences whose words are those of equations here and there; `code` stays as it is."""
    return re.sub(r"(`[^`]*`)|(\S+)", lambda m: m[1] or _unicode_word(m[2]), text)


def latex_equation(text: str) -> str:
    """An equation in LaTeX, without dollars."""
    tokens = list(TOKEN.finditer(text))
    return re.sub(r" +", " ", _latex(tokens, "")).strip()


def latex_block(equations: Iterable[str]) -> str:
    """Equations one below the other, as a block of Markdown."""
    lines = " \\\\\n".join(map(latex_equation, equations))
    return f"```math\n\\begin{{gather*}}\n{lines}\n\\end{{gather*}}\n```"


def _read_name(text: str) -> Name:
    letter, *below = text.split("_")
    dots = next((part for part in below if part in DOTS), "")
    return Name(letter, dots, "_".join(part for part in below if part not in DOTS))


def _unicode(token: re.Match[str]) -> str:
    if token["words"] is not None:
        return token["words"]
    if token["half"]:
        return SIGNS["1/2"][0]
    if token["sign"]:
        return SIGNS[token["sign"]][0]
    if token["above"]:
        above = token["above"]
        plain = above == "*" or above.translate(ABOVE) == above
        return ("" if above == "*" else "^") + above if plain else above.translate(ABOVE)
    if token["norm"]:
        return token["norm"].replace("||", "‖") + (token["order"] or "").translate(BELOW).replace(
            "_", ""
        )
    if token["name"] in HAMILTON:
        return HAMILTON[token["name"]][0]
    if token["name"]:
        return _unicode_name(_read_name(token["name"]))
    return token[0]


def _unicode_name(name: Name) -> str:
    letter = GREEK.get(name.letter) or SIGNS.get(name.letter, (name.letter, ""))[0]
    if name.letter == "sqrt":
        return "√"
    below = name.below.translate(BELOW) if name.below.isdigit() else f"_{name.below}"
    return letter + (DOTS[name.dots] if name.dots else "") + (below if name.below else "")


def _unicode_word(word: str) -> str:
    core = word.strip(".,;:()")
    if core in GREEK or re.search(
        r"_(dot|ddot)\b|\^|<=|>=|\|\||(?<!\d)1/2(?!\d)|\w_\w|\bsqrt\(", core
    ):
        return unicode_equation(word) if "--" not in word else word
    return word


def _latex(tokens: list[re.Match[str]], end: str) -> str:
    """The LaTeX of tokens up to a closing bracket, which is taken, too: of `[...]` as a whole."""
    parts: list[str] = []
    rows = False
    opened = {"|": False, "||": False}
    while tokens:
        token = tokens.pop(0)
        if token["other"] == end:
            break
        if token["name"] == "sqrt" and tokens and tokens[0]["other"] == "(":
            tokens.pop(0)
            parts.append(rf"\sqrt{{{_latex(tokens, ')')}}}")
        elif token["other"] == "[":
            parts.append(_latex(tokens, "]"))
        elif token["other"] == "(":
            parts.append(f"({_latex(tokens, ')')})")
        elif token["norm"]:
            bar = token["norm"]
            side = "r" if opened[bar] else "l"
            opened[bar] = not opened[bar]
            order = f"_{{{token['order'][1:]}}}" if token["order"] else " "
            parts.append(rf"\{side}{'Vert' if bar == '||' else 'vert'}{order}")
        else:
            rows = rows or token[0] == ";"
            parts.append(_latex_token(token))
    inside = "".join(parts)
    if end != "]":
        return inside
    return rf"\begin{{bmatrix}} {inside} \end{{bmatrix}}" if rows else f"[{inside}]"


def _latex_token(token: re.Match[str]) -> str:
    if token["words"] is not None:
        return rf"\text{{{token['words'].replace('_', chr(92) + '_')}}}"
    if token["half"]:
        return SIGNS["1/2"][1]
    if token["sign"]:
        return SIGNS[token["sign"]][1]
    if token["above"]:
        return f"^{{{_latex_above(token['above'])}}}"
    if token["name"] in HAMILTON:
        return HAMILTON[token["name"]][1]
    if token["name"]:
        return _latex_name(_read_name(token["name"]))
    return {";": r" \\ ", ",": r", \; ", "~": r"\sim "}.get(token[0], token[0])


def _latex_above(above: str) -> str:
    return _latex_name(_read_name(above)) if above[0].isalpha() else above


def _latex_name(name: Name) -> str:
    letter = name.letter
    if letter in GREEK:
        letter = LATEX_NAMES.get(letter, rf"\{letter}")
    elif letter in SIGNS:
        letter = SIGNS[letter][1]
    elif letter in FUNCTIONS:
        letter = rf"\operatorname{{{letter}}}"
    elif len(letter) > 1:
        letter = rf"\mathrm{{{letter}}}"
    if name.dots:
        letter = rf"\{name.dots}{{{letter}}}"
    below = name.below.replace("_", ",").strip("()")
    return f"{letter}_{{{below}}}" if below else letter + (" " if letter.startswith("\\") else "")
