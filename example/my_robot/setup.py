"""Effects of my robot: for pip, and for colcon (ament_python)."""

from setuptools import setup

NAME = "my_robot_effects"

setup(
    name=NAME,
    version="0.1.0",
    py_modules=["my_robot_effects", "my_robot_pressure"],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
    ],
    install_requires=["werrimbi_odom"],
    entry_points={
        # From here on werrimbi, robot files and the node know these names.
        "werrimbi_odom.effects": [
            "tread_lies_down = my_robot_effects:tread_lies_down",
            "radii_follow_pressure = my_robot_pressure:radii_follow_pressure",
        ],
    },
)
