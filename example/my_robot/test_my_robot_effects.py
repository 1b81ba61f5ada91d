"""My effects keep the laws that fits, the diagnosis and the node rely on."""

import pytest
from my_robot_effects import tread_lies_down
from my_robot_pressure import radii_follow_pressure

from werrimbi_odom.effects.contract import check_effect


@pytest.mark.parametrize("effect", [tread_lies_down, radii_follow_pressure])
def test_it_keeps_the_laws(effect):
    """On a drive with everything in it."""
    check_effect(effect)
