#!/usr/bin/env bash
# rcl 10.1.3 (rclpy 9.1.2, Kilted): of two values that a command line gives a parameter, the last one wins, but only if both
# are of one type. `-p a:=1 -p a:=2` is 2; `-p a:=1 -p a:=text` and `-p a:=1 -p a:=1.5` stay 1, and `-p a:=true -p a:=5`
# stays true, with no word about it. Both values are kept, and the first of boolean, integer, double, string is taken.
# The same with parameter files: a launch file's text does not replace the integer of an earlier file.
#
# Seen with Python 3.11, Linux x86_64. One would guess that the last value wins, or that the mixture is refused.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/real"
"$folder/real/bin/pip" install -q --disable-pip-version-check ros-rclpy==9.1.2 ros-rmw-fastrtps-cpp==9.3.3 \
    ros-rmw-implementation==3.0.4
cat > "$folder/shown.py" <<'PY'
import rclpy

rclpy.init()
node = rclpy.create_node("shown", automatically_declare_parameters_from_overrides=True)
print(node.get_parameter("a").value)
PY

# Print the value that a node has after two overrides of one parameter.
value() {
    ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID=97 timeout -s KILL 60 \
        "$folder/real/bin/python" "$folder/shown.py" --ros-args -p "a:=$1" -p "a:=$2"
}

for case in "1 2 2" "1 text 1" "text 1 1" "1 1.5 1" "true 5 True"; do
    read -r first second expected <<< "$case"
    seen=$(value "$first" "$second")
    echo "-p a:=$first -p a:=$second: $seen"
    [ "$seen" = "$expected" ] || { echo "expected $expected: rcl has changed"; exit 1; }
done
