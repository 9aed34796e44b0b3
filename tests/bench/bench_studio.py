"""From a key to the new picture on the screen, in a real browser: median and 95 % of many edits.

    python -m tests.bench.bench_studio 50 star lag signature

Times are taken in the page: from the key's event to the load of the picture that it made. Beside
them stands a floor of the same run: a round trip to the server and back.
"""

import sys
import tempfile
from pathlib import Path
from statistics import median

from dqpaint.core import example_names, find_drawing
from tests.support.studio import browser, open_page, studio, type_at_end

WATCH = """() => {
  window.took = [];
  const image = document.querySelector(".picture");
  let begun = 0;
  document.addEventListener('keydown', () => { begun = performance.now(); }, true);
  new MutationObserver(() => {
    if (begun) { window.took.push(performance.now() - begun); begun = 0; }
  }).observe(image, {attributes: true, attributeFilter: ["src"], subtree: true});
}"""
PAUSE = 700  # [ms] between keys
FIRST_RUN = 4000  # [ms] until the first run is over


def measure(page, edits):
    """Times [ms] of edits of a stroke that is added at the end: it grows and shrinks."""
    type_at_end(page, "\nline by (0, 3, 0) mm")
    for _ in range(len(", 0) mm")):
        page.keyboard.press("ArrowLeft")
    page.wait_for_timeout(FIRST_RUN)
    page.evaluate(WATCH)
    for i in range(edits):
        page.keyboard.press("Backspace" if i % 2 else "1")
        page.wait_for_timeout(PAUSE)
    return page.evaluate("() => window.took")


def main(edits, names):
    with tempfile.TemporaryDirectory() as folder, browser() as chromium:
        for name in names:
            (Path(folder) / f"{name}.traj").write_text(find_drawing(name).read_text())
        for name in names:
            with studio(folder, f"{name}.traj") as (address, _):
                page, _ = open_page(chromium, address)
                took = sorted(measure(page, edits))
                page.close()
            last = took[min(len(took) - 1, round(0.95 * len(took)))] if took else float("nan")
            middle = median(took) if took else float("nan")
            print(f"{name:16} {len(took):3} pictures: median {middle:5.0f} ms, 95 % {last:5.0f} ms")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 50, sys.argv[2:] or example_names())
