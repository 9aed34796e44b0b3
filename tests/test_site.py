"""The site: it is built without a warning, every page is on it, and it asks no other host."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
pytestmark = pytest.mark.slow
OTHERS = re.compile(r"""<(?:script|link|img|iframe)[^>]+(?:src|href)=["'](https?:)?//""")


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    pytest.importorskip("sphinx")
    pytest.importorskip("myst_parser")
    pytest.importorskip("furo")
    made = tmp_path_factory.mktemp("site")
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html",
         "-d", str(made / "kept"), str(ROOT / "docs"), str(made / "html")],
        capture_output=True, text=True, timeout=600, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return made / "html"


def test_every_page_is_there(site):
    pages = {path.stem for path in (ROOT / "docs").glob("*.md")}

    assert pages <= {path.stem for path in site.glob("*.html")}


def test_nothing_is_loaded_from_elsewhere(site):
    for path in site.glob("*.html"):
        assert not OTHERS.search(path.read_text("utf-8")), path.name


def test_equations_are_read_without_a_script(site):
    page = (site / "equations.html").read_text("utf-8")

    assert page.count("<math") > 50
    assert "begin{" not in re.sub(r"<pre>.*?</pre>", "", page, flags=re.DOTALL)
