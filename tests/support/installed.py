"""What is installed here -> marks that leave out tests of what is not; names in the arm iiwa."""

import pytest

from dqpaint.plants import ENGINES
from dqpaint.robots.model.card import read_card

OF_NUMBERS = read_card("iiwa").is_of_numbers
BASE = "base" if OF_NUMBERS else "lbr_iiwa_link_0"
LINK, JOINT = ("body", "joint") if OF_NUMBERS else ("lbr_iiwa_link_", "lbr_iiwa_joint_")
JOINTS = tuple(f"{JOINT}{i}" for i in range(1, 8))

needs_pybullet_data = pytest.mark.skipif(
    OF_NUMBERS, reason="of the files in pybullet_data: names, rounding, meshes"
)
needs_pybullet = pytest.mark.skipif(
    not ENGINES["pybullet"].installed, reason="pybullet is not installed"
)
