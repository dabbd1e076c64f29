"""The service of tf2_msgs: the tree of frames as text."""

from robolink.message import Message, Service, string


class FrameGraph(Service):
    """Ask a transform buffer for all frames that it knows."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """The frames as YAML: a mapping of each frame to its parent and what is known of the link."""

        frame_yaml: string
