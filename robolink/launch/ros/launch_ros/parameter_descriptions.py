"""Parameters as a launch file describes them (`launch_ros.parameter_descriptions`)."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import Any

from robolink.launch.ros.launch.bases import LaunchArgumentError, LaunchContext, LaunchError, SomeSubstitutionsType
from robolink.launch.ros.launch.typed_values import (
    is_normalized_substitution,
    normalize_typed_substitution,
    perform_typed_substitution,
)
from robolink.launch.ros.launch.utilities import (
    as_node_reads,
    boolean,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

__all__ = ["Parameter", "ParameterFile", "ParameterValue"]


class ParameterValue:
    """Value of a parameter, of a type.

    Args:
        value: A plain value, a list, or substitutions.
        value_type: `str`, `int`, `float`, `bool` or a list of one, `List[int]`; None reads the text of substitutions as
            YAML, and takes plain values as they are.

    Raises:
        LaunchArgumentError: for a plain value of another type.
    """

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self._given, self.value_type = normalize_typed_substitution(value, value_type), value_type
        self._evaluated: Any = None

    @property
    def value(self) -> Any:
        """The value as it was last evaluated; before, as it was given, with texts as lists of substitutions."""
        return self._given if self._evaluated is None else self._evaluated

    def __str__(self) -> str:
        return f"launch_ros.description.ParameterValue(value={self.value}, value_type={self.value_type})"

    def evaluate(self, context: LaunchContext) -> Any:
        """Return the plain value, with the values of `context`. Raises LaunchError, which is a ValueError, too."""
        self._evaluated = perform_typed_substitution(context, self._given, self.value_type)
        return self._evaluated

    def for_node(self, context: LaunchContext) -> Any:
        """Return the plain value in `context` as a node of ROS 2 gets it. Raises LaunchError."""
        found = self.evaluate(context)
        is_open = self.value_type is None and is_normalized_substitution(self._given)
        return as_node_reads(found) if is_open else found


class Parameter:
    """Parameter with its name.

    Args:
        name: Its name.
        value: Its value, as that of ParameterValue.
        value_type: Its type, as that of ParameterValue.
    """

    def __init__(self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None) -> None:
        self._name, self._evaluated = normalize_to_list_of_substitutions(name), ""
        self._value = value if isinstance(value, ParameterValue) else ParameterValue(value, value_type=value_type)

    @property
    def name(self) -> Any:
        """The name as it was last evaluated; before, as a list of substitutions."""
        return self._evaluated or self._name

    @property
    def value(self) -> Any:
        """The value, as that of ParameterValue."""
        return self._value.value

    @property
    def value_type(self) -> Any:
        """The type of the value, None for any."""
        return self._value.value_type

    def __str__(self) -> str:
        return f"launch_ros.description.Parameter(name={self.name}, value={self.value}, value_type={self.value_type})"

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        """Return its name and its plain value, with the values of `context`. Raises LaunchError."""
        self._evaluated = perform_substitutions(context, self._name)
        return self._evaluated, self._value.evaluate(context)

    def for_node(self, context: LaunchContext) -> tuple[str, Any]:
        """Return its name and its plain value in `context`, as a node of ROS 2 gets them. Raises LaunchError."""
        return self.evaluate(context)[0], self._value.for_node(context)


class ParameterFile:
    """File of parameters.

    Args:
        param_file: Its path.
        allow_substs: True performs the substitutions `$(var NAME)` in it.

    Raises:
        LaunchArgumentError: for what is not a path.
    """

    _written: Path | None = None
    """Copy of the file with the values of substitutions."""

    def __init__(
        self, param_file: SomeSubstitutionsType, *, allow_substs: bool | SomeSubstitutionsType = False
    ) -> None:
        path = os.fsdecode(param_file) if isinstance(param_file, bytes) else param_file
        try:
            self._file = normalize_to_list_of_substitutions(path)
        except LaunchArgumentError:
            kind = type(param_file).__name__
            raise LaunchArgumentError(f"a file of parameters is a path, got {kind} ({param_file!r:.60})") from None
        self._allow_substs = (
            allow_substs if isinstance(allow_substs, bool) else normalize_to_list_of_substitutions(allow_substs)
        )
        self._evaluated: Path | None = None
        self._evaluated_allow_substs: bool | None = None

    @property
    def param_file(self) -> Any:
        """The path of the file as it was last evaluated; before, as a list of substitutions."""
        return self._file if self._evaluated is None else self._evaluated

    @property
    def allow_substs(self) -> Any:
        """True if substitutions in the file are performed."""
        return self._allow_substs if self._evaluated_allow_substs is None else self._evaluated_allow_substs

    def __str__(self) -> str:
        return f"launch_ros.description.ParameterFile(param_file={self.param_file}, allow_substs={self.allow_substs})"

    def evaluate(self, context: LaunchContext) -> Path:
        """Return its path, with the values of `context`; with `allow_substs` that of a copy, which `cleanup` removes.

        Raises LaunchError, also for a file that cannot be read.
        """
        self.cleanup()
        self._evaluated = self.path(context)
        text = self.substituted(context)
        if text is not None:
            with tempfile.NamedTemporaryFile(
                "w", prefix="launch_params_", suffix=".yaml", encoding="utf-8", delete=False
            ) as file:
                file.write(text)
            self._evaluated = self._written = Path(file.name)
        return self._evaluated

    def path(self, context: LaunchContext) -> Path:
        """Return the path of the file itself, with the values of `context`."""
        return Path(perform_substitutions(context, self._file))

    def substituted(self, context: LaunchContext) -> str | None:
        """Return the file's text with the values of `context` put in; None where that is not requested.

        Raises LaunchError, also for a file that cannot be read.
        """
        self._evaluated_allow_substs = boolean(context, self._allow_substs)
        if not self._evaluated_allow_substs:
            return None
        from robolink.launch.ros.launch.frontend.parse_substitution import parse_substitution

        path = self.path(context)
        if not path.is_file():
            return None
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, ValueError) as error:
            raise LaunchError(f"{path} cannot be read: {error}") from None
        return perform_substitutions(context, parse_substitution(text))

    def cleanup(self) -> None:
        """Remove the copy of the file, if there is one."""
        if self._written is not None:
            self._written.unlink(missing_ok=True)
            self._written = self._evaluated = None

    def __del__(self) -> None:
        self.cleanup()
