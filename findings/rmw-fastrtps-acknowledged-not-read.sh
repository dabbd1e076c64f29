#!/usr/bin/env bash
# rmw_fastrtps_cpp 9.3.3 with Fast DDS 3.2.3 (Kilted): of the announcements of endpoints (SEDP) of two participants that
# send no source timestamps (INFO_TS is optional in RTPS) it acknowledges one and never reads it, if both participants
# lost their first one: the endpoint stays unknown. What waits for an earlier sample is in one list for all participants,
# sorted by number within a writer and by timestamp among writers; a repaired sample comes behind the later ones there,
# and is passed over. With timestamps it is read. (Jazzy: the same.)
#
# Seen with Python 3.11, Linux x86_64: with timestamps 2 subscriptions to the first topic and 2 to the second; without 0
# and 2, though all was acknowledged. One would guess that a reliable reader reads what it acknowledges.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/real"
"$folder/real/bin/pip" install -q --disable-pip-version-check ros-rclpy==9.1.2 ros-rmw-fastrtps-cpp==9.3.3 \
    ros-rmw-implementation==3.0.4 ros-std-msgs==5.5.1
cat > "$folder/two.py" <<'PY'
import os
import socket
import struct
import time

import rclpy

DOMAIN = int(os.environ["ROS_DOMAIN_ID"])
PARTICIPANT, SPDP_WRITER, WRITER, READER = (bytes.fromhex(each) for each in ("000001c1", "000100c2", "000004c2", "000004c7"))
ANNOUNCERS = 0x1 | 0x10  # of participants, and of readers: RTPS 2.5, 9.3.2


def submessage(kind, flags, body):
    return struct.pack("<BBH", kind, flags, len(body)) + body


def parameter(kind, value):
    value += bytes(-len(value) % 4)
    return struct.pack("<HH", kind, len(value)) + value


def text(value):
    return struct.pack("<I", len(value) + 1) + value.encode() + b"\0"


def data(writer, reader, number, *parameters):
    body = struct.pack("<HH", 0, 16) + reader + writer + struct.pack("<iI", 0, number)
    return submessage(0x15, 0x05, body + b"\0\3\0\0" + b"".join(parameters) + b"\1\0\0\0")


class Participant:
    """One with two readers, of /stamped1 and /stamped2 or /bare1 and /bare2, that says what it is told to."""

    def __init__(self, number, stamped):
        self.socket = socket.socket(type=socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(0.2)
        self.prefix, self.stamped = b"\1\x99" + os.urandom(9) + bytes([number]), stamped
        self.word = "stamped" if stamped else "bare"
        self.address = struct.pack("<iI", 1, self.socket.getsockname()[1]) + bytes(12) + socket.inet_aton("127.0.0.1")
        self.peer, self.acknowledged, self.beats = None, 0, 0

    def send(self, *submessages):
        raw = b"RTPS\2\3\1\x99" + self.prefix + b"".join(submessages)
        for port in [self.peer] if self.peer else [7410 + 250 * DOMAIN + 2 * index for index in range(4)]:
            self.socket.sendto(raw, ("127.0.0.1", port))

    def announce(self):
        """Announce itself."""
        self.send(data(SPDP_WRITER, bytes(4), 1, parameter(0x15, b"\2\3"), parameter(0x16, b"\1\x99"),
                       parameter(0x50, self.prefix + PARTICIPANT), parameter(0x32, self.address),
                       parameter(0x31, self.address), parameter(0x02, struct.pack("<iI", 100, 0)),
                       parameter(0x58, struct.pack("<I", ANNOUNCERS))))

    def tell(self, number):
        """Announce its reader of this number, 1 or 2; each always has the same timestamp."""
        stamp = submessage(0x09, 0x01, struct.pack("<II", 1_700_000_000 + number, 0)) if self.stamped else b""
        guid = self.prefix + bytes([0, 0, number, 4])
        self.send(stamp, data(WRITER, READER, number, parameter(0x5A, guid), parameter(0x50, self.prefix + PARTICIPANT),
                              parameter(0x05, text(f"rt/{self.word}{number}")),
                              parameter(0x07, text("std_msgs::msg::dds_::String_")),
                              parameter(0x1A, struct.pack("<IiI", 2, 0, 0)), parameter(0x2F, self.address)))

    def until(self, acknowledged, act):
        """Repeat an act until all before a number is acknowledged."""
        end = time.monotonic() + 20
        while self.acknowledged < acknowledged:
            assert time.monotonic() < end, f"not acknowledged before {acknowledged}"
            act()
            try:
                while self.acknowledged < acknowledged:
                    self.hear(self.socket.recv(65536))
            except TimeoutError:
                pass

    def beat(self):
        """Say that it has told 1 and 2, and request an acknowledgement."""
        self.beats += 1
        self.send(submessage(0x07, 0x01, READER + WRITER + struct.pack("<iIiIi", 0, 1, 0, 2, self.beats)))

    def hear(self, raw):
        at = 20
        while at + 4 <= len(raw):
            kind, flags, size = struct.unpack_from("<BBH", raw, at)
            if kind == 0x06 and raw[at + 8 : at + 12] == WRITER:
                self.acknowledged = max(struct.unpack_from("<iI", raw, at + 12)[1], 1)
            at += 4 + size


def counts(node, stamped):
    """Return how many subscriptions the node knows to the two topics, of two participants that lost the first ones."""
    both = [Participant(number, stamped) for number in (1, 2)]
    for each in both:
        each.until(1, each.announce)  # asked for what it has: it has been met
    for each in both:
        each.tell(2)
    for each in both:
        each.acknowledged = 0
        each.until(1, each.beat)
    for each in both:
        each.until(3, lambda: (each.tell(1), each.beat()))
    names = [f"/{both[0].word}{number}" for number in (1, 2)]
    end = time.monotonic() + 5
    while time.monotonic() < end and node.count_subscribers(names[0]) < 2:
        time.sleep(0.1)
    return [node.count_subscribers(name) for name in names]


rclpy.init()
node = rclpy.create_node("watcher")
stamped, bare = counts(node, True), counts(node, False)
print(f"with timestamps: {stamped[0]} first and {stamped[1]} second ones; without: {bare[0]} and {bare[1]}")
assert stamped == [2, 2], "with timestamps the announcements are no longer read"
assert bare == [0, 2], "without timestamps all that is acknowledged is read now"
PY
ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID="${ROS_DOMAIN_ID:-77}" timeout -s KILL 90 \
    "$folder/real/bin/python" "$folder/two.py"
