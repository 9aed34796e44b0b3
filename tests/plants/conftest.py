"""An arm of one joint, for closed forms; every physics engine in turn."""

from xml.etree import ElementTree as Xml

import pytest

from dqpaint.plants import ENGINES
from dqpaint.plants.engines import choice
from dqpaint.robots.model.card import Card, read_card
from dqpaint.robots.model.chain import UrdfFile
from dqpaint.robots.urdf.prepare import prepare

IIWA = read_card("iiwa")


@pytest.fixture(params=list(ENGINES))
def engine(request, monkeypatch):
    """Each engine in turn, as if it were the only one that is installed."""
    if not ENGINES[request.param].installed:
        pytest.skip(f"{request.param} is not installed")
    monkeypatch.setattr(choice, "available_engines", lambda: [request.param])
    return request.param


@pytest.fixture
def one_joint(tmp_path):
    """A card of the iiwa with all joints but one held at zero."""

    def make(joint, friction=0.0):
        robot = Xml.fromstring(prepare(IIWA).text)
        moving = [j for j in robot.iter("joint") if j.get("type") == "revolute"]
        for number, element in enumerate(moving):
            if number != joint:
                element.set("type", "fixed")
            else:
                element.find("dynamics").set("damping", repr(friction))
        path = tmp_path / "one.urdf"
        path.write_text(Xml.tostring(robot, encoding="unicode"))
        limits = IIWA.limits.model_construct(
            lower_deg=(-170.0,), upper_deg=(170.0,), speed_deg_s=(500.0,), effort_Nm=(1e5,)
        )
        return Card.model_construct(
            name="one", title="", source="", licence="", home_deg=(0.0,), tool=IIWA.tool,
            urdf=UrdfFile(file=str(path), link=IIWA.link), canvas=IIWA.canvas, limits=limits,
            denavit_hartenberg=None, screws=None, body=None, notes=(),
        )  # fmt: skip

    return make
