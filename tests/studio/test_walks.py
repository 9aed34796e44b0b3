"""Walks through the studio in a real browser, as a user would go."""

import json
import re

import pytest

from dqpaint.core import find_drawing
from tests.support.browser import needs_browser
from tests.support.studio import browser, image, open_page, slider, studio, text_of, type_at_end

pytestmark = [pytest.mark.slow, needs_browser]
pytest.importorskip("nicegui")
pytest.importorskip("playwright")

SHORT = """speed 200 mm/s
let r = 40 mm
move to (r, 0, 0)
line to (0, r, 0) light red
line to (-r, 0, 0) light lime
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    root = tmp_path_factory.mktemp("drawings")
    (root / "a.traj").write_text(SHORT)
    (root / "b.traj").write_text(find_drawing("star").read_text())
    return root


@pytest.fixture(scope="module")
def address(folder):
    with studio(folder, "a.traj") as (found, _):
        yield found


@pytest.fixture(scope="module")
def chromium():
    with browser() as found:
        yield found


@pytest.fixture
def page(chromium, address, folder):
    (folder / "a.traj").write_text(SHORT)
    found, errors = open_page(chromium, address)
    yield found
    found.close()
    assert errors == []


def wait_run(page):
    page.wait_for_function("() => /computed in/.test(document.querySelector('.about').textContent)")


def tab(page, name):
    page.get_by_role("tab", name=name).click()


def test_an_error_is_underlined_and_mended_by_its_fix(page):
    good = image(page)
    type_at_end(page, "linne to (0, 0, 0) mm")
    page.wait_for_selector(".f-error")
    page.wait_for_selector(".picture.old")

    assert image(page) != ""
    assert page.locator(".lamp").inner_text() != "live"
    page.locator(".fix").first.click()
    page.wait_for_selector(".picture:not(.old)")
    page.wait_for_function("old => document.querySelector('.picture img').src !== old", arg=good)

    assert text_of(page).endswith("line to (0, 0, 0) mm")
    assert page.locator(".lamp").inner_text() == "live"


def test_fast_typing_loses_no_letter(page):
    line = "# " + "the quick brown fox jumps over the lazy dog, 0123456789; " * 3
    type_at_end(page, line)
    page.wait_for_timeout(1500)

    assert text_of(page).endswith(line)


def test_a_knob_changes_the_number_and_the_picture(page):
    before = image(page)
    slider(page, "r").focus()
    for _ in range(5):
        page.keyboard.press("ArrowRight")
    page.wait_for_function("() => /let r = 45 mm/.test(document.body.innerText)")
    page.wait_for_function("old => document.querySelector('.picture img').src !== old", arg=before)


def test_a_number_is_dragged(page):
    number = page.locator(".t-number", has_text="200").first
    box = number.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.keyboard.down("Alt")
    page.mouse.move(x, y)
    page.mouse.down()
    for i in range(1, 9):
        page.mouse.move(x + 5 * i, y)
        page.wait_for_timeout(200)
    page.mouse.up()
    page.keyboard.up("Alt")
    page.wait_for_function("() => !/speed 200 mm/.test(document.body.innerText)")

    assert int(re.match(r"speed (\d+) mm/s", text_of(page))[1]) > 200


def test_undo_takes_it_back(page):
    type_at_end(page, "# more")
    page.wait_for_function("() => /# more/.test(document.body.innerText)")
    page.get_by_role("button").filter(has_text="undo").click()
    page.wait_for_function("() => !/# more/.test(document.querySelector('.cm-content').innerText)")


def test_run_scrub_and_click(page):
    wait_run(page)
    page.wait_for_timeout(1500)
    whole = image(page)
    slider(page, "time").focus()
    for _ in range(6):
        page.keyboard.press("ArrowLeft")
    page.wait_for_selector(".l-now")
    page.wait_for_function("old => document.querySelector('.picture img').src !== old", arg=whole)
    assert page.locator(".picture circle").count() == 1

    page.locator(".cm-line", has_text="light red").click()
    page.wait_for_function(
        "() => /light red/.test(document.querySelector('.l-now')?.textContent || '')"
    )
    assert page.locator(".picture polyline").count() == 1


def test_play_goes_to_the_end(page):
    wait_run(page)
    page.get_by_role("button", name="play").click()
    page.wait_for_function("() => document.querySelector('.l-now') !== null")
    page.wait_for_function("() => document.querySelector('.l-now') === null")


def test_figures_curves_and_their_csv(page):
    wait_run(page)
    tab(page, "Figures")
    page.get_by_text("position rms").first.wait_for()
    tab(page, "Curves")
    page.locator(".curves svg").wait_for()
    page.get_by_role("button").filter(has_text="download").click()
    with page.expect_download() as download:
        page.get_by_text("CSV").click()
    lines = download.value.path().read_text().splitlines()

    assert lines[0].startswith("run,t_s,position error")
    assert len(lines) > 50


def test_the_command_line_follows_the_choices(page):
    tab(page, "Choices")
    field = page.get_by_label("controller")
    field.click()
    page.keyboard.type("p")
    page.get_by_role("option", name="p", exact=True).first.click()
    page.wait_for_function("() => /--controller p/.test(document.body.innerText)")
    slider(page, "gain k").focus()
    page.keyboard.press("ArrowRight")
    page.wait_for_function("() => /--gain k=/.test(document.body.innerText)")


def test_p_and_hinf_are_compared(page):
    wait_run(page)
    tab(page, "Compare")
    page.get_by_text("keep this run").click()
    test_the_command_line_follows_the_choices(page)
    page.wait_for_function(
        "() => /^p on .*computed/.test(document.querySelector('.about').textContent)"
    )
    tab(page, "Compare")
    page.get_by_label("left").click()
    page.get_by_role("option").filter(has_text="hinf").first.click()
    page.wait_for_function("() => /times as large/.test(document.body.innerText)")
    page.get_by_text("is it more than noise?").click()
    page.wait_for_function("() => /5 pairs/.test(document.querySelector('.verdict').textContent)")


def test_completion_and_hover(page):
    type_at_end(page, "scr")
    page.keyboard.press("Control+Space")
    page.locator(".completion-card .word", has_text="screw").wait_for()
    page.wait_for_function("() => document.activeElement.classList.contains('q-item')")
    page.keyboard.press("Enter")
    page.wait_for_function("() => /screw/.test(document.querySelector('.cm-content').innerText)")
    page.locator(".t-statement", has_text="speed").first.hover()
    page.wait_for_function("() => /speed/.test(document.querySelector('.hover-card').innerText)")


def test_a_drawing_is_saved(page, folder):
    type_at_end(page, "# kept")
    page.wait_for_timeout(500)
    page.keyboard.press("Control+s")
    page.get_by_text("saved a.traj").wait_for()

    assert (folder / "a.traj").read_text().endswith("# kept")


def test_a_shared_drawing_opens_and_holds_text_and_choices(page, chromium, address):
    type_at_end(page, "# passed on")
    page.wait_for_timeout(500)
    page.get_by_role("button").filter(has_text="share").click()
    with page.expect_download() as download:
        page.get_by_text("a file with text").click()
    found = json.loads(download.value.path().read_text())
    from dqpaint.studio import sharing

    link = sharing.to_link(sharing.Shared("c.traj", found["text"], {"controller": "p"}))
    other, errors = open_page(chromium, f"{address.partition('&')[0]}&z={link}")
    assert text_of(other).endswith("# passed on")
    assert not errors
    tab(other, "Choices")
    other.wait_for_function("() => /--controller p/.test(document.body.innerText)")
    other.close()


def test_a_damaged_link_says_so(chromium, address):
    page = chromium.new_page()
    page.goto(f"{address.partition('&')[0]}&z=nothing")
    page.get_by_text("damaged").wait_for()
    page.close()


def test_the_run_as_a_page_of_its_own(page):
    pytest.importorskip("viser")
    wait_run(page)
    page.get_by_role("button").filter(has_text="share").click()
    with page.expect_download() as download:
        page.get_by_text("the run as one page").click()

    assert download.value.path().read_bytes().rstrip().endswith(b"</html>")


def test_pages_are_turned_for_a_lecture(chromium, folder):
    with studio(folder, ".", "--present") as (address, _):
        page, errors = open_page(chromium, address)
        assert page.locator(".fix").count() == 0
        page.get_by_role("button", name="the next drawing").click()
        page.wait_for_function("() => /five-pointed/.test(document.body.innerText)")
        assert page.locator(".cm-content").get_attribute("contenteditable") == "false"
        assert errors == []
        page.close()
