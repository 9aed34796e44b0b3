"""The exported checks: all that is built in keeps them; a planted fault in each kind does not."""

import numpy as np
import pytest

from dqpaint.disturbances import DISTURBANCES, Disturbance
from dqpaint.light.sources import BRUSHES, Brush
from dqpaint.light.sources.emitters import Emitters
from dqpaint.plants import PLANTS
from dqpaint.plants.ideal import Ideal
from dqpaint.testing import check_brush, check_disturbance, check_plant
from tests.support.disturbances import RANDOM, SIZES

WITHIN = {"ideal": 1e-12, "compliant": 0.1}  # springs give way


@pytest.mark.slow
@pytest.mark.parametrize("name", PLANTS)
def test_plants(name):
    check_plant(name, WITHIN.get(name, 2e-4))


@pytest.mark.parametrize("name", BRUSHES)
def test_brushes(name):
    check_brush(name, even=name != "pixelstick")


@pytest.mark.slow
@pytest.mark.parametrize("name", DISTURBANCES)
def test_disturbances(name):
    check_disturbance(name, SIZES[name], name in RANDOM)


class Lazy(Ideal):
    """It goes half as far as it is told."""

    def run(self, command, drift=None):
        super().run(0.5 * command, drift)


class Restless(Ideal):
    """No two runs are alike."""

    def __init__(self, card, posture, period, *others):
        super().__init__(card, posture, period)
        self.posture = posture + np.random.default_rng().normal(size=len(posture)) * 1e-13


class Elsewhere(Ideal):
    """It begins in another posture."""

    def __init__(self, card, posture, period, *others):
        super().__init__(card, posture + 0.1, period)


class Deaf(Ideal):
    """It does not feel a drift."""

    def run(self, command, drift=None):
        super().run(command)


class Grasping(Ideal):
    """It writes into what belongs to others."""

    def run(self, command, drift=None):
        super().run(command, drift)
        command *= 0.0


@pytest.mark.parametrize(
    ("plant", "said"),
    [
        (Lazy, "rates are those|follows its rates"),
        (Restless, "same bits"),
        (Elsewhere, "begins in its start"),
        (Deaf, "drift"),
        (Grasping, "commands as they are"),
    ],
)
def test_faulty_plants_are_found(plant, said):
    with pytest.raises(AssertionError, match=said):
        check_plant(plant)


def test_a_faultless_plant_passes():
    check_plant(Ideal, 1e-12)


class Dim(Brush):
    """It gives too little light."""

    def emitters(self):
        return Emitters(tints=np.full((1, 1, 3), 0.9))


class Undocumented(Brush):
    """A value without a description."""

    width: float = 0.1

    def emitters(self):
        return Emitters()


class Flickering(Brush):
    """Another brush at each look."""

    def emitters(self):
        return Emitters(np.random.default_rng().normal(size=(1, 3)) * 0.01)


@pytest.mark.parametrize(
    ("brush", "said"), [(Dim, "light of"), (Undocumented, "'width' has a description")]
)
def test_faulty_brushes_are_found(brush, said):
    with pytest.raises(AssertionError, match=said):
        check_brush(brush)


class Nothing(Disturbance):
    """It does nothing at all."""


class Loud(DISTURBANCES["base"]):
    """Its values have no description."""

    size: float = 1.0


def test_faulty_disturbances_are_found():
    with pytest.raises(AssertionError, match="changes the run"):
        check_disturbance(Nothing, {}, random=False)
    with pytest.raises(AssertionError, match="'size' has a description"):
        check_disturbance(Loud, {}, random=False)
    with pytest.raises(AssertionError, match="only if, it is random"):
        check_disturbance("base", SIZES["base"], random=True)
