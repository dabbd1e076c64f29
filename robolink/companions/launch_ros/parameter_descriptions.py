"""Parameters of nodes in launch files: typed values and files (`launch_ros.parameter_descriptions`)."""

from __future__ import annotations

import os
import typing
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from robolink.companions.launch.bases import LaunchContext, LaunchError, SomeSubstitutionsType, Substitution
from robolink.companions.launch.utilities import (
    FALSE,
    TRUE,
    LaunchArgumentError,
    is_substitution,
    is_true,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    performed,
    typed,
)
from robolink.system.terminal import shown

__all__ = [
    "Parameter",
    "ParameterFile",
    "ParameterValue",
]

_PLAIN = (bool, int, float, str, bytes)


class ParameterValue:
    """Value of a parameter, of a type.

    Args:
        value: A plain value, a list, or substitutions.
        value_type: `str`, `int`, `float`, `bool` or a list of one, `List[int]`; None reads the text as YAML.
    """

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value, self.value_type = value, value_type

    def evaluate(self, context: LaunchContext) -> Any:
        """Return the plain value, with the values of `context`. Raises LaunchError."""
        if isinstance(self.value, (list, tuple)) and not is_substitution(self.value):
            return [self._one(context, each, typing.get_args(self.value_type)[:1]) for each in self.value]
        return self._one(context, self.value, (self.value_type,))

    def _one(self, context: LaunchContext, value: Any, type_: Sequence[Any]) -> Any:
        wanted = type_[0] if type_ else None
        if is_substitution(value) or isinstance(value, (str, os.PathLike)):
            return coerced(performed(context, value), wanted)
        return value if wanted is None else coerced(str(value), wanted)


def coerced(text: str, wanted: Any) -> Any:
    """Return `text` as a value of the type `wanted`, None for whatever YAML reads. Raises LaunchError."""
    if wanted is None:
        return typed(text)
    if wanted is str:
        return text
    if typing.get_origin(wanted) in (list, Sequence) or wanted is list:
        inner = typing.get_args(wanted)[:1]
        value = typed(text)
        if not isinstance(value, (list, tuple)):
            raise LaunchError(f"expected a list, got '{shown(text)}'")
        return [each if not inner else coerced(str(each), inner[0]) for each in value]
    try:
        if wanted is bool:
            return {**dict.fromkeys(TRUE, True), **dict.fromkeys(FALSE, False)}[text.strip().lower()]
        return {int: int, float: float}[wanted](text)
    except KeyError:
        if wanted is bool:
            raise LaunchError(f"expected true or false, got '{shown(text)}'") from None
        raise LaunchArgumentError(f"value_type is str, int, float, bool or a list of one, got {wanted}") from None
    except ValueError:
        raise LaunchError(f"expected {wanted.__name__}, got '{shown(text)}'") from None


class Parameter:
    """Parameter with its name.

    Args:
        name: Its name.
        value: Its value, as that of ParameterValue.
        value_type: Its type, as that of ParameterValue.
    """

    def __init__(self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self.parameter_value = (
            value if isinstance(value, ParameterValue) else ParameterValue(value, value_type=value_type)
        )

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        """Return its name and its plain value, with the values of `context`."""
        return perform_substitutions(context, self.name), self.parameter_value.evaluate(context)


class ParameterFile:
    """File of parameters.

    Args:
        param_file: Its path.
        allow_substs: True performs the substitutions `$(var NAME)` in it.
    """

    def __init__(
        self, param_file: SomeSubstitutionsType, *, allow_substs: bool | SomeSubstitutionsType = False
    ) -> None:
        self.param_file, self.allow_substs = normalize_to_list_of_substitutions(param_file), allow_substs

    def evaluate(self, context: LaunchContext) -> Path:
        """Return its path, with the values of `context`."""
        return Path(perform_substitutions(context, self.param_file))

    def substituted(self, context: LaunchContext) -> str | None:
        """Return the file's text with the values of `context` put in; None where that is not wanted.

        Raises LaunchError, also for a file that cannot be read.
        """
        if not is_true(context, self.allow_substs):
            return None
        from robolink.companions.launch.frontend import parse_substitution

        path = self.evaluate(context)
        if not path.is_file():
            return None
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, ValueError) as error:
            raise LaunchError(f"{path} cannot be read: {error}") from None
        return perform_substitutions(context, parse_substitution(text))


def evaluated(parameters: Mapping[Any, Any], context: LaunchContext) -> Iterator[tuple[str, Any]]:
    """Yield the name and the plain value of each parameter of a mapping, nested names joined by dots.

    Args:
        parameters: Values by name: plain ones, lists, substitutions, or mappings of these.
        context: The context with whose values they are performed.
    """
    for key, value in parameters.items():
        name = performed(context, key)
        if isinstance(value, Mapping):
            yield from ((f"{name}.{inner}", each) for inner, each in evaluated(value, context))
            continue
        try:
            yield name, plain(value, context)
        except LaunchError as error:
            raise type(error)(f"parameter '{shown(name)}': {error}") from None


def plain(value: Any, context: LaunchContext) -> Any:
    """Return the plain value of a parameter, `value`, with the values of `context`.

    A text stays one. Substitutions are performed and read as YAML, also a list of them and texts, which is joined; a
    list of lists is a list of such texts.
    """
    if isinstance(value, ParameterValue):
        return value.evaluate(context)
    if isinstance(value, Substitution) or is_substitution(value):
        return typed(performed(context, value))
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, _PLAIN):
        return value
    if isinstance(value, Sequence):
        return _uniform([plain(each, context) for each in value])
    if hasattr(value, "tolist"):  # numpy's
        return value.tolist()
    raise LaunchArgumentError(f"a parameter is a plain value, a list or substitutions, got {type(value).__name__}")


def _uniform(values: list[Any]) -> list[Any]:
    kinds = {type(each) for each in values}
    convert: Callable[[Any], Any] | None = float if kinds == {int, float} else None
    return values if convert is None else [convert(each) for each in values]
