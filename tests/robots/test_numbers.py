"""Arms in numbers, for where their files are not installed, against these files."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.robots.kinematics import Dynamics, Kinematics
from dqpaint.robots.model.card import Card, card_names, read_card

OF_NUMBERS = [name for name in card_names() if read_card(name).numbers]


@pytest.mark.parametrize("name", OF_NUMBERS)
def test_they_are_the_same_chain_with_the_same_masses(name, rng, monkeypatch):
    """Poses to 1e-10, inertias and forces to 1e-8: friction, gravity and what is fixed included."""
    card = read_card(name)
    if card.lacks_file:
        pytest.skip(f"{name} needs {card.urdf.package}")
    whole = Kinematics(card)
    monkeypatch.setattr(Card, "lacks_file", True)
    assert card.is_of_numbers
    plain = Kinematics(card)
    assert not plain.notes
    for _ in range(5):
        q, v = rng.uniform(card.lower, card.upper), rng.normal(size=card.joints)
        pose = whole.pose(q)
        np.testing.assert_allclose(dq.nearest(plain.pose(q), pose), pose, atol=1e-10)
        for one, other in zip(
            Dynamics(plain).inertia_and_bias(q, v), Dynamics(whole).inertia_and_bias(q, v),
            strict=True,
        ):  # fmt: skip
            np.testing.assert_allclose(one, other, atol=1e-8)


@pytest.mark.parametrize("name", OF_NUMBERS)
def test_they_need_nothing_and_say_where_they_are_from(name, monkeypatch):
    card = read_card(name)
    monkeypatch.setattr(Card, "lacks_file", True)
    card.check_installed()
    assert not card.missing
    assert card.meshes_hint == "pip install pybullet"
    assert "shapes of our own" in card.origin
    monkeypatch.setattr(Card, "lacks_file", False)
    assert not card.meshes_hint


def test_the_default_arm_is_among_them():
    assert "iiwa" in OF_NUMBERS


def test_a_card_with_too_few_numbers_is_refused():
    card = read_card("iiwa")
    fields = card.model_dump()
    fields["numbers"]["links"] = fields["numbers"]["links"][:-1]
    with pytest.raises(ValueError, match="links needs one table for each joint"):
        Card.model_validate(fields)
