"""Effects of my robot: for pip, and for colcon (ament_python)."""

from setuptools import setup

NAME = "my_robot_effects"

setup(
    name=NAME,
    version="0.1.0",
    py_modules=["my_robot_effects", "my_robot_warmth"],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
    ],
    install_requires=["werrimbi_odom"],
    entry_points={
        # From here on werrimbi, robot files and the node know these names.
        "werrimbi_odom.effects": [
            "radius_grows_with_speed = my_robot_effects:radius_grows_with_speed",
            "radius_follows_temperature = my_robot_warmth:radius_follows_temperature",
        ],
    },
)
