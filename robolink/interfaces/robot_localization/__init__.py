"""Services of the package robot_localization: the state of its filters, and positions on the Earth."""
