# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The real robots: from which public repository each comes, at which commit, and how it is read.

Robot files hold the nominal values that the authors state: not calibrated, and not always right.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

from test.recorded_robots import converters
from test.recorded_robots.runs import Drive, Read

OPTITRACK_DRIVES = (
    *(f"square_231220200029_{number:02d}" for number in range(1, 7)),
    *(f"circular_231220200121_{number:02d}" for number in range(1, 7)),
    *("free_020120212354_01", "free_030120210001_01", "free_030120210001_02"),
)
OPTITRACK_IN_JUNE = (
    *(f"square_230620202042_{number:02d}" for number in range(1, 7)),
    *(f"circular_250620202104_{number:02d}" for number in range(1, 7)),
    *(f"ivanjko_250620201618_{number:02d}" for number in range(1, 10)),
)


@dataclass(frozen=True, kw_only=True)
class Repository:
    """A public repository at one commit."""

    name: str
    commit: str
    licence: str

    @property
    def url(self) -> str:
        """From where it is cloned."""
        return f"https://github.com/{self.name}.git"


@dataclass(frozen=True, kw_only=True)
class Robot:
    """One robot: where it comes from, its robot file, and what makes its drives."""

    folder: str
    source: Repository
    remarks: tuple[str, ...]
    separation: float
    radius: float
    counts: float
    bits: int = 0
    drives: Callable[[Read], Iterator[Drive]]

    def robot_file(self) -> str:
        """The robot file of the nominal values."""
        lines = [f"# {remark}" for remark in self.remarks]
        lines.append(
            f"# source: github.com/{self.source.name} at {self.source.commit[:12]}; "
            f"licence: {self.source.licence}"
        )
        lines += [
            "odom_node:",
            "  ros__parameters:",
            f"    wheel_separation: {self.separation}",
            f"    wheel_radius: {self.radius}",
            f"    left_ticks_per_revolution: {self.counts}",
            f"    right_ticks_per_revolution: {self.counts}",
        ]
        lines += [f"    encoder_bits: {self.bits}"] if self.bits else []
        return "\n".join(lines) + "\n"


OPTIODOM = Repository(
    name="sousarbarb/optiodom",
    commit="8e025fd7a30c7152132e0ae53ba23bbc909f5a81",
    licence="MIT",
)
CALIBRATION = Repository(
    name="AndreaCensi/calibration",
    commit="026c7c3b21392e6143eea25c424dba69cc29614e",
    licence="none stated (supplement of Censi et al., IEEE T-RO 2013): use it, do not pass it on",
)
LIBRSF = Repository(
    name="TUC-ProAut/libRSF",
    commit="d54801a232af02c0cda6012dabd3dea6c5fd77c5",
    licence="CC BY-SA 4.0 (datasets/Indoor_UWB, the Labyrinth Dataset of Tim Pfeifer)",
)
WHEEL_SLIP = Repository(
    name="jonlwowski012/UGV-Wheel-Slip-Detection-Using-LSTM-and-DNN",
    commit="2af5dcf4c3b043f065f75b612a4bbfc4aa2d11e8",
    licence="Apache-2.0",
)
LIDAR_SLAM = Repository(
    name="WinstonHChou/ECE276A-PR2-LiDAR-Based-SLAM",
    commit="72c56b51391182c4b0ea38828ca62ec9177c3c85",
    licence="Apache-2.0 (recordings: UPenn ESE 650)",
)
BRENNER = Repository(
    name="trueliar/SLAM",
    commit="0f3daf6e5e525354acc1fb18b9e7d67791b92239",
    licence="none stated (data of Claus Brenner's lectures on SLAM): use it, do not pass it on",
)

_KOBUKI = (
    "nominal values of kobuki_driver: base 0.230 m, wheel radius 0.035 m, 2578.33 counts a turn",
    "heading: its own gyro, 100 Hz, bias at rest taken off; motor columns as published",
)
_UPENN = (
    "UPenn ESE 650 robot, four driven wheels (skid steer), both wheels of a side summed",
    "wheels of 254 mm, sides 393.7 mm apart (the middle of 476.25 and 311.15)",
)

