"""A real browser: what a page becomes in it, and how it looks."""

import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
QUIET = ("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--hide-scrollbars", "--enable-logging=stderr", "--virtual-time-budget=2000")  # fmt: skip
BROWSER = next(filter(None, map(shutil.which, NAMES)), None)
needs_browser = pytest.mark.skipif(BROWSER is None, reason=f"no browser: none of {NAMES} is here")


def _run(page, *words):
    with tempfile.TemporaryDirectory(prefix="dqpaint-browser-", ignore_cleanup_errors=True) as home:
        done = subprocess.run(
            [BROWSER, *QUIET, f"--user-data-dir={home}", *words, page.as_uri()],
            capture_output=True, text=True, timeout=120, check=True,
        )  # fmt: skip
    console = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
    return done.stdout, console


def opened(page, width=1400):
    """The page's elements as text once its scripts have run, and what the console said."""
    return _run(page, f"--window-size={width},1000", "--dump-dom")


def with_script(page, script, keep_policy=False):
    """A copy of a page that runs a script at its end; without its policy that would be refused."""
    text = page.read_text("utf-8")
    if not keep_policy:
        start = text.index('<meta http-equiv="Content-Security-Policy"')
        text = text[:start] + text[text.index(">", start) + 1 :]
    copy = Path(page.parent) / f"{page.stem}-scripted.html"
    copy.write_text(text.replace("</body>", f"<script>{{{script}}}</script></body>"), "utf-8")
    return copy


def screenshot(page, path, width, height):
    _run(page, f"--window-size={width},{height}", f"--screenshot={path}")


def printed(page, path):
    _run(page, "--no-pdf-header-footer", f"--print-to-pdf={path}")
