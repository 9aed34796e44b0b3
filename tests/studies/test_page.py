"""A study's page: whole in itself, safe, and what a real browser makes of it."""

import re
from html import unescape

import numpy as np
import pytest

from dqpaint.charts import HeatMap, Line, Panel
from dqpaint.light import contact
from dqpaint.settings import make_settings
from dqpaint.studies.page import MOST_POINTS, Charts, Map, Page, Rows, Shot, Words, _thinned, html
from tests.studies.browser import needs_browser, opened, printed, screenshot, with_script

T = np.linspace(0, 10, 4000)
LINES = [
    Line(T, 1 + np.sin(T), "a sine"),
    Line(T, np.where(np.arange(4000) == 2222, 50.0, 2.0), "a peak", "#123456"),
]
MARKED = np.array([False, False, True])
DOTS = Line(np.array([1.0, 10.0, 100.0]), np.array([1.0, 2.0, np.nan]), "dots", None, MARKED,
            np.array([0.1, np.nan, 0.2]), width=0.0)  # fmt: skip
PANELS = (
    Panel("over time", "time [s]", "mm", LINES, bound=1.5),
    Panel("over k", "k", "mm", [DOTS], log_x=True, log_y=True, wall=20.0),
    Panel("over laws", "law", "mm", [Line(np.arange(2.0), np.ones(2), "one")], ticks=("p", "pff")),
)
MAP = HeatMap("a map", "k", "q", ("1", "2"), ("3", "4"), np.array([[1.0, 2.0], [np.nan, 40.0]]),
              np.array([[False, True], [False, False]]), True)  # fmt: skip
PNG = contact.png(np.full((30, 1200, 3), 90, dtype=np.uint8))
HOSTILE = """</script <b>$x_$</script><script>document.title="owned"</script>
<img src=x onerror="document.title=1">
'"&amp;--><!--</pre></table></noscript>$x_$ $]]> \u2028 ümläut"""


def page(**choices):
    blocks = [Words("Some words."), Rows("Rows", [["law", "error", "status"], ["p", "1", "done"],
              ["q", "2", "unstable"], ["wide"] * 3]), Shot("A picture", PNG),
              Charts("Curves", PANELS), Map("Map", MAP)]  # fmt: skip
    usual = {"settings": make_settings(controller="p", gains={"k": 5.0}), "text": "hold 1 s\n",
             "again": "dqpaint sweep a.traj --vary 'k=1,2'"}  # fmt: skip
    return Page("a.traj, shown", blocks, **{**usual, **choices})


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "page.html"
    path.write_bytes(html(page()))
    return path


@pytest.mark.slow
def test_a_page_holds_all_it_needs_and_is_the_same_each_time():
    text = html(page()).decode()
    assert html(page()).decode() == text
    addresses = set(re.findall(r"https?://[^\s\"']+", text))
    assert addresses == {"http://www.w3.org/2000/svg"}  # a name, which nobody fetches
    assert not re.search(r"\b(src|href)=\"(?!data:)", text)
    assert "default-src 'none'" in text
    assert "<td>controller</td><td>p</td>" in text
    assert "<td>gains</td><td>k=5.0</td>" in text
    assert unescape(re.search(r"run it again</h2>\n<pre>(.*)</pre>", text)[1]) == page().again
    assert '<tr class="bad"><td>q</td>' in text


def test_lines_are_thinned_and_keep_their_peaks():
    thin = _thinned(LINES[1])
    assert len(thin.x) <= MOST_POINTS + 2
    assert thin.y.max() == 50.0
    assert thin.x[0] == T[0]
    assert thin.x[-1] == T[-1]
    assert np.all(np.diff(thin.x) > 0)
    assert _thinned(DOTS) is DOTS


def hostile():
    label = HOSTILE
    line = Line(np.arange(2.0), np.ones(2), label)
    panel = Panel(label, label, label, [line], ticks=(label, "b"))
    given = HeatMap(label, label, label, (label,), (label,), np.ones((1, 1)), ~MARKED[:1, None])
    blocks = [Words(label), Rows(label, [[label], [label]]), Shot(label, PNG),
              Charts(label, (panel,)), Map(label, given)]  # fmt: skip
    settings = make_settings(
        controller=label, gains={label: label}, disturb={label: {label: label}}
    )
    return Page(label, blocks, settings, label, label)


