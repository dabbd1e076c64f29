#!/usr/bin/env bash
# rclpy 9.1.2 with rmw_fastrtps_cpp 9.3.3 (Kilted): get_topic_names_and_types lists topics that get_publishers_info_by_topic
# and count_publishers refuse. A DDS program may name its topic `rt/front-camera` or `rt/1st`: rclpy takes `rt/` off, lists
# the rest as ROS topics with their type, and raises when its own list is handed back. So one such participant, and a
# program that counts the publishers of each listed topic gets an exception. There are two unrelated exceptions to expect:
# ValueError for a character, InvalidTopicNameException (not a ValueError) for a name of more than 247 characters.
#
# Seen with Python 3.11, Linux x86_64, cyclonedds 11.0.1 as the other program: /front-camera, /1st ValueError, 248
# characters InvalidTopicNameException. One would guess that what rclpy lists it also looks up, or that it does not list it.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/real"
"$folder/real/bin/pip" install -q --disable-pip-version-check ros-rclpy==9.1.2 ros-rmw-fastrtps-cpp==9.3.3 \
    ros-rmw-implementation==3.0.4 ros-std-msgs==5.5.1 cyclonedds==11.0.1
cat > "$folder/plain_dds.py" <<'PY'
import os
import sys
from dataclasses import dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.pub import DataWriter
from cyclonedds.topic import Topic


@dataclass
class Text(IdlStruct, typename="std_msgs::msg::dds_::String_"):
    data: str


participant = DomainParticipant(int(os.environ["ROS_DOMAIN_ID"]))
qos = Qos(Policy.DataRepresentation(use_cdrv0_representation=True))
writers = [DataWriter(participant, Topic(participant, f"rt{name}", Text), qos) for name in sys.argv[1:]]
print("ready", flush=True)
sys.stdin.read()
PY
cat > "$folder/listed.py" <<'PY'
import subprocess
import sys
import time

import rclpy
from rclpy.exceptions import InvalidTopicNameException

LONG = "/" + "a" * 247
EXPECTED = {"/chatter": None, "/front-camera": ValueError, "/1st": ValueError, LONG: InvalidTopicNameException}
other = subprocess.Popen([sys.executable, sys.argv[1], *EXPECTED], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
other.stdout.readline()
rclpy.init()
node = rclpy.create_node("lists")
end = time.monotonic() + 30
while not {*EXPECTED} <= {*dict(node.get_topic_names_and_types())} and time.monotonic() < end:
    time.sleep(0.1)


def refusal(function, name):
    """Return the type of the exception that a look-up raises, None for none."""
    try:
        function(name)
    except Exception as error:
        return type(error)
    return None


listed = dict(node.get_topic_names_and_types())
lookups = node.get_publishers_info_by_topic, node.count_publishers
found = {name: [refusal(each, name) for each in lookups] for name in EXPECTED}
other.stdin.close()
other.wait(10)
for name, types in found.items():
    print(f"{name[:20]} ({len(name)}): listed as {listed.get(name)}, look-ups {[each and each.__name__ for each in types]}")
assert {*EXPECTED} <= {*listed}, "such topics are not listed any more"
assert found == {name: [each, each] for name, each in EXPECTED.items()}, "listed topics are looked up otherwise now"
assert not issubclass(InvalidTopicNameException, ValueError), "one exception covers both now"
PY
cat > "$folder/cyclone.xml" <<'XML'
<CycloneDDS><Domain>
  <General><Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces></General>
  <Discovery><ParticipantIndex>auto</ParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>
XML
CYCLONEDDS_URI="file://$folder/cyclone.xml" ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID="${ROS_DOMAIN_ID:-77}" \
    timeout -s KILL 60 "$folder/real/bin/python" "$folder/listed.py" "$folder/plain_dds.py"