_KHEPERA = partial(
    Robot,
    source=CALIBRATION,
    remarks=("Khepera III with a laser range finder, nominal values",),
    separation=0.09,
    radius=0.021,
    counts=1000000.0,
)
_OPTITRACK = partial(
    Robot,
    source=OPTIODOM,
    remarks=("Small differential robot, wheels of 84 mm, 64 counts x gear 43.7; nominal",),
    separation=0.2,
    radius=0.042,
    counts=2796.8,
)
_TURTLEBOT = partial(
    Robot, source=WHEEL_SLIP, separation=0.23, radius=0.035, counts=2578.33, bits=16
)
_SKID = partial(Robot, source=LIDAR_SLAM, separation=0.3937, radius=0.127, counts=720.0)

ROBOTS = (
    _OPTITRACK(
        folder="optitrack_robot",
        drives=lambda read: converters.optitrack(read, OPTITRACK_DRIVES),
    ),
    _OPTITRACK(
        folder="optitrack_in_june",
        drives=lambda read: converters.optitrack(read, OPTITRACK_IN_JUNE),
    ),
    _KHEPERA(
        folder="khepera_laser_to_the_side",
        drives=lambda read: converters.khepera(read, "l90"),
    ),
    _KHEPERA(
        folder="khepera_laser_moved",
        drives=lambda read: converters.khepera(read, "lmov"),
    ),
    Robot(
        folder="labyrinth",
        source=LIBRSF,
        remarks=("Small robot; travel from wheel speeds, positions alone",),
        separation=0.0785,
        radius=0.016,
        counts=1000000.0,
        drives=converters.labyrinth,
    ),
    Robot(
        folder="lego",
        source=BRENNER,
        remarks=("Lego NXT robot; 0.349 mm a count and a base of 155 mm as in the lectures",),
        separation=0.155,
        radius=0.02,
        counts=360.0,
        drives=converters.lego,
    ),
    _TURTLEBOT(
        folder="kobuki_sound",
        remarks=("TurtleBot 2 (Kobuki), no fault", *_KOBUKI),
        drives=lambda read: converters.kobuki(read, "nonfaulty", -0.0099494785, (1576, 2377)),
    ),
    _TURTLEBOT(
        folder="kobuki_left_taped",
        remarks=("TurtleBot 2 (Kobuki), a quarter turn of the left tread under tape", *_KOBUKI),
        drives=lambda read: converters.kobuki(
            read, "left_faulty", -0.0101677647, (1180, 1746, 2286, 2802)
        ),
    ),
    _TURTLEBOT(
        folder="kobuki_right_taped",
        remarks=("TurtleBot 2 (Kobuki), tape on the right tread", *_KOBUKI),
        drives=lambda read: converters.kobuki(
            read, "right_faulty", -0.0103958546, (2047, 3820, 4016, 4636)
        ),
    ),
    _TURTLEBOT(
        folder="kobuki_both_taped",
        remarks=("TurtleBot 2 (Kobuki), tape on both treads", *_KOBUKI),
        drives=lambda read: converters.kobuki(read, "both_faulty", -0.0104004, ()),
    ),
    _SKID(
        folder="upenn_skid_gyro",
        remarks=(*_UPENN, "heading: gyro, bias at rest taken off"),
        drives=lambda read: converters.upenn_gyro(read, {20: 0.00043005557, 21: 0.00026089755}),
    ),
    _SKID(
        folder="upenn_skid_icp",
        remarks=(*_UPENN, "a student's scan matcher, of the robot's middle: judge as incremental"),
        drives=lambda read: converters.upenn_icp(read, {20: 0.008702, 21: 0.025194}),
    ),
)

TURTLEBOT3 = Repository(
    name="Jacopo-oranneZ/SESASR-LAB",
    commit="54b12daff6f29715fa7ca275666e6ecb0b065006",
    licence="none stated: use it, do not pass it on",
)
BAGS = tuple(
    f"rosbag2_2025_11_06-{at}/{file}"
    for at in ("16_53_28", "17_00_32", "17_25_46")
    for file in ("metadata.yaml", f"rosbag2_2025_11_06-{at}_0.db3")
)
"""Files of its bags in lab03_pkg/recordings, which are judged as they are (docs/turtlebot3.md)."""
