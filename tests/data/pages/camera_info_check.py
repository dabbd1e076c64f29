

from robolink.interfaces.sensor_msgs.msg import CameraInfo

numbers = [100.0, 0.0, 50.0, 0.0, 0.0, 100.0, 40.0, 0.0, 0.0, 0.0, 1.0, 0.0]
on_camera_info(CameraInfo(width=100, height=80, k=[*numbers[:3], *numbers[4:7], *numbers[8:11]], p=numbers))
assert camera.project3dToPixel((0.1, 0.0, 2.0)) == (55.0, 40.0)
