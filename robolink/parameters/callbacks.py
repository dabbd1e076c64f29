"""Callbacks of a node's parameters: before they are set, on setting them, and afterwards."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, TypeAlias

from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.parameter import Parameter

Parameters: TypeAlias = list[Parameter[Any]]
PreSetCallback: TypeAlias = Callable[[Parameters], Parameters]
OnSetCallback: TypeAlias = Callable[[Parameters], SetParametersResult]
PostSetCallback: TypeAlias = Callable[[Parameters], None]


class ParameterCallbacks:
    """The part of a node that keeps the callbacks of its parameters."""

    def _init_parameter_callbacks_(self) -> None:
        self._pre_set_parameters_callbacks: list[PreSetCallback] = []
        self._on_set_parameters_callbacks: list[OnSetCallback] = []
        self._post_set_parameters_callbacks: list[PostSetCallback] = []

    def add_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Add a `callback` that returns the list of parameters to set in place of the given one, before all checks.

        The latest added is called first; their lists are joined. Declaring does not call it.
        """
        self._pre_set_parameters_callbacks.insert(0, callback)

    def add_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Add a `callback` that decides if parameters may be set or declared; the latest added is called first.

        It gets the list of parameters and returns a SetParametersResult, which refuses them by `successful=False` with
        the reason. Names that it does not know it should let pass: other parts of the node may know them.
        """
        self._on_set_parameters_callbacks.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Add a `callback` for parameters that have been set or declared; the latest added is called first."""
        self._post_set_parameters_callbacks.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Remove a `callback`. Raises ValueError if it was not added."""
        self._pre_set_parameters_callbacks.remove(callback)

    def remove_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Remove a `callback`. Raises ValueError if it was not added."""
        self._on_set_parameters_callbacks.remove(callback)

    def remove_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Remove a `callback`. Raises ValueError if it was not added."""
        self._post_set_parameters_callbacks.remove(callback)


def listed(callback: PreSetCallback, given: Any) -> Parameters:
    """Return the result of a pre-set callback as a list. Raises TypeError, naming the callback, for what is none."""
    if isinstance(given, Iterable):
        return list(given)
    raise TypeError(f"pre-set callback {callback!r} must return a list of parameters, got {given!r:.80}")
