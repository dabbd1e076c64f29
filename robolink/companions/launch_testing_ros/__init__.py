"""launch_testing_ros: helpers of launch tests that speak to nodes."""

from robolink.companions.launch_testing_ros import tools
from robolink.companions.launch_testing_ros.data_republisher import DataRepublisher
from robolink.companions.launch_testing_ros.message_pump import MessagePump
from robolink.companions.launch_testing_ros.wait_for_topics import WaitForTopics

__all__ = ["DataRepublisher", "MessagePump", "WaitForTopics", "tools"]
