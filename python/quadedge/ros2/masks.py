"""Masks of images from topics. They come after their images, so that pairs wait for them, but not for long."""

import time
from collections.abc import Callable

import numpy

from .. import DataError
from ..bag.images import grey_image
from ..bag.pairing import pair_stamps
from ..bag.topics import IMAGES
from ..ros_messages import stamp_ns
from .domain import Domain
from .watch import SILENCE_S

_ENCODINGS = ("mono8", "8UC1")
_KEPT = 20  # masks that wait for their images


def mask_of(message, topic: str, shape: tuple[int, int]) -> numpy.ndarray:
    """The mask (height, width), uint8, in a sensor_msgs/Image. shape: of its image. Raises DataError for others."""
    if message.encoding not in _ENCODINGS:
        raise DataError(f"{topic}: found a mask with the encoding '{message.encoding}', expected mono8")
    mask = grey_image(message, topic)
    if mask.shape != shape:
        raise DataError(f"{topic}: found a mask of {mask.shape[1]} x {mask.shape[0]} pixels, expected {shape[1]} x "
                        f"{shape[0]}, the size of its image")
    return mask


class MaskTopic:
    """The masks of one camera. side: "left" or "right". say: called with a sentence for the user."""

    def __init__(self, domain: Domain, name: str, side: str, reliable: bool, say: Callable):
        self._domain, self._name, self._side, self._say = domain, name, side, say
        self._topic = domain.subscribe(name, IMAGES[0], reliable=reliable)
        self._without = self._late = self._refused = 0
        self._missing_since: float | None = None  # when the first pair after the last mask was tracked without one
        self._missing_last = 0.0  # the same of the last pair
        self._was_silent, self._said = False, set()
        self._without_now, self._problem = 0, ""  # in the last second: pairs without, and why a mask was refused
        self.forget()

    def forget(self) -> None:
        """The stamps of the cameras have gone back: masks from before are of no use."""
        self._waiting: dict = {}  # message by stamp
        self._matches: dict[int, int] = {}  # stamp of the mask by that of the image
        self._tracked_ns = 0  # stamp of the image that was tracked last

    @property
    def is_silent(self) -> bool:
        """Whether pairs have been tracked without a mask for so long that none is expected."""
        return self._missing_since is not None and self._missing_last - self._missing_since > SILENCE_S

    def receive(self) -> None:
        """Takes the masks that have come."""
        for message in self._topic.take():
            stamp, self._missing_since = stamp_ns(message), None
            if stamp <= self._tracked_ns or stamp in self._waiting:
                self._late += 1
                continue
            self._waiting[stamp] = message
            if len(self._waiting) > _KEPT:
                del self._waiting[next(iter(self._waiting))]

    def match(self, stamps: list[int], tolerance_ns: int) -> None:
        """Finds the masks of images that wait. stamps: of these images [ns]."""
        masks = list(self._waiting)
        self._matches = {stamps[i]: masks[j] for i, j in pair_stamps(stamps, masks, tolerance_ns).pairs}

    def has(self, stamp: int) -> bool:
        """Whether the mask of an image has come, or none is expected."""
        return stamp in self._matches or self.is_silent

    def take(self, stamp: int, shape: tuple[int, int]) -> numpy.ndarray | None:
        """The mask of the image that is tracked now; None where it has not come or cannot be used."""
        matched, self._tracked_ns = self._matches.get(stamp, 0), stamp
        message = self._waiting.get(matched)
        self._waiting = {one: kept for one, kept in self._waiting.items() if one > max(stamp, matched)}
        try:
            if message is not None:
                return mask_of(message, self._name, shape)
            self._missing_last = time.monotonic()
            self._missing_since = self._missing_since or self._missing_last
            self._without_now += 1
        except DataError as error:
            self._problem = f"{error}; such pairs are tracked without"
            self._refused += 1
        self._without += 1
        return None

    def _why(self) -> str:
        """Why a mask is missing."""
        kinds = [kind for topic, kind in self._domain.publications() if topic == self._name]
        if not kinds or IMAGES[0] not in kinds:
            return f"it is of {kinds[0]}, expected {IMAGES[0]}" if kinds else "nobody publishes it"
        return "none with its stamp has come in time"

    def faults(self, wait_s: float) -> list[str]:
        """What was wrong in the last second. Says what is new."""
        found = [self._problem] if self._problem else []
        if self._without_now:
            waited = "pairs no longer wait for one" if self.is_silent else f"--mask-wait is {wait_s * 1e3:g} ms"
            found.append(f"pairs are tracked without a mask of {self._name}: {self._why()} ({waited})")
        if self.is_silent != self._was_silent:
            self._was_silent = self.is_silent
            self._say(f"warning: {found[-1]}" if self.is_silent else f"masks of {self._name} come again")
        for text in found:
            kind = text if text == self._problem else "missing"
            if kind not in self._said:
                self._said.add(kind)
                self._say(f"warning: {text}")
        self._without_now, self._problem = 0, ""
        return found

    def values(self) -> dict[str, object]:
        """For /diagnostics."""
        return {f"pairs without a {self._side} mask": self._without, f"{self._side} masks late or repeated": self._late,
                f"{self._side} masks refused": self._refused}


class Masks:
    """The masks of both cameras. topics: by camera, for those that have one. wait_s: how long a pair waits at most."""

    def __init__(self, topics: dict[int, MaskTopic], tolerance_ns: int, wait_s: float):
        self._topics, self._tolerance_ns, self._wait_s = topics, tolerance_ns, wait_s
        self._waiting: dict[tuple[int, int], float] = {}  # when pairs have come, by their stamps
        self.arrived = 0.0  #: when the pair that was given last had come, by time.monotonic()

    def forget(self) -> None:
        """As MaskTopic.forget()."""
        for topic in self._topics.values():
            topic.forget()

    def receive(self) -> None:
        """Takes the masks that have come."""
        for topic in self._topics.values():
            topic.receive()

    def ready(self, pairs: list[tuple[int, int]], is_full: bool) -> int:
        """How many of the pairs that wait go up to the newest one that is to be tracked now: its masks have come, it
        has waited long enough, or it is the first where no more may wait. pairs: their stamps in order.
        """
        now, count = time.monotonic(), int(is_full and bool(pairs))
        arrivals = {pair: self._waiting.get(pair, now) for pair in pairs}
        for side, topic in self._topics.items():
            topic.match([pair[side] for pair in pairs], self._tolerance_ns)
        for number, pair in enumerate(pairs, 1):
            has_all = all(topic.has(pair[side]) for side, topic in self._topics.items())
            if has_all or now - arrivals[pair] >= self._wait_s:
                count = number
        self._waiting = {pair: arrivals[pair] for pair in pairs[count:]}
        self.arrived = arrivals[pairs[count - 1]] if count else now
        return count

    def rest_s(self, most: float) -> float:
        """In how many seconds a pair has waited long enough."""
        waited = time.monotonic() - min(self._waiting.values(), default=float("inf"))
        return min(max(self._wait_s - waited, 0.0), most)

    def take(self, stamps: tuple[int, int], images: list[numpy.ndarray]) -> list[numpy.ndarray | None]:
        """The masks of the pair that is tracked now; None for a camera without one."""
        return [self._topics[side].take(stamps[side], image.shape) if side in self._topics else None
                for side, image in enumerate(images)]

    def faults(self) -> list[str]:
        """What was wrong in the last second."""
        return [text for topic in self._topics.values() for text in topic.faults(self._wait_s)]

    def values(self) -> dict[str, object]:
        """For /diagnostics."""
        return {name: value for topic in self._topics.values() for name, value in topic.values().items()}
