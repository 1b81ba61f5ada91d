"""my_robot_effects.py: what my robot does and no library knows."""

from werrimbi_odom.model.effect import Parameter, wheel_effect
from werrimbi_odom.model.motion import WheelTravel


@wheel_effect(
    loss=Parameter(
        "",
        null=0.0,
        typical=0.01,
        bounds=(-0.2, 0.2),
        says="share of both radii that is lost when rolling backwards",
    ),
)
def tread_lies_down(travel, drive, loss):
    """The tread's blocks stand when the robot goes ahead, and lie down when it goes back.

    Formula    travel *= 1 - loss, each wheel for itself, while it rolls backwards
    Signature  distances right ahead and too long backwards; spins err with one wheel alone
    Ruler      drive 5 m to and fro by the odometry along a tape: the way back is shorter
    """
    return WheelTravel(
        travel.left * (1.0 - loss * (drive.left_speed.end < 0.0)),
        travel.right * (1.0 - loss * (drive.right_speed.end < 0.0)),
    )
