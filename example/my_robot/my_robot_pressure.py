"""my_robot_pressure.py: an effect that looks at a measured channel, the column of a gauge."""

from werrimbi_odom.model.effect import Parameter, wheel_effect
from werrimbi_odom.model.motion import WheelTravel

MEASURED_AT = 180.0  # kilopascals at which the radii of the robot file were measured


@wheel_effect(
    channels=("tyre_pressure_kpa",),
    stretch=Parameter(
        "1/kPa", null=0.0, typical=2e-4, bounds=(-0.01, 0.01), says="growth of both radii per kPa"
    ),
)
def radii_follow_pressure(travel, drive, stretch):
    """Both tyres stretch with their pressure, which a gauge at the valves measures.

    Formula    travel *= 1 + stretch * (pressure - 180)      [m] = [m] * [1/kPa] * [kPa]
    Signature  distances and turns too short when pumped up, by a share that follows the gauge
    Ruler      roll a wheel ten turns along a tape, pumped up, then soft: the distances differ
    """
    share = 1.0 + stretch * (drive.channels["tyre_pressure_kpa"].mean - MEASURED_AT)
    return WheelTravel(travel.left * share, travel.right * share)
