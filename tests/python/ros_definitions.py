"""The published definitions of ROS's messages, from Debian's ros-*-msgs, which are those of ROS 1."""

import re
from pathlib import Path

FOLDER = Path("/usr/share")
_CONSTANT = re.compile(r"^\S+\s+\w+\s*=")
# What ROS 2 changed: the name of the type of stamps, which is no base there, and Header's number.
_RENAMED = {"time": "builtin_interfaces/Time", "Header": "std_msgs/Header"}
_OF_ROS2 = {"builtin_interfaces/msg/Time": [("int32", "sec", ""), ("uint32", "nanosec", "")]}
# std_srvs/srv/Trigger, as rosidl names its two halves in DDS.
TRIGGER = ("module std_srvs { module srv { module dds_ { "
           "struct Trigger_Request_ { octet structure_needs_at_least_one_member; }; "
           "struct Trigger_Response_ { boolean success; string message; }; }; }; };\n")
_IDL = {"bool": "boolean", "byte": "octet", "uint8": "octet", "char": "octet", "int8": "char", "int16": "short",
        "uint16": "unsigned short", "int32": "long", "uint32": "unsigned long", "int64": "long long",
        "uint64": "unsigned long long", "float32": "float", "float64": "double", "string": "string"}  # fmt: skip


def fields(kind: str) -> list[tuple[str, str, str]]:
    """Type, name and array ("", "[]" or "[N]") of the fields of pkg/msg/T, in the order of ROS 2."""
    if kind in _OF_ROS2:
        return _OF_ROS2[kind]
    package, _, name = kind.split("/")
    found = []
    for line in (FOLDER / package / "msg" / f"{name}.msg").read_text().splitlines():
        line = line.partition("#")[0].strip()
        if not line or _CONSTANT.match(line):
            continue
        given, field = line.split()
        base, array = re.match(r"([\w/]+)(\[\d*\])?", given).groups("")
        base = _RENAMED.get(base, base)
        if base not in _IDL:
            base = "/msg/".join(base.split("/")) if "/" in base else f"{package}/msg/{base}"
        found.append((base, field.lower() if kind == "sensor_msgs/msg/CameraInfo" else field, array))
    if kind == "std_msgs/msg/Header":
        found = [field for field in found if field[1] != "seq"]
    return found or [("uint8", "structure_needs_at_least_one_member", "")]


def with_parts(kinds: list[str]) -> list[str]:
    """These kinds and those of their fields, parts first."""
    found: list[str] = []
    for kind in kinds:
        parts = [base for base, _, _ in fields(kind) if base not in _IDL]
        found += [one for one in [*with_parts(parts), kind] if one not in found]
    return found


def idl(kinds: list[str]) -> str:
    """The same as IDL, in the modules and with the names that ROS 2 gives them in DDS."""
    text = ""
    for kind in with_parts(kinds):
        package, _, name = kind.split("/")
        members = ""
        for base, field, array in fields(kind):
            of_dds = _IDL.get(base) or "{}::msg::dds_::{}_".format(*base.split("/msg/"))
            members += f"sequence<{of_dds}> {field}; " if array == "[]" else f"{of_dds} {field}{array}; "
        text += f"module {package} {{ module msg {{ module dds_ {{ struct {name}_ {{ {members}}}; }}; }}; }};\n"
    return text
