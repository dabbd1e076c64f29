"""Package that pages of the manual start files of."""

from setuptools import setup

setup(
    name="my_package",
    packages=["my_package"],
    data_files=[("share/my_package/launch", ["launch/bot.launch.py", "launch/bot.launch.xml", "launch/robot.launch.yaml"])],
    entry_points={"console_scripts": ["driver = my_package.driver:main"]},
)
