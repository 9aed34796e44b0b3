"""The page of the language cannot lie: its drawings are drawn, its message said, its code runs."""

import re

import numpy as np
import pytest

import dqpaint
from dqpaint.core.examples import examples_folder
from dqpaint.language import ScriptError, parse
from dqpaint.language.vocabulary.words import STATEMENTS
from dqpaint.language.writing.formatter import formatted
from dqpaint.motion import plan
from dqpaint.motion.profiles import PROFILES
from dqpaint.planning.reachability import reachable_start_posture
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card

PAGE = (examples_folder() / "README.md").read_text("utf-8")


def blocks(kind):
    fences = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
    return [text for found, text in fences if found == kind]


@pytest.mark.parametrize("text", blocks("traj"), ids=lambda text: text.split("\n")[0])
def test_drawings_are_drawn_within_reach_and_without_a_word(text):
    card = read_card("iiwa")
    motion = plan(parse(text, "page.traj"), card.canvas.pose)
    assert not motion.notes
    assert motion.lit.any()
    assert reachable_start_posture(motion, Kinematics(card)).margin > 0
    assert formatted(text) == text


def test_messages_are_said_so():
    (message,) = [text for text in blocks("") if text.startswith("error[")]
    name, line = re.search(r"--> (\S+):(\d+):", message).groups()
    source = re.search(r"^\d+ \| (.*)$", message, re.MULTILINE)[1]
    with pytest.raises(ScriptError) as caught:
        parse("hold 1 s\n" * (int(line) - 1) + source + "\n", name)
    assert f"{caught.value}\n" == message


def test_python_runs(capsys):
    scope = {}
    exec(blocks("python")[0], scope)
    assert parse(capsys.readouterr().out).segments == scope["wave"].program().segments
    assert dqpaint.preview(scope["wave"], size=(64, 36)).image.max() > 150


def test_the_profiles_take_the_time_that_is_told():
    told = dict(re.findall(r"^\| `(\w+)` \| ([\d.]+) \|", PAGE, re.MULTILINE))
    assert set(told) == set(PROFILES) - {"smooth"}  # it takes what its limits need
    for profile, factor in told.items():
        text = f"period 1 ms\nline to (100, 0) mm speed 10 mm/s profile {profile}"
        motion = plan(parse(text), read_card("iiwa").canvas.pose)
        assert motion.t[-1] == pytest.approx(10 * float(factor), abs=2e-3)
        assert np.linalg.norm(motion.twist[:, 3:], axis=1).max() <= 0.01 * (1 + 1e-9)


def test_every_statement_is_taught_before_the_tables():
    text = PAGE[: PAGE.index("## All words")]
    for word in STATEMENTS:
        if word not in ("traj", "robot", "brush"):
            assert re.search(rf"`{word}\b|\*\*{word}\*\*", text), word


def test_bounds_are_the_program_s():
    from dqpaint.core.bounds import DEFAULT_MAX_SAMPLES
    from dqpaint.language.compile import MOST_LINES
    from dqpaint.language.expansion import blocks as language_blocks
    from dqpaint.language.pen.pen import MOST_SEGMENTS
    from dqpaint.language.syntax.expressions import DEEPEST
    from dqpaint.language.syntax.parser import DEEPEST as DEEPEST_BLOCK
    from dqpaint.language.syntax.source import MOST_BYTES
    from dqpaint.motion.schedule import MOST_SECONDS

    text = " ".join(PAGE[PAGE.index("## Bounds") :].split())
    for number, after in [
        (MOST_BYTES // 1_000_000, " MB"), (MOST_LINES, " lines"), (DEEPEST_BLOCK, " deep"),
        (language_blocks.MOST_PASSES, " passes"), (language_blocks.MOST_STATEMENTS, " statements"),
        (MOST_SEGMENTS, " strokes"), (DEFAULT_MAX_SAMPLES, " samples"),
        (int(MOST_SECONDS) // 3600, " hours"),
    ]:  # fmt: skip
        assert f" {number:,}{after}" in text, after
    assert f"brackets {DEEPEST};" in text
