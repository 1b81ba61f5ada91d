"""my_robot_effects.py: what my robot does and no library knows."""

from werrimbi_odom.model.effect import Parameter, wheel_effect
from werrimbi_odom.model.motion import WheelTravel


@wheel_effect(
    growth=Parameter(
        "s^2/m^2",
        null=0.0,
        typical=0.03,
        bounds=(-0.2, 0.2),
        says="relative growth of a radius per squared speed of its rim",
    ),
)
def radius_grows_with_speed(travel, drive, growth):
    """Soft tyres grow with the square of their speed.

    Formula    travel *= 1 + growth * speed^2, each wheel for itself
    Signature  distances too short at speed and right at a crawl; more so on a curve's outer wheel
    Ruler      drive 10 m by the odometry, slowly, then fast: the tape shows more when fast
    """
    return WheelTravel(
        travel.left * (1.0 + growth * drive.left_speed.end**2),
        travel.right * (1.0 + growth * drive.right_speed.end**2),
    )
