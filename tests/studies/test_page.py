"""A study's page: whole in itself, safe, and what a real browser makes of it."""

import json
import re
from html import unescape

import numpy as np
import pytest

from dqpaint.light.images import contact_sheet
from dqpaint.settings.model import make_settings
from dqpaint.studies.report.charts import HeatMap, Line, Panel
from dqpaint.studies.report.page import Charts, Map, Page, Rows, Shot, Tables, Words, html
from tests.support.browser import needs_browser, opened, printed, screenshot, with_script

T = np.linspace(0, 10, 4000)
LINES = [
    Line(T, 1 + np.sin(T), "a sine"),
    Line(T, np.where(np.arange(4000) == 2222, 50.0, 2.0), "a peak", "#123456"),
]
MARKED = np.array([False, False, True])
DOTS = Line(np.array([1.0, 10.0, 100.0]), np.array([1.0, 2.0, np.nan]), "dots", None, MARKED,
            np.array([0.1, np.nan, 0.2]), width=0.0)  # fmt: skip
JOINED = Line(np.array([1.0, 10.0, 100.0]), np.array([3.0, 2.5, 9.0]), "joined", marks=MARKED)
PANELS = (
    Panel("over time", "time [s]", "mm", LINES, bound=1.5),
    Panel("over k", "k", "mm", [DOTS, JOINED], log_x=True, log_y=True, wall=20.0),
    Panel("over laws", "law", "mm", [Line(np.arange(2.0), np.ones(2), "one")], ticks=("p", "pff")),
)
MAP = HeatMap("a map", "k", "q", ("1", "2"), ("3", "4"), np.array([[1.0, 2.0], [np.nan, 40.0]]),
              np.array([[False, True], [False, False]]), True)  # fmt: skip
SMALL = [
    Panel(f"{place}: error", "time [s]", "mm", [Line(T, factor * (2 + np.sin(T)), name)
          for name, factor in (("slow", 10.0), ("fast", scale))], log_y=True, span=(0.1, 50.0))
    for place, scale in (("here", 1.0), ("there", 0.5))
]  # fmt: skip
TABLES = [Rows("error", [["error", "paper", "here"], ["a", "3 ± 0.5", "0.1"], ["b", "1.5", "-"],
          ["c", "2", "40"]], (1, 2), "2 of 3 pairs."),
          Rows("w", [["pose", "here"], ["first", "1"]])]  # fmt: skip
PNG = contact_sheet.encode_png(np.full((30, 1200, 3), 90, dtype=np.uint8))
HOSTILE = """</script <b>$x_$</script><script>document.title="owned"</script>
<img src=x onerror="document.title=1">
'"&amp;--><!--</pre></table></noscript>$x_$ $]]> \u2028 ümläut"""


def page(**choices):
    blocks = [Words("Some words."), Rows("Rows", [["law", "error", "status"], ["p", "1", "done"],
              ["q", "2", "astray"], ["wide"] * 3], note="What it means."), Shot("A picture", PNG),
              Charts("Curves", PANELS), Map("Map", MAP), Charts("Alike", SMALL, shared=True),
              Tables("Numbers", TABLES)]  # fmt: skip
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
    assert '<p class="note">What it means.</p>' in text
    assert text.count("<noscript><img") == 3  # each chart and map, where no script runs
    assert "<h3>w</h3>" in text  # a small table whose headings do not say what it is of
    assert "<h3>error</h3>" not in text


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


TOOLS = """
  const said = {};
  const plots = [...document.querySelectorAll("svg.plot")];
  const send = (plot, kind, part, more) => {
    const box = plot.getBoundingClientRect();
    plot.dispatchEvent(new PointerEvent(kind, {bubbles: true, clientX: box.left + part * box.width,
      clientY: box.top + box.height / 2, ...more}));
  };
  const press = (plot, ...keys) => keys.forEach((key) =>
    plot.dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true, cancelable: true})));
  const tipOf = (plot) => plot.parentElement.querySelector(".tip");
  const tip = (plot) => tipOf(plot).hidden ? "" : tipOf(plot).innerText.replaceAll("\\n", " ");
  const ticks = (plot) => [...plot.querySelectorAll(".tick")].map((t) => t.textContent).join(" ");
  const lines = (plot) => plot.querySelectorAll("path.line").length;
  const legend = (plot, name) => [...(plot.closest(".charts").querySelectorAll(".legend button"))]
    .find((button) => button.textContent === name);
"""
TELL = "document.body.dataset.said = JSON.stringify(said);"


