import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    share = get_package_share_directory('my_robot')
    config = os.path.join(share, 'config', 'robot.yaml')
    with open(os.path.join(share, 'urdf', 'robot.urdf')) as file:
        model = file.read()

    return LaunchDescription([
        DeclareLaunchArgument('speed', default_value='1.0', description='First speed, in rad/s.'),
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{'robot_description': model}]),
        Node(package='my_robot', executable='wheel_driver.py', name='wheel_driver',
             parameters=[config, {'speed': LaunchConfiguration('speed')}]),
        Node(package='my_robot', executable='wheel_watcher.py', name='wheel_watcher', parameters=[config]),
    ])
