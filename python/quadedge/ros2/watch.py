"""Waits for two cameras, and watches what they send: silence, images that form no pairs, publishers too many."""

import argparse
import time
from collections.abc import Callable

from .. import DataError
from ..bag.topics import StereoTopics, find_topics
from .domain import Domain, Subscription
from .pairs import LEFT, RIGHT, PairQueue

SILENCE_S = 2.0
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


class Watch:
    """Says once what is wrong, and that it is right again. topics: of the left and right images."""

    def __init__(self, domain: Domain, topics: tuple[str, str], images: list[Subscription], queue: PairQueue,
                 tolerance_ns: int, say: Callable):
        self._domain, self._topics, self._images, self._queue, self._say = domain, topics, images, queue, say
        self._tolerance_ns = tolerance_ns
        now = time.monotonic()
        self._heard, self._silent = [now, now], [False, False]
        self._paired, self._is_unpaired = now, False
        self._without_stamp = 0  # counted when a pair was formed last
        self._said: set[str] = set()

    def hear(self, side: int) -> None:
        """An image of a camera has come."""
        self._heard[side] = time.monotonic()

    def pair(self) -> None:
        """Two images form a pair."""
        self._paired, self._without_stamp = time.monotonic(), self._queue.counts.without_stamp

    def problems(self) -> list[str]:
        """Why there are no pairs now: silent cameras, or images that form none; mostly empty."""
        now, found = time.monotonic(), []
        for side in (LEFT, RIGHT):
            silence = now - self._heard[side]
            if silence > SILENCE_S:
                found.append(f"no image of {self._topics[side]} for {silence:.0f} s")
            if self._silent[side] != (silence > SILENCE_S):
                self._silent[side] = silence > SILENCE_S
                self._say(f"warning: {found[-1]}" if self._silent[side] else
                          f"images of {self._topics[side]} come again")
        unpaired = self._unpaired() if not found and now - self._paired > SILENCE_S else ""
        if bool(unpaired) != self._is_unpaired:
            self._is_unpaired = bool(unpaired)
            self._say(f"warning: {unpaired}" if unpaired else
                      f"images of {self._topics[LEFT]} and {self._topics[RIGHT]} form pairs")
        return found + [unpaired] * bool(unpaired)

    def _unpaired(self) -> str:
        both = f"images of {self._topics[LEFT]} and {self._topics[RIGHT]} come, but form no pairs"
        apart = self._queue.apart_ns()
        if self._queue.counts.without_stamp > self._without_stamp and apart is None:
            return f"{both}: their stamps are 0"
        if apart is None:
            return f"{both}: their stamps do not go on"
        if apart <= self._tolerance_ns:  # they are about to be tracked
            return ""
        return (f"{both}: their stamps are {apart / 1e6:.3f} ms apart, more than the --tolerance of "
                f"{self._tolerance_ns / 1e6:g} ms (are the cameras synchronised?)")

    def faults(self, odometry: str) -> list[str]:
        """Publishers that are one too many. odometry: the topic that this program publishes."""
        publishers = [topic for topic, _ in self._domain.publications()]
        found = [f"{count} publishers on {topic}, expected one"
                 for topic, count in zip(self._topics, (one.publishers for one in self._images)) if count > 1]
        if publishers.count(odometry) > 1:
            found.append(f"another program publishes {odometry}, too: end it, or choose other names with --remap and "
                         "--odom-frame")
        for text in found:
            if text not in self._said:
                self._said.add(text)
                self._say(f"warning: {text}")
        return found
