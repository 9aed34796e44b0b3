"""The site: it is built without a warning, every page is on it, and it asks no other host."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from dqpaint.cli.listing import lists
from tests.support import browser

ROOT = Path(__file__).parent.parent
pytestmark = pytest.mark.slow
OTHERS = re.compile(r"""<(?:script|link|img|iframe)[^>]+(?:src|href)=["'](https?:)?//""")


def built(pages, out, words, kind="html"):
    """A build whose warnings are errors."""
    return subprocess.run(
        [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", kind, *words,
         str(pages), str(out)],
        capture_output=True, text=True, timeout=600, check=False,
    )  # fmt: skip


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    pytest.importorskip("sphinx")
    pytest.importorskip("myst_parser")
    pytest.importorskip("furo")
    made = tmp_path_factory.mktemp("site")
    done = built(ROOT / "docs", made / "html", ("-d", str(made / "kept")))
    assert done.returncode == 0, done.stderr
    return made / "html"


def test_every_page_is_there(site):
    pages = {path.stem for path in (ROOT / "docs").glob("*.md")}

    assert pages <= {path.stem for path in site.glob("*.html")}


KINDS = ("laws", "plants", "disturbances", "profiles", "metrics")
WORDS = (ROOT / "docs/words.md").read_text("utf-8")


def test_every_name_and_message_has_its_page(site):
    from dqpaint.cli import explaining
    from dqpaint.diagnostics.catalogue import explanations

    made = site / "generated"
    for kind in KINDS:
        for one in explaining.all_explained(kind.removesuffix("s")):
            page = (made / kind / f"{one.name}.html").read_text("utf-8")
            if kind in ("laws", "plants", "disturbances"):
                assert "<img" in page.partition("<h1")[2], one.name
    for code, entry in explanations().items():
        page = (made / "messages" / f"{code}.html").read_text("utf-8")
        assert (f"[{code}]" in page) == bool(entry.wrong), code
    assert 'id="control"' in (made / "commands/draw.html").read_text("utf-8")


def test_every_word_has_a_picture(site):
    from dqpaint.language.vocabulary.words import STATEMENTS

    sections = re.split(r"^### (.*)$", WORDS, flags=re.MULTILINE)[1:]
    drawings = {
        word: re.findall(r"^```\{traj\}\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
        for heading, text in zip(sections[::2], sections[1::2], strict=True)
        for word in heading.split(", ")
    }
    assert set(drawings) == set(STATEMENTS)
    for word, texts in drawings.items():
        assert any(re.search(rf"\b{word}\b", text) for text in texts), word
    page = (site / "words.html").read_text("utf-8").partition("<h1")[2]
    shown = WORDS.count("```{traj}") - WORDS.count(":wrong:") + WORDS.count("```{picture}")
    assert page.count("<img") >= shown


def test_brushes_looks_fonts_and_objectives_have_a_picture():
    names = {kind: [row["name"] for row in lists(kind)[kind]] for kind in
             ("brushes", "looks", "fonts", "null")}  # fmt: skip
    assert all(f"--look {name} " in WORDS for name in names["looks"])
    assert all(f"--null {name} " in WORDS for name in names["null"])
    assert all(f'font "{name}"' in WORDS for name in names["fonts"])
    for name in names["brushes"]:
        assert re.search(rf"--brush \W?{name}\b|preview {name} ", WORDS), name


@browser.needs_browser
def test_the_cheat_sheet_is_one_page(site, tmp_path):
    path = tmp_path / "sheet.pdf"
    browser.printed(site / "generated/cheat-sheet.html", path)
    assert len(re.findall(rb"/Type /Page\b(?!s)", path.read_bytes())) == 1


@pytest.mark.parametrize(("kind", "text", "said"), [
    ("{traj}", "line to (60, 20)", "no drawing"),
    ("{traj}\n:wrong:\n", "line to (60, 20) mm", "nothing is wrong"),
    ("{picture}", "dqpaint draw star --controler p", "--controler"),
    ("{picture}", "dqpaint explain nobody", "nobody"),
])  # fmt: skip
def test_a_lie_is_no_page(kind, text, said, tmp_path):
    """A drawing with an error, an error that is none, a renamed option end the build."""
    (tmp_path / "index.md").write_text(f"# A\n\n```{kind}\n{text}\n```\n")
    done = built(tmp_path, tmp_path / "made", ("-c", str(ROOT / "docs")))
    assert done.returncode != 0
    assert said in done.stderr


def test_man_pages(tmp_path):
    done = built(ROOT / "docs", tmp_path, (), "man")
    assert done.returncode == 0, done.stderr
    page = (tmp_path / "dqpaint-draw.1").read_text("utf-8")
    assert r"\-\-controller" in page
    assert ".SH CONTROL" in page.upper()


def test_nothing_is_loaded_from_elsewhere(site):
    for path in site.rglob("*.html"):
        assert not OTHERS.search(path.read_text("utf-8")), path.name


def test_equations_are_read_without_a_script(site):
    page = (site / "equations.html").read_text("utf-8")

    assert page.count("<math") > 50
    assert "begin{" not in re.sub(r"<pre>.*?</pre>", "", page, flags=re.DOTALL)
