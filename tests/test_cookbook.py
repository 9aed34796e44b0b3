"""Every recipe of the cookbook, from its files to its commands, in a folder of its own."""

import io
import re
import shlex
import shutil
from contextlib import redirect_stdout
from pathlib import Path

import pytest

from dqpaint.core.examples import examples_folder

PAGE = (Path(__file__).parent.parent / "docs/cookbook.md").read_text("utf-8")
LEAST = 20  # recipes
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
RECIPES = {
    heading: BLOCK.findall(text)
    for heading, text in re.findall(r"^## (.*?)\n(.*?)(?=^## |\Z)", PAGE, re.DOTALL | re.MULTILINE)
    if BLOCK.search(text)
}


def test_there_are_enough():
    assert len(RECIPES) >= LEAST


@pytest.mark.slow
@pytest.mark.parametrize("heading", RECIPES)
def test_a_recipe_comes_out(heading, answer, tmp_path):
    for name in ("logo.svg", "astronaut.jpg"):
        shutil.copy(examples_folder() / name, tmp_path)
    before = set(tmp_path.rglob("*"))
    answer("--version")  # goes to the folder
    commands = 0
    for kind, text in RECIPES[heading]:
        if kind == "console":
            for line in text.splitlines():
                done = answer(*shlex.split(line.removeprefix("$ dqpaint ")))
                assert done.returncode == 0, (line, done.stderr)
                assert done.stdout or done.stderr
                commands += 1
            continue
        name = re.match(r"# (\S+)\n", text)[1]
        (tmp_path / name).write_text(text)
        if kind == "python" and "console" not in [one for one, _ in RECIPES[heading]][1:]:
            with redirect_stdout(io.StringIO()) as said:
                exec(compile(text, name, "exec"), {"__name__": "__main__"})
            assert said.getvalue()
            commands += 1
    assert commands
    assert set(tmp_path.rglob("*")) > before or "check" in str(RECIPES[heading])
