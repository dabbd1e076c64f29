from robolink.interfaces.sensor_msgs.msg import LaserScan


def test_it_stops_before_what_is_near(system, program):
    system.start(program)
    system.publish("scan", LaserScan(ranges=[3.0, 2.0, 3.0]))
    assert system.expect("cmd_vel").linear.x == 0.3
    system.publish("scan", LaserScan(ranges=[3.0, 0.2, 3.0]))
    assert system.expect("cmd_vel").linear.x == 0.0
