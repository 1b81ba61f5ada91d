"""My effects keep the laws that fits, the diagnosis and the node rely on."""

import pytest
from my_robot_effects import radius_grows_with_speed
from my_robot_warmth import radius_follows_temperature

from werrimbi_odom.effects.contract import check_effect


@pytest.mark.parametrize("effect", [radius_grows_with_speed, radius_follows_temperature])
def test_it_keeps_the_laws(effect):
    """On a drive with everything in it."""
    check_effect(effect)
