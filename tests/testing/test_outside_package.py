"""A package outside the repository brings a law that remembers, a plant, a brush and a format."""

import json
import os
import subprocess
import sys

import pytest

from tests.support.plugins import install

PARTS = {
    "laws": '''
"""Laws of the workshop."""

import numpy as np

from dqpaint import dq


class PI:
    """Proportional and integral action on the pose error."""

    def start(self, arm, motion, gains):
        self.sum = np.zeros(6)

    def __call__(self, seen, k=20.0, ki=100.0):
        near = dq.nearest(seen.pose_d, seen.pose)
        error = 2 * dq.log(dq.mul(near, dq.conj(seen.pose)))
        self.sum = self.sum + seen.period * error
        return seen.twist_d + k * error + ki * self.sum
''',
    "plants": '''
"""Plants of the workshop."""

from pydantic import Field

from dqpaint.plants import UNDISTURBED, Ideal, Values


class Share(Values):
    share: float = Field(0.5, description="of the rates that arrive")


class Weak(Ideal):
    """It moves at a share of the rates it is given."""

    options = Share

    def __init__(self, card, posture, period, world=UNDISTURBED, options=None):
        super().__init__(card, posture, period)
        self.share = (options or Share()).share

    def run(self, command, drift=None):
        super().run(self.share * command, drift)
''',
    "brushes": '''
"""Brushes of the workshop."""

import numpy as np
from pydantic import Field

from dqpaint.light.sources import Brush, Emitters


class Pair(Brush):
    """Two lamps side by side."""

    apart: float = Field(0.04, description="from lamp to lamp [m]")

    def emitters(self):
        half = self.apart / 2
        return Emitters([[-half, 0, 0], [half, 0, 0]], np.full((1, 2, 3), 0.5), lobe=self.lobe)
''',
    "formats": '''
"""Formats of the workshop."""

from dqpaint.outputs import writer


@writer("duration", ".duration")
def duration(painting):
    """How long the drawing takes [s]."""
    return f"{painting.motion.t[-1]:.2f}".encode()
''',
}
POINTS = """
[dqpaint.controllers]
workshop-pi = workshop.laws:PI
[dqpaint.plants]
weak = workshop.plants:Weak
[dqpaint.brushes]
pair = workshop.brushes:Pair
[dqpaint.formats]
duration = workshop.formats
"""
TEXT = "period 10 ms\nline to (60, 20, 5) mm tool rot(y, 20 deg) in 1 s\n"
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def outside(tmp_path_factory):
    """A function that runs Python where the package is installed; gives what it prints."""
    folder = tmp_path_factory.mktemp("outside")
    install(folder / "site", "workshop", PARTS, POINTS)
    (folder / "t.traj").write_text(TEXT)
    path = os.pathsep.join([str(folder / "site"), *filter(None, [os.environ.get("PYTHONPATH")])])

    def run(*words):
        done = subprocess.run(
            [sys.executable, *words], cwd=folder, env={**os.environ, "PYTHONPATH": path},
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        return done.stdout

    run.folder = folder
    return run


@pytest.mark.parametrize(
    ("kind", "name", "about"),
    [
        ("controllers", "workshop-pi", "Proportional and integral action on the pose error"),
        ("plants", "weak", "It moves at a share"),
        ("brushes", "pair", "Two lamps side by side"),
        ("formats", "duration", "How long the drawing takes"),
    ],
)
def test_lists_say_what_it_brings(outside, kind, name, about):
    (row,) = [
        r for r in json.loads(outside("-m", "dqpaint", "list", kind, "--json")) if r["name"] == name
    ]
    assert about in row["about"]
    assert row["package"] == "workshop 1.2"
    assert "(from workshop 1.2)" in outside("-m", "dqpaint", "list", kind)


def test_it_is_drawn_with_and_recorded(outside):
    words = ["--plant", "weak:share=0.8", "--brush", "pair:apart=0.06", "--size", "64x36"]
    outside(
        "-m", "dqpaint", "draw", "t.traj", "--controller", "workshop-pi", *words,
        "--save", "json,duration", "--out", "one/",
    )  # fmt: skip
    summary = json.loads((outside.folder / "one/t-workshop-pi.json").read_text())
    assert summary["plugins"] == {
        "brush pair": "workshop 1.2",
        "controller workshop-pi": "workshop 1.2",
        "plant weak": "workshop 1.2",
    }
    assert (outside.folder / "one/t-workshop-pi.duration").read_text() == "1.00"


def test_a_sweep_with_two_workers_gives_the_bits_of_single_runs(outside):
    outside(
        "-m", "dqpaint", "sweep", "t.traj", "--controller", "workshop-pi", "--plant", "weak",
        "--vary", "k=10,20", "--jobs", "2", "--out", "swept/",
    )  # fmt: skip
    found = outside(
        "-c",
        "import dqpaint\n"
        "for k in (10.0, 20.0):\n"
        "    p = dqpaint.draw('t.traj', controller='workshop-pi', plant='weak', gains={'k': k},"
        " size=(64, 36))\n"
        "    print(repr(p.metrics.figures['position_error_rms_m']))\n",
    ).split()
    (table,) = (outside.folder / "swept").glob("*.csv")
    for number in found:
        assert number.removeprefix("np.float64(").rstrip(")") in table.read_text()


def test_the_exported_checks_pass_on_it(outside):
    outside(
        "-c",
        "from dqpaint.testing import check_brush, check_controller, check_plant, check_writer\n"
        "check_controller('workshop-pi')\n"
        "check_plant('weak', within=None)\n"
        "check_brush('pair')\n"
        "check_writer('duration')\n",
    )
