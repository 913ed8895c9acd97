"""Services of std_srvs/srv/Trigger, as what they are in DDS: a topic for requests and one for replies."""

import struct
from collections.abc import Callable
from contextlib import suppress
from functools import cache

from cyclonedds import idl
from cyclonedds.core import DDSException, Policy, Qos
from cyclonedds.idl import types as idl_types
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from .domain import Domain, taken

_LITTLE_ENDIAN = b"\x00\x01\x00\x00"  # plain CDR
_HEADER = 16  # bytes before what rmw_cyclonedds_cpp sends: who has asked, and the number of the request


@cache
def trigger_type(part: str) -> type:
    """The type of DDS of a "Request" or "Response" of Trigger. Its objects hold the bytes of it as ``data``.

    Cyclone DDS compares what is written with the fields that are declared: one byte, which any header begins with.
    """
    fields = {"structure_needs_at_least_one_member": idl_types.uint8}
    made = idl.make_idl_struct(f"Trigger_{part}", f"std_srvs.srv.dds_.Trigger_{part}_", fields, dataclassify=False)
    made.__init__ = lambda self, data: setattr(self, "data", data)
    made.serialize = lambda self, **_: self.data
    made.deserialize = staticmethod(lambda data, **_: made(bytes(data)))
    made.deserialize_key = staticmethod(lambda data, **_: None)
    return made


def request_header(data: bytes) -> bytes:
    """What a reply has to repeat: 16 bytes of rmw_cyclonedds_cpp, nothing of others."""
    return data[4:4 + _HEADER] if len(data) >= 4 + _HEADER + 1 else b""


def reply_data(header: bytes, success: bool, message: str) -> bytes:
    """A response as CDR."""
    text = message.encode() + b"\0"
    return _LITTLE_ENDIAN + header + struct.pack("<?xxxI", success, len(text)) + text


class Trigger:
    """Answers the requests of a service. answer: does what is asked and returns success and a sentence."""

    def __init__(self, domain: Domain, name: str, answer: Callable[[], tuple[bool, str]]):
        self._answer, self.name = answer, name
        # rmw_cyclonedds_cpp takes a reader and a writer with one serviceid for a server that is there.
        qualities = Qos(Policy.Reliability.Reliable(max_blocking_time=0), Policy.Durability.Volatile,
                        Policy.History.KeepLast(10), Policy.DataRepresentation(use_cdrv0_representation=True),
                        Policy.Userdata(f"serviceid=quadedge{name.replace('/', '.')};".encode()))
        participant = domain.participant
        requests = Topic(participant, f"rq{name}Request", trigger_type("Request"))
        self._reader = DataReader(participant, requests, Qos(
            Policy.TypeConsistency.AllowTypeCoercion(ignore_member_names=True), base=qualities))
        replies = Topic(participant, f"rr{name}Reply", trigger_type("Response"))
        self._writer = DataWriter(participant, replies, qualities)
        domain.wake_for(self._reader)

    def work(self) -> None:
        """Answers what has been asked since the last call."""
        for request in taken(self._reader):
            success, message = self._answer()
            reply = trigger_type("Response")(reply_data(request_header(request.data), success, message))
            with suppress(DDSException):  # whoever has asked is gone
                self._writer.write(reply)
