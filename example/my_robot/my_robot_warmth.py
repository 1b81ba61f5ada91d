"""my_robot_warmth.py: an effect that looks at a measured channel, the column of a thermometer."""

from werrimbi_odom.model.effect import Parameter, wheel_effect
from werrimbi_odom.model.motion import WheelTravel

MEASURED_AT = 22.0  # degrees Celsius at which the radii of the robot file were measured


@wheel_effect(
    channels=("wheel_temperature_c",),
    expansion=Parameter(
        "1/K", null=0.0, typical=5e-4, bounds=(-0.01, 0.01), says="growth of both radii per kelvin"
    ),
)
def radius_follows_temperature(travel, drive, expansion):
    """Both wheels swell with warmth, which a thermometer on the hub measures.

    Formula    travel *= 1 + expansion * (temperature - 22)      [m] = [m] * [1/K] * [K]
    Signature  distances and turns too short when warm, by a share that follows the thermometer
    Ruler      roll a wheel ten turns along a tape, cold, then warm: the distances differ
    """
    share = 1.0 + expansion * (drive.channels["wheel_temperature_c"].mean - MEASURED_AT)
    return WheelTravel(travel.left * share, travel.right * share)
