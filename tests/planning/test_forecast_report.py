"""What is said of a forecast: at its place, short, with the numbers for programs."""

import json
import re
from dataclasses import replace

import pytest

from dqpaint.errors import UsageError
from dqpaint.planning.check import as_json, check
from dqpaint.planning.forecast_report import _warnings
from dqpaint.robots.model.card import read_card

FAST = (
    "period 8 ms\nstart at (0, 0) mm\nline to (40, 0) mm\n"
    "line to (150, 0) mm speed 900 mm/s profile constant\nline to (0, 60) mm speed 1200 mm/s\n"
)


@pytest.fixture
def checked(tmp_path):
    def call(text, robot="iiwa", **options):
        path = tmp_path / "a.traj"
        path.write_text(text)
        return check(str(path), robot=robot, **options)

    return call


def test_limits_are_warnings_at_the_worst_line(checked):
    result = checked(FAST)
    assert result.errors == 0
    codes = {d.code: d for d in result.forecast.warnings}
    assert set(codes) == {"W502", "W503", "W504"}
    speed = codes["W502"]
    lines = {line.line.line: line for line in result.forecast.lines}
    assert f"joint {lines[5].speed.joint} has to turn at" in speed.message
    assert "likewise line 4" in result.text
    assert ":5:1\n" in result.text.partition("W502")[2]
    assert "= help: draw it slower" in result.text


START = "start at (0, 0) mm\n"
TWO_LEGS = "line to (100, 0) mm\nline to (100, 100) mm\nend\n"
SUDDEN = {
    "constant": "line to (100, 0) mm speed 300 mm/s profile constant\n",
    "after another": "line to (90, 0) mm speed 300 mm/s\n"
    "line to (0, 0) mm in 0.4 s profile constant\n",
    "rates": "line to (100, 0) mm in 0.3 s profile cubic(500 mm/s, 500 mm/s)\n",
    "trapezoid": "line to (10, 0) mm speed 400 mm/s\n",
    "quintic": "line to (10, 0) mm in 0.056 s profile quintic\n",
    "text": 'corner jump\ntext "Marie" height 25 mm speed 300 mm/s\n',
    "stroke": "stroke speed 600 mm/s corner jump\n" + TWO_LEGS,
    "constant stroke": "stroke speed 300 mm/s profile constant\n" + TWO_LEGS,
}


@pytest.mark.parametrize(("text", "sufficient"), [
    (SUDDEN["constant"], "profile trapezoid"), (SUDDEN["after another"], "profile trapezoid"),
    (SUDDEN["rates"], "profile trapezoid"), (SUDDEN["trapezoid"], "profile quintic"),
    (SUDDEN["quintic"], ""), (SUDDEN["text"], "corner 0.1 mm"), (SUDDEN["stroke"], "corner 0.1 mm"),
    (SUDDEN["constant stroke"], "corner 0.1 mm"),
], ids=SUDDEN)  # fmt: skip
def test_advice_against_torque_is_not_what_the_drawing_has_and_helps(checked, text, sufficient):
    before = checked(START + text)
    (warning,) = [one for one in before.forecast.warnings if one.code == "W504"]
    written = re.search(r"write ((profile|corner) [\w. ]+)", warning.help)
    assert (written[1] if written else "") == sufficient
    assert "--on-limit slow" in warning.help
    slowed = checked(START + text, on_limit="slow").forecast.warnings
    assert not [one for one in slowed if "--on-limit slow" in one.help]
    if not written:
        return
    bare = re.sub(r" ?(corner jump|profile constant|profile cubic\(.*?\))", "", text)
    after = checked(f"{START}{sufficient}\n{bare}")
    most = [max(line.jolt_part for line in one.forecast.lines) for one in (before, after)]
    assert most[1] < 0.9 * most[0]
    assert not [one for one in after.forecast.warnings if sufficient in one.help]


def test_where_the_weight_takes_it_no_pace_is_advised(checked):
    one = checked(FAST).forecast
    heavy = tuple(replace(line, weight_part=0.9) for line in one.lines)
    said = {d.code: d.help for d in _warnings(one.motion, read_card("iiwa"), heavy)}
    assert "place" in said["W503"]
    assert "slow" not in said["W503"] + said["W504"]


