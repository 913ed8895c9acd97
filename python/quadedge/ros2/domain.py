"""Topics of ROS 2 as what they are: topics of DDS. Needs cyclonedds and rosbags.

A topic /a of pkg/msg/T is the topic rt/a of the type pkg::msg::dds_::T_ with the CDR that rosbags reads and writes.
"""

import os
from functools import cache

from ..errors import UsageError
from ..ros_messages import message_store

try:
    from cyclonedds import idl
    from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsPublication
    from cyclonedds.core import (DDSException, InstanceState, Policy, Qos, ReadCondition, SampleState, ViewState,
                                 WaitSet)
    from cyclonedds.domain import Domain as DdsDomain
    from cyclonedds.domain import DomainParticipant
    from cyclonedds.idl import types as idl_types
    from cyclonedds.internal import InvalidSample
    from cyclonedds.pub import DataWriter
    from cyclonedds.sub import DataReader
    from cyclonedds.topic import Topic
except ImportError as error:
    raise ImportError("quadedge.ros2 needs cyclonedds; `pip install cyclonedds rosbags` installs it") from error

BASES = {"bool": bool, "byte": idl_types.byte, "char": idl_types.uint8, "float32": idl_types.float32,
          "float64": idl_types.float64, "string": str,
          **{f"{sign}int{bits}": getattr(idl_types, f"{sign}int{bits}") for sign in ("", "u")
             for bits in (8, 16, 32, 64)}}  # fmt: skip
_LOOPBACK = "<General><Interfaces><NetworkInterface name='lo'/></Interfaces></General>"
_MOST = 1000  # samples taken at once
_KIND = "::msg::dds_::"


def dds_type_name(kind: str) -> str:
    """sensor_msgs/msg/Image as DDS names it."""
    package, _, name = kind.split("/")
    return f"{package}{_KIND}{name}_"


def _field_type(field: tuple):
    """The type of IDL of a field, as rosbags describes it: a base, a name, an array or a sequence."""
    node, content = field
    if node.name == "BASE":
        return BASES[content[0]]
    if node.name == "NAME":
        return message_type(content)
    element = _field_type(content[0])
    return idl_types.array[element, content[1]] if node.name == "ARRAY" else idl_types.sequence[element]


@cache
def message_type(kind: str) -> type:
    """The type of DDS of a message. Its objects hold a ``message`` of rosbags, whose code for CDR replaces that of
    cyclonedds, which makes lists of ints of images.
    """
    store = message_store()
    fields = {name: _field_type(field) for name, field in store.fielddefs[kind][1]}
    made = idl.make_idl_struct(kind.rsplit("/", 1)[1], dds_type_name(kind).replace("::", "."), fields,
                               dataclassify=False)
    made.__init__ = lambda self, message: setattr(self, "message", message)
    made.serialize = lambda self, **_: bytes(store.serialize_cdr(self.message, kind))
    made.deserialize = staticmethod(lambda data, **_: made(store.deserialize_cdr(data, kind)))
    made.deserialize_key = staticmethod(lambda data, **_: None)
    return made


def _qualities(reliable: bool, latched: bool, depth: int) -> Qos:
    """Qualities of service. A publisher that is reliable waits for nobody: what it cannot send at once is dropped."""
    return Qos(Policy.Reliability.Reliable(max_blocking_time=0) if reliable else Policy.Reliability.BestEffort,
               Policy.Durability.TransientLocal if latched else Policy.Durability.Volatile,
               Policy.History.KeepLast(depth), Policy.DataRepresentation(use_cdrv0_representation=True))


def taken(reader: DataReader) -> list:
    """What a reader has got since the last call, in order."""
    return [sample for sample in reader.take(_MOST) if not isinstance(sample, InvalidSample)]


def _condition(reader: DataReader) -> ReadCondition:
    return ReadCondition(reader, ViewState.Any | SampleState.NotRead | InstanceState.Any)


class Subscription:
    """The messages of a topic."""

    def __init__(self, reader: DataReader):
        self._reader = reader
        self.condition = _condition(reader)

    @property
    def publishers(self) -> int:
        """Number of publishers that it hears."""
        return len(self._reader.get_matched_publications())

    def samples(self) -> list:
        """What has come since the last call, in order: objects with ``message`` and ``sample_info``."""
        return taken(self._reader)

    def take(self) -> list:
        """The messages that have come since the last call, in order."""
        return [sample.message for sample in self.samples()]


