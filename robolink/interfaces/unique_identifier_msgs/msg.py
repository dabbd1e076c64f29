"""The message of unique_identifier_msgs: an identifier that no other thing has."""

from typing import Annotated

from robolink.message import Message, Sequence, Size, uint8


class UUID(Message):
    """The 16 bytes of an RFC 4122 UUID, in the order in which its text has them: ``UUID(uuid=uuid4().bytes)``."""

    uuid: Annotated[Sequence[uint8], Size(16)]