def test_the_table_speaks_of_what_is_close_alone(checked):
    said = checked(FAST).text.partition("\nhint: ")[0]
    table = said.partition("at most:")[2].splitlines()[1:]
    assert re.split(r"\s{2,}", table[0].strip()) == [
        "line",
        "speed",
        "torque within 1 ms",
        "torque",
    ]
    assert [row.split()[0] for row in table[1:]] == ["4", "5"]
    assert "off limits" not in table[0]
    calm = checked("start at (0, 0) mm\nline to (40, 0) mm\n")
    assert not calm.diagnostics
    assert calm.text.partition("\nhint: ")[0].splitlines()[-1].startswith("  at most: joint")


def test_the_numbers_for_programs(checked):
    result = checked(FAST)
    made = json.loads(json.dumps(as_json([result]), allow_nan=False))
    assert made["version"] == 1
    ahead = made["files"][0]["forecast"]
    assert ahead["robot"] == "iiwa"
    assert len(ahead["start_rad"]) == 7
    assert [line["line"] for line in ahead["lines"]] == [3, 4, 5]
    last = ahead["lines"][2]
    assert last["speed_rad_s"]["part_of_limit"] > 1
    assert set(last["effort_Nm"]) == {"value", "joint", "time", "part_of_limit"}
    assert last["clearance_m"] > 0
    assert last["hidden"] == 0
    codes = {d["code"] for d in made["diagnostics"]}
    assert codes == {"W403", "W502", "W503", "W504"}  # W403 is of the text alone
    assert made["summary"]["warnings"] == 4


def test_without_an_arm_nothing_is_looked_ahead(checked):
    assert checked(FAST, None, start="first", view="front").forecast is None  # the defaults
    assert checked(FAST, None, start="home").forecast is not None
    result = checked(FAST, None)
    assert result.forecast is None
    assert as_json([result])["files"][0]["forecast"] is None


def test_a_light_that_is_turned_away_is_hidden(checked):
    text = "start at (0, 0) mm tool rpy(0 deg, 150 deg, 0 deg)\nline to (30, 0) mm light red\n"
    result = checked("place at (0.1, 0.5, 0.5) m turned rpy(90 deg, 0 deg, 90 deg)\n" + text)
    hidden = [d for d in result.diagnostics if d.code == "W507"]
    assert hidden
    assert "100% of the light" in hidden[0].message


def test_links_that_meet_are_named(checked):
    """test_collisions looks at which postures collide; here, what is said of one."""
    outlook = checked("start at (0, 0) mm\nline to (40, 0) mm\n").forecast
    assert not outlook.warnings
    meeting = replace(outlook.lines[0], clearance=-0.0123, closest_links=("wrist", "base"))
    touching = replace(meeting, clearance=0.0)
    found = _warnings(outlook.motion, read_card("iiwa"), [meeting])
    assert [d.code for d in found] == ["W506"]
    assert found[0].message == "link 'wrist' runs into link 'base' (by 12 mm)"
    assert not _warnings(outlook.motion, read_card("iiwa"), [touching])
    assert "links apart" in replace(outlook, lines=(touching,)).text


def test_near_a_singularity(checked):
    result = checked(
        "place at (0.9, 0, 0.36) m turned rpy(90 deg, 0 deg, 90 deg)\n"
        "start at (0, 0) mm\nline to (0, 0, 80.3) mm in 4 s\n"
    )
    worst = min(line.singular_value for line in result.forecast.lines)
    assert worst < 0.04
    assert "W505" in {d.code for d in result.diagnostics}
    assert "below 0.04): there it follows inexactly\n" in result.text


def test_a_millimetre_beside_a_singularity_is_told(checked):
    outlook = checked("start at (0, 0) mm\nline to (40, 0) mm\n").forecast
    beside = replace(outlook.lines[0], singular_value=0.01, path_error=0.0031)
    (warning,) = _warnings(outlook.motion, read_card("iiwa"), [beside])
    assert warning.message.endswith("there it follows inexactly, up to 3.1 mm beside")


def test_place_auto_says_where(checked):
    result = checked("place auto\nstart at (0, 0) mm\nline to (40, 0) mm in 1 s\n")
    assert "\n  place at (" in result.text
    assert "merit " in result.text
    assert as_json([result])["files"][0]["forecast"]["place"]["line"] in result.text
    with pytest.raises(UsageError, match="'here'"):
        checked(FAST, place="here")
