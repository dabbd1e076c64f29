"""Services of the package slam_toolbox: maps to save and go on with, measurements to pause."""
