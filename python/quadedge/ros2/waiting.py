"""Waits for the topics of two cameras to be published."""

import argparse
import time
from collections.abc import Callable

from .. import DataError
from ..bag.topics import StereoTopics, find_topics
from .domain import Domain

_SETTLED_S, _NOBODY_S = 0.5, 5.0


def awaited_topics(domain: Domain, options: argparse.Namespace, say: Callable,
                   stopped: list) -> tuple[StereoTopics, dict[str, str]] | None:
    """The topics and the kinds of all, as soon as they stay the same for a moment; None if stopped."""
    start, since, found = time.monotonic(), 0.0, None
    given = StereoTopics(options.left, options.right, options.left_info, options.right_info)
    while not stopped:
        kinds, now, problem = dict(domain.publications()), time.monotonic(), ""
        kinds = {topic: kind for topic, kind in kinds.items() if topic not in (options.left_mask, options.right_mask)}
        try:
            topics = find_topics(kinds, f"domain {domain.number}", given)
            if not options.calibration and not (topics.left_info and topics.right_info):
                problem = (f"domain {domain.number}: found no camera_info beside {topics.left} and {topics.right}, "
                           "expected one of each camera, or --calibration FILE")
        except DataError as error:
            topics, problem = None, str(error)
        if problem:
            found = None
            if start is not None and now - start > _NOBODY_S:
                say(problem + "; waiting" if kinds else
                    f"domain {domain.number}: nobody publishes a topic of ROS 2 (is ROS_DOMAIN_ID that of the robot?); "
                    "waiting")
                start = None
        elif topics != found:
            found, since = topics, now
        elif now - since > _SETTLED_S:
            return topics, kinds
        time.sleep(0.1)
    return None