def answers(file, script, width=1400):
    """What a script says of the page once it has acted on it; nothing may be on the console."""
    made, console = opened(with_script(file, TOOLS + script + TELL), width)
    assert console == []
    return json.loads(unescape(re.search(r'data-said="([^"]*)"', made)[1]))


POINT = """
  said.plots = plots.length; said.lines = lines(plots[0]);
  send(plots[0], "pointermove", 0.5);
  said.tip = tip(plots[0]);
  const before = ticks(plots[0]);
  send(plots[0], "pointerdown", 0.4); send(plots[0], "pointermove", 0.5);
  send(plots[0], "pointerup", 0.6);
  said.zoomed = before !== ticks(plots[0]);
  document.querySelector(".whole").click();
  said.whole = before === ticks(plots[0]);
  legend(plots[0], "a sine").click();
  said.hidden = lines(plots[0]);
  legend(plots[0], "a peak").dispatchEvent(new Event("focus"));
  said.quiet = plots[0].querySelectorAll(".quiet").length;
  legend(plots[0], "a sine").dispatchEvent(new Event("dblclick"));
  said.alone = plots[0].querySelector("[data-line]").dataset.line;
  legend(plots[0], "a sine").dispatchEvent(new Event("dblclick"));
  said.all = lines(plots[0]);
  legend(plots[0], "a sine").click(); legend(plots[0], "a sine").click();
  said.twice = lines(plots[0]);
  said.joined = plots[1].querySelector("path.line:not([stroke-width='1'])").getAttribute("d");
  said.marks = [".mark", ".bound"].map((kind) => plots[1].querySelectorAll(kind).length);
  said.cells = plots[3].querySelectorAll(".cell.marked").length;
  said.fits = document.documentElement.scrollWidth <= innerWidth;
"""


@needs_browser
@pytest.mark.slow
@pytest.mark.parametrize("width", [1400, 500])
def test_the_curves_answer_to_the_pointer(file, width):
    said = answers(file, POINT, width)
    assert (said["plots"], said["lines"]) == (6, 2)
    when = float(re.match(r"time \[s\] (\S+)", said["tip"])[1])
    assert 4 < when < 6
    shown = dict(re.findall(r"(a sine|a peak): (\S+)", said["tip"]))
    assert float(shown["a sine"]) == pytest.approx(1 + np.sin(when), abs=2e-3)
    assert said["tip"].index("a peak") < said["tip"].index("a sine")  # as they lie
    assert said["zoomed"]
    assert said["whole"]
    assert (said["hidden"], said["quiet"], said["all"]) == (1, 0, 2)
    assert said["alone"] == "a sine"
    assert said["twice"] == 2
    assert said["joined"].count("L") == 1  # two points that are stable
    # no mark where there is no number; a wall; an unstable cell
    assert said["marks"] == [1, 1]
    assert said["cells"] == 1
    assert said["fits"]


KEYS = """
  press(plots[0], "ArrowRight");
  said.first = tip(plots[0]);
  press(plots[0], "ArrowRight", "ArrowRight", "ArrowLeft", "ArrowLeft");
  said.back = tip(plots[0]) === said.first;
  press(plots[0], "PageUp", "ArrowRight", "ArrowLeft");
  said.later = tip(plots[0]);
  said.spoken = plots[0].getAttribute("aria-valuetext");
  press(plots[0], "+", "+");
  const near = ticks(plots[0]);
  said.kept = tip(plots[0]) === said.later;
  press(plots[0], "End");
  said.end = tip(plots[0]);
  press(plots[0], "Escape");
  said.gone = [tip(plots[0]), near !== ticks(plots[0])];
  press(plots[0], "End", "ArrowRight");
  said.last = tip(plots[0]);
  press(plots[1], "Home", "ArrowRight");
  said.dots = tip(plots[1]);
  press(plots[3], "ArrowUp", "ArrowUp", "ArrowRight", "ArrowUp");
  said.map = tip(plots[3]);
"""


@needs_browser
@pytest.mark.slow
def test_the_curves_answer_to_keys(file):
    said = answers(file, KEYS)
    assert said["first"].startswith("time [s] 0 ")
    assert said["back"]
    when = float(re.match(r"time \[s\] (\S+)", said["later"])[1])
    assert 0.5 < when < 3  # ten hundredths of what is drawn
    assert said["spoken"].startswith(f"time [s] {when:g}; ")
    assert said["kept"]
    end = float(re.match(r"time \[s\] (\S+)", said["end"])[1])
    assert when < end < 10  # of what is zoomed
    assert said["gone"] == ["", True]
    assert said["last"].startswith("time [s] 10 ")
    assert said["dots"] == "k 10 joined: 2.5 dots: 2"
    assert said["map"] == "k 2, q 4 40"


