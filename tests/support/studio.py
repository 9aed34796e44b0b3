"""A studio of a process of its own, and pages of a real browser that are open on it."""

import subprocess
import sys
from contextlib import contextmanager

from tests.support.browser import BROWSER

QUIET = ["--no-sandbox", "--disable-gpu", "--use-gl=swiftshader", "--enable-unsafe-swiftshader",
         "--disable-background-networking", "--disable-component-update", "--disable-sync",
]  # fmt: skip
LONGEST = 90_000  # [ms] a loaded machine may take for anything


@contextmanager
def studio(folder, *words):
    """The address of a studio that serves a folder, and its process."""
    command = [sys.executable, "-m", "dqpaint", "studio", *words, "--port", "0", "--no-open"]
    process = subprocess.Popen(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        yield process.stdout.readline().strip(), process
    finally:
        process.terminate()
        process.wait(30)
        process.stdout.close()
        process.stderr.close()


@contextmanager
def browser():
    """A browser."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as play:
        made = play.chromium.launch(executable_path=BROWSER, args=QUIET)
        yield made
        made.close()


def open_page(browser, address, width=1280, height=800):
    """A page, its picture there, and the list of errors that it will say on its console."""
    page = browser.new_page(viewport={"width": width, "height": height})
    page.set_default_timeout(LONGEST)
    errors = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(address)
    page.wait_for_selector(".picture img[src^=data]")
    return page, errors


def type_at_end(page, text):
    """Type at the end of the drawing."""
    page.locator(".cm-content").click()
    page.keyboard.press("Control+End")
    page.keyboard.type(text)


def text_of(page):
    """The text of the editor."""
    return page.evaluate(
        "() => [...document.querySelectorAll('.cm-line')].map(e => e.textContent).join('\\n')"
    )


def image(page):
    """The picture that is shown."""
    return page.get_attribute(".picture img", "src")


def slider(page, name):
    """What takes the keys of a slider."""
    return page.locator(f'[role=slider][aria-label="{name}"] [tabindex="0"]')
