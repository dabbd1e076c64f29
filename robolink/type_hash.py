"""Hash of a message type (RIHS), as rclpy shows it."""

from __future__ import annotations

from typing import Any, TypedDict

_SIZE = 32
_PREFIX = "RIHS"


class TypeHashDictionary(TypedDict):
    """Keyword arguments of a TypeHash, `version` and `value`."""

    version: int
    value: bytes


class TypeHash:
    """Hash of a message type: `version` of ROS 2's hashing, -1 for no hash, and `value`, 32 bytes."""

    __slots__ = ("_value", "_version")

    def __init__(self, version: int = -1, value: bytes = bytes(_SIZE)) -> None:
        self.version = version
        self.value = value

    @classmethod
    def from_text(cls, text: str) -> TypeHash:
        """Return the hash of `text` such as `RIHS01_df66…`; for what is not a hash, as Humble's, one of version -1."""
        version, _, digits = text.removeprefix(_PREFIX).partition("_")
        try:
            return cls(int(version), bytes.fromhex(digits))
        except ValueError:
            return cls()

    @property
    def version(self) -> int:
        """Version of the hashing; 1 is the only one so far."""
        return self._version

    @version.setter
    def version(self, value: int) -> None:
        self._version: int = _checked("version", value, int)

    @property
    def value(self) -> bytes:
        """Bytes of the hash, 32 of them."""
        return self._value

    @value.setter
    def value(self, value: bytes) -> None:
        self._value: bytes = _checked("value", value, bytes)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, TypeHash) and (self.version, self.value) == (other.version, other.value)

    def __hash__(self) -> int:
        return hash((self.version, self.value))

    def __str__(self) -> str:
        if self.version <= 0 or len(self.value) != _SIZE:
            return "INVALID"
        return f"{_PREFIX}{self.version:02}_{self.value.hex()}"

    def __repr__(self) -> str:
        return f"TypeHash({self.version}, {self.value!r})"


def _checked(name: str, value: Any, kind: type) -> Any:
    assert isinstance(value, kind), f"a type hash's {name} must be of type {kind.__name__}, got {value!r}"
    return value
