"""The services of topic_tools_interfaces: the choice of topics to pass on."""

from robolink.message import Message, Sequence, Service, string


class MuxAdd(Service):
    """Add a topic to choose from."""

    class Request(Message):
        """The topic's name."""

        topic: string

    class Response(Message):
        """Success."""

        success: bool


class MuxDelete(Service):
    """Remove a topic from those to choose from."""

    class Request(Message):
        """The topic's name."""

        topic: string

    class Response(Message):
        """Success."""

        success: bool


class MuxList(Service):
    """List the topics to choose from."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Names of the topics."""

        topics: Sequence[string]


class MuxSelect(Service):
    """Choose the topic whose messages are passed on."""

    class Request(Message):
        """The topic; `__none` for none."""

        topic: string

    class Response(Message):
        """The topic chosen before, and success."""

        prev_topic: string
        success: bool


class DemuxAdd(Service):
    """Add a topic that messages may be passed on to."""

    class Request(Message):
        """The topic's name."""

        topic: string

    class Response(Message):
        """Success."""

        success: bool


class DemuxDelete(Service):
    """Remove a topic that messages may be passed on to."""

    class Request(Message):
        """The topic's name."""

        topic: string

    class Response(Message):
        """Success."""

        success: bool


class DemuxList(Service):
    """List the topics that messages may be passed on to."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Names of the topics."""

        topics: Sequence[string]


class DemuxSelect(Service):
    """Choose the topic that messages are passed on to."""

    class Request(Message):
        """The topic; `__none` for none."""

        topic: string

    class Response(Message):
        """The topic chosen before, and success."""

        prev_topic: string
        success: bool
