"""Nodes of Nav2 with parameters that are refused: the reason is said, and nothing else fails after it."""

from __future__ import annotations

import pytest

import robolink
from robolink.counterparts.nav2_controller.controller_server import ControllerServer
from robolink.counterparts.nav2_planner.planner_server import PlannerServer
from robolink.exceptions import InvalidParameterValueException
from robolink.parameter import Parameter


@pytest.mark.parametrize(
    ("server", "name"), [(ControllerServer, "controller_frequency"), (PlannerServer, "expected_planner_frequency")]
)
def test_a_parameter_out_of_its_range_is_the_only_error(
    server: type[ControllerServer | PlannerServer], name: str
) -> None:
    with pytest.raises(InvalidParameterValueException, match=name), robolink.init(args=[]):  # its end destroys nodes
        server(parameter_overrides=[Parameter(name, value=-1.0)])