@needs_browser
@pytest.mark.slow
def test_what_a_user_wrote_is_text_and_nothing_else(tmp_path):
    path = tmp_path / "page.html"
    path.write_bytes(html(hostile()))
    assert path.read_text("utf-8").count("<script>") == 1  # ours; data are of another type
    checks = """
      const bad = document.querySelectorAll("img:not([src^='data:']), script:not([type]) ~ p");
      document.body.dataset.said = JSON.stringify([document.title === "owned", bad.length,
        document.querySelectorAll("h1 *").length, document.querySelectorAll("svg.plot").length,
        document.querySelector("h1").textContent.includes("</pre></table>"),
        document.querySelectorAll("svg.plot text")[0].textContent.includes("<img")]);"""
    made, console = opened(with_script(path, checks))
    assert 'data-said="[false,0,0,2,true,true]"' in made
    assert console == []


@needs_browser
@pytest.mark.slow
def test_no_code_but_its_own_runs(file):
    made, console = opened(with_script(file, "document.title = 'owned'", keep_policy=True))
    assert "<title>a.traj, shown</title>" in made
    assert any("Content Security Policy" in line for line in console)


INTERACT = """
  const said = [];
  const plots = [...document.querySelectorAll("svg.plot")];
  const send = (plot, kind, part) => {
    const box = plot.getBoundingClientRect();
    plot.dispatchEvent(new PointerEvent(kind, {bubbles: true, clientX: box.left + part * box.width,
      clientY: box.top + box.height / 2}));
  };
  const tip = () => document.querySelector(".tip").innerText.replaceAll("\\n", " ");
  const ticks = () => [...plots[0].querySelectorAll(".tick")].map((t) => t.textContent).join(" ");
  said.push(plots.length, plots[0].querySelectorAll("path.line").length);
  send(plots[0], "pointermove", 0.5);
  said.push(tip());
  const before = ticks();
  send(plots[0], "pointerdown", 0.4); send(plots[0], "pointerup", 0.6);
  said.push(before !== ticks());
  document.querySelector(".whole").click();
  said.push(before === ticks());
  document.querySelector(".legend button").click();
  said.push(plots[0].querySelectorAll("path.line").length);
  const marks = [".mark", ".bound"].map((kind) => plots[1].querySelectorAll(kind).length);
  said.push(...marks);
  said.push(plots[3].querySelectorAll(".cell.marked").length);
  said.push(document.documentElement.scrollWidth <= innerWidth);
  document.body.dataset.said = JSON.stringify(said);
"""


@needs_browser
@pytest.mark.slow
@pytest.mark.parametrize("width", [1400, 500])
def test_the_curves_answer_to_the_pointer(file, width):
    made, console = opened(with_script(file, INTERACT), width)
    assert console == []
    said = unescape(re.search(r'data-said="([^"]*)"', made)[1])
    assert '[4,2,"time [s] 4.' in said or '[4,2,"time [s] 5.' in said
    assert "a sine: 0." in said
    assert "a peak: 2" in said
    # zoomed and back, a line hidden, no mark where there is no number, a wall, an unstable cell
    assert said.endswith(",true,true,1,0,1,1,true]")


@needs_browser
@pytest.mark.slow
def test_it_is_seen_on_a_narrow_screen_and_on_paper(file, tmp_path):
    """What is drawn there is looked at by people; here: it fits, and it is not blank."""
    import cv2

    shot = tmp_path / "narrow.png"
    screenshot(file, shot, 390, 2400)
    image = cv2.imread(str(shot))
    assert image.shape[:2] == (2400, 390)
    dark = (image.min(axis=2) < 160).any(axis=1)
    assert dark[:2000].mean() > 0.3
    assert (image[:, -3:] > 230).mean() > 0.9  # nothing runs over the edge
    paper = tmp_path / "paper.pdf"
    printed(file, paper)
    assert paper.read_bytes().startswith(b"%PDF")
    assert paper.read_bytes().count(b"/Type /Page\n") >= 1