class Publisher:
    """Writes the messages of a topic."""

    def __init__(self, writer: DataWriter, kind: str):
        self._writer, self._type = writer, message_type(kind)

    def publish(self, message) -> bool:
        """Writes a message. False if the network does not take it, which concerns nobody but its readers."""
        try:
            self._writer.write(self._type(message))
        except DDSException:
            return False
        return True


class Domain:
    """A participant of the domain ``number``, or of that of ROS_DOMAIN_ID, or of 0. ``loopback``: on this machine only.

    Raises UsageError for a number that is none.
    """

    def __init__(self, number: int | None = None, loopback: bool | None = None):
        text = os.environ.get("ROS_DOMAIN_ID", "") or "0"
        if number is None and not text.isdecimal():
            raise UsageError(f"ROS_DOMAIN_ID: found '{text}', expected a number from 0 to 232")
        self.number = int(text) if number is None else number
        if not 0 <= self.number <= 232:
            raise UsageError(f"domain: found {self.number}, expected a number from 0 to 232")
        try:
            if os.environ.get("ROS_LOCALHOST_ONLY") == "1" if loopback is None else loopback:
                given = os.environ.get("CYCLONEDDS_URI")
                self._domain = DdsDomain(self.number, f"{given},{_LOOPBACK}" if given else _LOOPBACK)
            self._participant = DomainParticipant(self.number)
        except DDSException as error:  # Cyclone DDS has printed the reason
            raise UsageError(f"domain {self.number}: the network cannot be used; expected an interface that is up and "
                             "a CYCLONEDDS_URI that Cyclone DDS accepts") from error
        self._publications = BuiltinDataReader(self._participant, BuiltinTopicDcpsPublication)
        self._waits = WaitSet(self._participant)
        self._conditions: list[ReadCondition] = []
        self._topics: dict[str, Topic] = {}

    def _topic(self, name: str, kind: str) -> Topic:
        if name not in self._topics:
            self._topics[name] = Topic(self._participant, "rt" + name, message_type(kind))
        return self._topics[name]

    def subscribe(self, name: str, kind: str, *, reliable: bool = False, latched: bool = False,
                  depth: int = 20) -> Subscription:
        """Reads a topic; wait() ends for its messages. latched: also messages from before, as for /tf_static."""
        # Publishers that describe their types may name members as IDL or as the .msg file does.
        qualities = Qos(Policy.TypeConsistency.AllowTypeCoercion(ignore_member_names=True),
                        base=_qualities(reliable, latched, depth))
        reader = DataReader(self._participant, self._topic(name, kind), qualities)
        made = Subscription(reader)
        self._waits.attach(made.condition)
        return made

    def advertise(self, name: str, kind: str, *, latched: bool = False, depth: int = 10) -> Publisher:
        """Writes a topic, reliably."""
        writer = DataWriter(self._participant, self._topic(name, kind), _qualities(True, latched, depth))
        return Publisher(writer, kind)

    @property
    def participant(self) -> DomainParticipant:
        """That of DDS, for readers and writers of topics that are none of ROS."""
        return self._participant

    def wake_for(self, reader: DataReader) -> None:
        """Has wait() end for samples of a reader, too."""
        self._conditions.append(_condition(reader))
        self._waits.attach(self._conditions[-1])

    def wait(self, seconds: float) -> bool:
        """Waits for a message of a subscription. False if none has come in this time."""
        return self._waits.wait(int(seconds * 1e9)) > 0

    def publications(self) -> list[tuple[str, str]]:
        """Topic and kind of every publisher of a topic of ROS in the domain, also of this participant."""
        found = []
        for endpoint in self._publications.read(_MOST):
            if endpoint.sample_info.instance_state != InstanceState.Alive or not endpoint.type_name:
                continue  # what has left may come without names
            name, (package, _, kind) = endpoint.topic_name, endpoint.type_name.partition(_KIND)
            if name.startswith("rt/") and kind:
                found.append((name[2:], f"{package}/msg/{kind.removesuffix('_')}"))
        return found
