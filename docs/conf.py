"""The pages of docs/ -> a site: python -m sphinx -W -b html docs build/site."""

import html
import re
import sys
import time
from pathlib import Path
from xml.etree import ElementTree as Xml

sys.path[:0] = [str(Path(__file__).parents[1]), str(Path(__file__).parent)]

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml
from extensions import directives, generated_pages, made

import dqpaint
from dqpaint.editors.pygments_lexer import TrajLexer

MATHML = "{http://www.w3.org/1998/Math/MathML}"
DOTS = ("\u02d9", "\u00a8", "\u0307", "\u0308")
Xml.register_namespace("", MATHML[1:-1])

project = "dqpaint"
author = "The dqpaint developers"
project_copyright = author
version = release = dqpaint.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
myst_enable_extensions = ["dollarmath", "deflist", "colon_fence"]
myst_heading_anchors = 3
# links into the sources, which the site does not have; and headings that begin at the second level
suppress_warnings = ["myst.xref_missing", "myst.header", "misc.highlighting_failure"]
smartquotes = False  # options begin with two hyphens
html_math_renderer = "mathml"
exclude_patterns = ["build"]
html_static_path = ["static"]
html_css_files = ["shown.css"]
html_theme = "furo"
html_title = f"dqpaint {version}"
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {"source_edit_link": ""}
man_pages = [  # python -m sphinx -b man docs build/man
    (f"generated/commands/{name}", f"dqpaint-{name}", f"dqpaint {name}", author, 1)
    for name in generated_pages.command_names()
]
autodoc_typehints = "description"
autodoc_member_order = "bysource"


def _dots_on_letters(mathml):
    """An index below a letter with a dot -> beside it, where an index belongs."""
    named = re.sub(r"&(?!lt;|gt;|amp;)\w+;", lambda found: html.unescape(found[0]), mathml)
    root = Xml.fromstring(named)
    for parent in list(root.iter()):
        for place, one in enumerate(list(parent)):
            if one.tag == f"{MATHML}munderover" and (one[2].text or "").strip() in DOTS:
                dotted = Xml.Element(f"{MATHML}mover", accent="false")
                dotted.extend([one[0], one[2]])
                made = Xml.Element(f"{MATHML}msub")
                made.extend([dotted, one[1]])
                parent[place] = made
            elif one.tag == f"{MATHML}mover":
                one.set("accent", "false")  # above the letter, not on it
    return Xml.tostring(root, encoding="unicode")


def _math(as_block):
    """A renderer of equations as MathML, which browsers read without a script from elsewhere."""

    def visit(translator, node):
        text = node.astext()
        try:
            made = tex2mathml(text, as_block=as_block)
        except Exception:
            raise ValueError(f"no equation that can be read: {text}") from None
        translator.body.append(_dots_on_letters(made))
        raise nodes.SkipNode

    return visit, None


def _equations(_app, _name, source):
    """Equations as the pages of a code host have them -> as MyST has them."""
    text = source[0].replace("$`", "$").replace("`$", "$")
    text = text.replace("```math", "```{math}")
    source[0] = text.replace("{gather*}", "{aligned}")


def _all_if_changed(app, env, docnames):
    """Read every page that shows something again after the package was changed."""
    if getattr(env, "dqpaint_hash", "") != made.package_hash():
        env.dqpaint_hash, begin = made.package_hash(), time.time()
        docnames[:] = sorted(env.found_docs)
        app.connect("build-finished", lambda _app, _failed: made.forget_others(begin))


def setup(app):
    """Register what Sphinx has not: pictures, generated pages, colours, equations as MathML."""
    app.add_lexer("traj", TrajLexer)
    app.add_directive("traj", directives.Traj)
    app.add_directive("picture", directives.Picture)
    app.connect("builder-inited", lambda _app: generated_pages.write(made.GENERATED))
    app.connect("env-before-read-docs", _all_if_changed)
    app.connect("source-read", _equations)
    app.add_html_math_renderer("mathml", _math(False), _math(True))
