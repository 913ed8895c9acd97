"""``python -m quadedge.ros2`` with the parameters and remaps that ROS passes after ``--ros-args``."""

import sys
from collections.abc import Iterator

import yaml
from quadedge.errors import UsageError
from quadedge.ros2.__main__ import main as run
from quadedge.shell import exit_code

NAME = "quadedge"


def _parameters_in(file: str) -> dict:
    with open(file, encoding="utf-8") as stream:
        content = yaml.safe_load(stream) or {}
    nodes = [content[key] for key in ("/**", NAME, f"/{NAME}") if key in content]
    if not nodes:
        raise UsageError(f"{file}: found parameters of {', '.join(content) or 'no node'}, expected some of {NAME}")
    return {name: value for node in nodes for name, value in node["ros__parameters"].items()}


def _options_for(name: str, value) -> Iterator[str]:
    """A flag for true, an option for another value; lists of texts repeat it, numbers are joined."""
    option = "--" + name.replace("_", "-")
    if isinstance(value, bool):
        yield from [option] * value
    elif isinstance(value, list) and all(isinstance(one, str) for one in value):
        yield from (f"{option}={one}" for one in value)
    else:
        yield f"{option}={','.join(map(str, value)) if isinstance(value, list) else value}"


def options_of(words: list[str]) -> list[str]:
    """The options of quadedge.ros2 that a command line of ROS means."""
    options, parameters, is_ros, rest = [], {}, False, iter(words)
    for word in rest:
        if word == "--ros-args" or (word == "--" and is_ros):
            is_ros = word == "--ros-args"
        elif not is_ros:
            options.append(word)
        elif word in ("-p", "--param"):
            name, _, value = next(rest).partition(":=")
            parameters[name] = yaml.safe_load(value)
        elif word == "--params-file":
            parameters |= _parameters_in(next(rest))
        elif word in ("-r", "--remap"):
            rule = next(rest)
            options += [] if rule.startswith("__node:=") else [f"--remap={rule}"]
        else:
            raise UsageError(f"found {word} after --ros-args, expected -p, --params-file or -r")
    return options + [option for name, value in parameters.items() for option in _options_for(name, value)]


def main() -> int:
    return exit_code(NAME, lambda: run(options_of(sys.argv[1:])))
