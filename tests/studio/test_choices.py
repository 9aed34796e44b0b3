"""The controls of the page: those of the command line, and the command that they mean."""

import shlex

import pytest

from dqpaint.settings import COMMANDS, make_settings, settings_of
from dqpaint.studio.choices import LEFT_OUT, command, controls, gains_of


def test_every_option_of_draw_has_a_control_or_is_left_out_on_purpose():
    known = {setting.keyword for setting in settings_of(*COMMANDS["draw"])}
    shown = {control.keyword for group in controls().values() for control in group}

    assert shown == known - LEFT_OUT
    assert known | {"trust"} >= LEFT_OUT


def test_names_are_of_the_registries():
    found = {one.keyword: one for group in controls(["mine.py"]).values() for one in group}

    assert {"hinf", "p", "mine.py"} <= set(found["controller"].names)
    assert {"iiwa", "panda"} <= set(found["robot"].names)
    assert "aces" in found["look"].names
    assert found["on_limit"].names == ("clip", "slow", "stop")
    assert found["overlay"].kind == "switch"
    assert found["ev"].kind == "number"


def test_gains_are_numbers_with_a_meaning():
    (k,) = gains_of("p")

    assert (k.name, k.default > 0, bool(k.about)) == ("k", True, True)
    assert gains_of("mine.py") == []


@pytest.mark.parametrize(
    "choices",
    [
        {},
        {"controller": "p", "gains": {"k": 12.0}, "overlay": True, "ev": -1.5},
        {
            "disturb": ["twist=sine,x=0.02,frequency=2", "latency=3"],
            "seed": 3,
            "view": "iso",
            "ghost": True,
        },
        {"plant": "compliant:frequency=40", "robot": "panda", "place": "auto"},
    ],
)
def test_the_command_means_the_same(choices, monkeypatch):
    from dqpaint import api
    from dqpaint.cli import main

    seen = []

    class SeenError(Exception):
        pass

    def draw(_path, **given):
        seen.append(given)
        raise SeenError

    monkeypatch.setattr(api, "draw", draw)
    words = shlex.split(command("star", choices))
    monkeypatch.setattr("sys.argv", words)
    monkeypatch.setenv("DQPAINT_DEBUG", "1")
    with pytest.raises(SeenError):
        main.run()
    chosen = {name for name in seen[0]} - {"settings", "progress", "formats", "before"}

    typed = {name: seen[0][name] for name in chosen}
    assert make_settings(**typed) == make_settings(**choices)
