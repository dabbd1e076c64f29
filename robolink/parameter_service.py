"""The six services by which others read, set and describe a node's parameters."""

from __future__ import annotations

import functools
import weakref
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from robolink.exceptions import ExternalShutdownException, ParameterUninitializedException, nearest
from robolink.interfaces.rcl_interfaces.msg import ListParametersResult, SetParametersResult
from robolink.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from robolink.node_parts.request_limit import Refusal, look_at, no_room
from robolink.parameter import Parameter
from robolink.qos import qos_profile_parameters
from robolink.system.terminal import shown

if TYPE_CHECKING:
    from robolink.interfaces.rcl_interfaces import srv
    from robolink.node_parts.ports import ParameterNode

    Get: TypeAlias = srv.GetParameters
    GetTypes: TypeAlias = srv.GetParameterTypes
    List: TypeAlias = srv.ListParameters
    Set: TypeAlias = srv.SetParameters
    SetAtomically: TypeAlias = srv.SetParametersAtomically
    Describe: TypeAlias = srv.DescribeParameters

MOST_HINTS = 10
"""Most unknown names of one request for which the nearest known one is looked up."""


class ParameterService:
    """Server of the parameters of `node`: `~/get_parameters`, `~/set_parameters` and four more services.

    One name that is not declared, or has no value yet, empties the whole answer of those that ask by name, as in rclpy.
    What cannot be set is answered with the reason. So is an exception in a callback of the node's, which is logged
    too: a request never ends the node. One that is too large (`request_limit`) is answered unread.
    """

    def __init__(self, node: ParameterNode) -> None:
        from robolink.interfaces.rcl_interfaces import srv  # late: it takes a millisecond

        self._node = weakref.ref(node)  # the transport holds the services: they must not keep the node alive
        services: list[tuple[str, type[Any], Callable[[Any, Any], Any], Refusal]] = [
            ("describe_parameters", srv.DescribeParameters, self._describe, no_room),
            ("get_parameters", srv.GetParameters, self._get, no_room),
            ("get_parameter_types", srv.GetParameterTypes, self._get_types, no_room),
            ("list_parameters", srv.ListParameters, self._list, no_room),
            ("set_parameters", srv.SetParameters, self._set_each, _refused_once),
            ("set_parameters_atomically", srv.SetParametersAtomically, self._set_all, _refused_all),
        ]
        own = node.get_name()
        for name, srv_type, answer, refusal in services:
            service = node.create_service(srv_type, f"{own}/{name}", answer, qos_profile=qos_profile_parameters)
            service.look_first = functools.partial(look_at, srv_type, refusal)

    def _alive(self) -> ParameterNode:
        node = self._node()
        if node is None:
            raise ReferenceError("the node of these parameters is gone")
        return node

    def _has_all(self, names: Sequence[str]) -> bool:
        """True if all may be read. Reading would raise, but with the nearest name, which takes its time."""
        node = self._alive()
        return node._allow_undeclared_parameters or all(node.has_parameter(each) for each in names)

    def _describe(self, request: Describe.Request, response: Describe.Response) -> Describe.Response:
        if self._has_all(request.names):
            response.descriptors = self._alive().describe_parameters(list(request.names))
        return response

    def _get(self, request: Get.Request, response: Get.Response) -> Get.Response:
        try:
            if self._has_all(request.names):
                found = self._alive().get_parameters(list(request.names))
                response.values = [each.get_parameter_value() for each in found]
        except ParameterUninitializedException:
            pass
        return response

    def _get_types(self, request: GetTypes.Request, response: GetTypes.Response) -> GetTypes.Response:
        if self._has_all(request.names):
            response.types = [each.value for each in self._alive().get_parameter_types(list(request.names))]
        return response

    def _list(self, request: List.Request, response: List.Response) -> List.Response:
        try:
            response.result = self._alive().list_parameters(list(request.prefixes), request.depth)
        except (TypeError, ValueError):
            response.result = ListParametersResult()
        return response

    def _set_each(self, request: Set.Request, response: Set.Response) -> Set.Response:
        unknown = 0
        for each in request.parameters:
            unknown += not self._alive().has_parameter(each.name)
            response.results.append(self._set([each], hint=unknown <= MOST_HINTS))
        return response

    def _set_all(self, request: SetAtomically.Request, response: SetAtomically.Response) -> SetAtomically.Response:
        response.result = self._set(request.parameters, hint=True)
        return response

    def _set(self, messages: Sequence[ParameterMsg], *, hint: bool) -> SetParametersResult:
        node = self._alive()
        try:
            parameters: list[Parameter[Any]] = [Parameter.from_parameter_msg(each) for each in messages]
        except ValueError as error:
            return _refused(shown(str(error), 200))
        problem = self._problem([each.name for each in messages], hint)
        if problem:
            return _refused(problem)
        try:
            result = node.set_parameters_atomically(parameters)
            return SetParametersResult(successful=bool(result.successful), reason=str(result.reason))
        except ExternalShutdownException:
            raise
        except Exception as error:  # noqa: BLE001 - a callback of the user's that this value is too much for
            return _failed(node, parameters, error)

    def _problem(self, names: Sequence[str], hint: bool) -> str:
        """Return which of these cannot be set, by its name alone; nothing if all can be."""
        node = self._alive()
        if node._pre_set_parameters_callbacks:  # they may put others in their place
            return ""
        if "" in names:
            return "a parameter's name must not be empty"
        if node._allow_undeclared_parameters:
            return ""
        missing = next((each for each in names if not node.has_parameter(each)), None)
        if missing is None:
            return ""
        near = nearest(missing, node.get_parameters_by_prefix("")) if hint else ""
        return f"Parameter not declared: {shown(missing)}{near}"


def _refused_once(reason: str) -> dict[str, Any]:
    """Return a single result, however many were asked for."""
    return {"results": [_refused(reason)]}


def _refused_all(reason: str) -> dict[str, Any]:
    return {"result": _refused(reason)}


def _refused(reason: str) -> SetParametersResult:
    return SetParametersResult(successful=False, reason=reason)


def _failed(node: ParameterNode, parameters: Sequence[Parameter[Any]], error: Exception) -> SetParametersResult:
    """Answer for an exception while parameters were set; where it came after that, they stay set."""
    from robolink.text.tracebacks import formatted  # late: few callbacks fail

    text = shown(f"{type(error).__name__}: {error}", 200)
    node.get_logger().error(f"a request to set parameters failed:\n{formatted(error)}")
    is_set = all(node.get_parameter_or(each.name) is each for each in parameters)
    where = "it was set, and then a callback of the node's failed" if is_set else "a callback of the node's failed"
    return SetParametersResult(successful=is_set, reason=f"{where}: {text}")
