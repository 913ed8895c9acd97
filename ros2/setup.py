from setuptools import setup

NAME = "quadedge_ros2"
setup(
    name=NAME,
    version="0.2.0",
    license="MIT",
    packages=[NAME],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/launch", ["launch/quadedge.launch.py"]),
        (f"share/{NAME}/config", ["config/quadedge.yaml"]),
    ],
    entry_points={"console_scripts": [f"quadedge = {NAME}.node:main"]},
)
