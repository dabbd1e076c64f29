"""The services of turtlebot3_msgs: sounds, and a robot that learns to reach goals."""

from robolink.message import Message, Sequence, Service, float32, string, uint8


class Sound(Service):
    """Make a sound."""

    class Request(Message):
        """The number of the sound, as in the message Sound."""

        value: uint8

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        message: string


class Goal(Service):
    """Choose the next goal of the learning robot."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """The goal's place in metres, and whether there is one."""

        pose_x: float32
        pose_y: float32
        success: bool


class Dqn(Service):
    """Take one step of the learning robot."""

    class Request(Message):
        """Number of the action to take; `init` begins anew."""

        action: uint8
        init: bool

    class Response(Message):
        """State that the robot is in, the reward for the step, and whether the episode is over."""

        state: Sequence[float32]
        reward: float32
        done: bool
