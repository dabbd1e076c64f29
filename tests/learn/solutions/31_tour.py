import rclpy
from geometry_msgs.msg import PoseStamped
from nav2_simple_commander.robot_navigator import BasicNavigator, TaskResult

PLACES = [(2.0, 1.0), (5.0, 3.0), (1.0, 4.0)]


def pose_at(x, y):
    pose = PoseStamped()
    pose.header.frame_id = "map"
    pose.pose.position.x = x
    pose.pose.position.y = y
    pose.pose.orientation.w = 1.0
    return pose


def main():
    rclpy.init()
    navigator = BasicNavigator()
    reached = 0
    for x, y in PLACES:
        navigator.goToPose(pose_at(x, y))
        while not navigator.isTaskComplete():
            pass
        if navigator.getResult() == TaskResult.SUCCEEDED:
            reached += 1
    navigator.get_logger().info(f"reached {reached} of {len(PLACES)}")
    rclpy.shutdown()


if __name__ == "__main__":
    main()
