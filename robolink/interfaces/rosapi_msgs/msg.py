"""The message of rosapi_msgs: the definition of a type."""

from robolink.message import Message, Sequence, int32, string


class TypeDef(Message):
    """Definition of a message type: names, types and example values of its fields, and its constants.

    The length of a field is -1 for a single value, 0 for a sequence, and the size of a fixed array.
    """

    type: string
    fieldnames: Sequence[string]
    fieldtypes: Sequence[string]
    fieldarraylen: Sequence[int32]
    examples: Sequence[string]
    constnames: Sequence[string]
    constvalues: Sequence[string]
