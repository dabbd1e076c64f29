"""The action of tf2_msgs: waiting for a transform."""

from robolink.interfaces.builtin_interfaces.msg import Duration, Time
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.tf2_msgs.msg import TF2Error
from robolink.message import Action, Message, string


class LookupTransform(Action):
    """Ask a buffer server for the transform between two frames, and wait until it is known."""

    class Goal(Message):
        """Which transform: one that takes what is given in `source_frame` to `target_frame`.

        It is that of `source_time`, where zero is the latest, and is waited for `timeout` at most. If `advanced`, the
        transform leads from the source frame at `source_time` to the target frame at `target_time`, by way of
        `fixed_frame`, which does not change in between.
        """

        target_frame: string
        source_frame: string
        source_time: Time
        timeout: Duration
        target_time: Time
        fixed_frame: string
        advanced: bool

    class Result(Message):
        """The transform, which only counts when `error` is NO_ERROR."""

        transform: TransformStamped
        error: TF2Error

    class Feedback(Message):
        """Nothing."""