TOUCH = """
  const finger = (id) => ({pointerType: "touch", pointerId: id});
  const whole = ticks(plots[0]);
  send(plots[0], "pointerdown", 0.3, finger(1));
  said.down = tip(plots[0]);
  send(plots[0], "pointermove", 0.6, finger(1));
  said.along = tip(plots[0]);
  send(plots[0], "pointerup", 0.6, finger(1)); send(plots[0], "pointerleave", 0.6, finger(1));
  said.stays = tip(plots[0]) === said.along && ticks(plots[0]) === whole;
  send(plots[0], "pointermove", 0.4); said.below = tip(plots[0]);
  send(plots[0], "pointerdown", 0.4, finger(1)); send(plots[0], "pointerdown", 0.6, finger(2));
  send(plots[0], "pointermove", 0.3, finger(1)); send(plots[0], "pointermove", 0.7, finger(2));
  send(plots[0], "pointerup", 0.3, finger(1)); send(plots[0], "pointerup", 0.7, finger(2));
  send(plots[0], "pointermove", 0.3); said.still = tip(plots[0]);
  said.spread = ["min", "max"].map((end) => Number(plots[0].getAttribute(`aria-value${end}`)));
"""


@needs_browser
@pytest.mark.slow
def test_the_curves_answer_to_fingers(file):
    said = answers(file, TOUCH)
    down, along, below, still = (
        float(re.match(r"time \[s\] (\S+)", said[k])[1])
        for k in ("down", "along", "below", "still")
    )
    assert still == pytest.approx(below, abs=0.05)  # what lay below a finger lies there still
    assert 1 < down < 4 < along < 7
    assert said["stays"]
    low, high = said["spread"]
    assert high - low == pytest.approx(10.4 / 2, rel=0.02)  # twice as far apart, half as much


SHARED = """
  const [here, there] = plots.slice(4);
  said.legends = here.closest(".charts").querySelectorAll(".legend").length;
  said.scale = [ticks(here) === ticks(there)];
  send(here, "pointermove", 0.5);
  said.tips = [tip(here), tip(there)];
  legend(here, "slow").click();
  said.lines = [lines(here), lines(there)];
  send(here, "pointerdown", 0.4); send(here, "pointerup", 0.6);
  said.zoomed = ["min", "max"].map((end) =>
    [here, there].map((plot) => plot.getAttribute(`aria-value${end}`)));
  said.apart = lines(plots[0]);
  send(plots[1], "pointermove", 0.5);
"""


@needs_browser
@pytest.mark.slow
def test_charts_that_are_shared_are_read_together(file):
    said = answers(file, SHARED)
    assert said["legends"] == 1
    assert said["scale"] == [True]
    own, other = said["tips"]
    assert own.startswith("time [s] ")
    assert not other.startswith("time")
    (fast,), (slower,) = (re.findall(r"fast: (\S+)", text) for text in (own, other))
    assert float(fast) == pytest.approx(2 * float(slower), rel=1e-3)
    assert said["lines"] == [1, 1]
    assert all(one == two for one, two in said["zoomed"])
    assert said["apart"] == 2


PRINT = """
  const wide = () => plots[4].viewBox.baseVal.width;
  said.wide = [wide()];
  dispatchEvent(new Event("beforeprint")); said.wide.push(wide());
  dispatchEvent(new Event("afterprint")); said.wide.push(wide());
"""


@needs_browser
@pytest.mark.slow
def test_charts_are_drawn_for_paper_while_it_is_printed(file):
    wide, paper, again = answers(file, PRINT)["wide"]
    assert paper == 430  # two beside each other
    assert wide == again > 600


SORTED = """
  const table = document.querySelector(".small table");
  const names = () => [...table.tBodies[0].rows].map((row) => row.cells[0].textContent).join("");
  const head = (i) => table.tHead.rows[0].cells[i].querySelector("button");
  said.orders = [names()];
  for (const i of [1, 1, 1, 2, 2]) { head(i).click(); said.orders.push(names()); }
  said.told = table.tHead.rows[0].cells[2].ariaSort;
  said.plain = document.querySelectorAll("table.settings button").length;
"""


@needs_browser
@pytest.mark.slow
def test_a_heading_sorts_its_table(file):
    said = answers(file, SORTED)
    assert said["orders"] == ["abc", "bca", "acb", "abc", "acb", "cab"]  # what is no number is last
    assert said["told"] == "descending"
    assert said["plain"] == 0


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
