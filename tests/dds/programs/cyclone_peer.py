"""A program of Cyclone DDS, without ROS 2: it hears topics as ROS 2 names them, and sends each message on.

It prints lines of JSON as peer.py does; what it sends on is on the topic of the same name with _back behind it. It
ends with its input.
"""

import json
import os
import sys
import threading
import time
from dataclasses import dataclass

HERE = """<CycloneDDS><Domain Id="any"><General><Interfaces><NetworkInterface name="lo" multicast="true"/></Interfaces>
<AllowMulticast>spdp</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>
<MaxAutoParticipantIndex>31</MaxAutoParticipantIndex></Discovery></Domain></CycloneDDS>"""
# With an index it has a port at which nodes look that keep to this machine.
os.environ["CYCLONEDDS_URI"] = HERE

from cyclonedds.core import Listener, Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import float64, sequence, uint8, uint32
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic


@dataclass
class Text(IdlStruct, typename="std_msgs::msg::dds_::String_"):
    data: str


@dataclass
class Vector3(IdlStruct, typename="geometry_msgs::msg::dds_::Vector3_"):
    x: float64
    y: float64
    z: float64


@dataclass
class Twist(IdlStruct, typename="geometry_msgs::msg::dds_::Twist_"):
    linear: Vector3
    angular: Vector3


@dataclass
class Dimension(IdlStruct, typename="std_msgs::msg::dds_::MultiArrayDimension_"):
    label: str
    size: uint32
    stride: uint32


@dataclass
class Layout(IdlStruct, typename="std_msgs::msg::dds_::MultiArrayLayout_"):
    dim: sequence[Dimension]
    data_offset: uint32


@dataclass
class Bytes(IdlStruct, typename="std_msgs::msg::dds_::UInt8MultiArray_"):
    layout: Layout
    data: sequence[uint8]


TOPICS = {"text": Text, "twist": Twist, "bytes": Bytes}


def emit(**said):
    sys.stdout.write(json.dumps(said) + "\n")
    sys.stdout.flush()


def main():
    participant = DomainParticipant(int(os.environ["ROS_DOMAIN_ID"]))
    reliable = Qos(Policy.Reliability.Reliable(1_000_000_000), Policy.History.KeepLast(10))
    latched = reliable + Qos(Policy.Durability.TransientLocal)
    kept = DataWriter(participant, Topic(participant, "rt/lab/kept", Text, qos=latched), qos=latched)
    kept.write(Text("kept by Cyclone"))
    readers, readable = [], threading.Condition()

    class Wakes(Listener):
        def __init__(self, name):
            super().__init__()
            self.name = name

        def on_data_available(self, reader):
            with readable:
                readable.notify()

        def on_subscription_matched(self, reader, status):
            emit(event=f"{self.name} hears", count=status.current_count)

        def on_publication_matched(self, writer, status):
            emit(event=f"{self.name} is heard", count=status.current_count)

    for name, kind in TOPICS.items():
        back, topic = (Topic(participant, f"rt/lab/{name}{end}", kind, qos=reliable) for end in ("_back", ""))
        writer = DataWriter(participant, back, qos=reliable, listener=Wakes(name))
        readers.append((name, DataReader(participant, topic, qos=reliable, listener=Wakes(name)), writer))
    emit(event="ready", at=time.monotonic())
    while True:
        for name, reader, writer in readers:
            for message in (each for each in reader.take(10) if isinstance(each, TOPICS[name])):  # not of a goodbye
                writer.write(message)
                emit(event=name, at=time.monotonic())
        with readable:
            readable.wait(0.02)


if __name__ == "__main__":
    threading.Thread(target=main, daemon=True).start()
    sys.stdin.read()
    os._exit(0)
