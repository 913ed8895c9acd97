"""Which topics of a recording are the two cameras."""

import re
from dataclasses import dataclass

from .. import DataError

IMAGES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
CAMERA_INFO = "sensor_msgs/msg/CameraInfo"

# How left is written where right is written otherwise.
_SIDES = (("left", "right"), ("cam0", "cam1"), ("cam_0", "cam_1"), ("camera0", "camera1"), ("camera_0", "camera_1"),
          ("infra1", "infra2"), ("image_0", "image_1"))
_NO_GREY = re.compile(r"depth|disparity|compressedDepth|theora|mask|label")


@dataclass(frozen=True)
class StereoTopics:
    """Names of the topics; those of camera_info are empty where there are none."""

    left: str
    right: str
    left_info: str = ""
    right_info: str = ""

    @property
    def rectified(self) -> bool:
        """Do the images show what the projection matrix says? Their names tell, as image_proc gives them."""
        return "rect" in "/".join(self.left.split("/")[-2:])


def _partner(topic: str, kinds: dict[str, str]) -> str:
    """The right camera's topic of the same kind; empty without one."""
    for left, right in _SIDES:
        other = topic.replace(left, right)
        if other != topic and kinds.get(other) == kinds[topic]:
            return other
    return ""


def _info_of(topic: str, kinds: dict[str, str]) -> str:
    """The camera_info beside an image topic or above it (``image_raw/compressed``)."""
    folder = topic
    while "/" in folder.strip("/"):
        folder = folder.rsplit("/", 1)[0]
        if kinds.get(folder + "/camera_info") == CAMERA_INFO:
            return folder + "/camera_info"
    return ""


def _preference(pair: tuple[str, str], kinds: dict[str, str]) -> tuple:
    """Small for what is nearest to the sensor: with a calibration, as recorded, uncompressed, grey."""
    left = pair[0]
    return (_info_of(left, kinds) == "", "rect" in left, "compressed" in left, "color" in left or "rgb" in left, left)


def _listing(kinds: dict[str, str]) -> str:
    return ", ".join(f"{topic} ({kind})" for topic, kind in sorted(kinds.items())) or "nothing"


def find_topics(kinds: dict[str, str], name: str, left: str = "", right: str = "") -> StereoTopics:
    """The two cameras among the topics of a recording.

    kinds: message type of every topic. name: of the recording, for messages. left, right: where the user says which.
    Raises DataError when there is no such pair, or more than one pair of cameras.
    """
    if bool(left) != bool(right):
        raise DataError(f"{name}: found one topic of the cameras, expected both, left and right, or none")
    if left:
        for topic in (left, right):
            if kinds.get(topic) not in IMAGES:
                found = f"the topic {topic} of {kinds[topic]}" if topic in kinds else f"no topic {topic}"
                raise DataError(f"{name}: found {found}, expected one of images; there are {_listing(kinds)}")
        return StereoTopics(left, right, _info_of(left, kinds), _info_of(right, kinds))
    images = {topic: kind for topic, kind in kinds.items() if kind in IMAGES and not _NO_GREY.search(topic)}
    pairs = [(topic, other) for topic in images if (other := _partner(topic, images))]
    if not pairs:
        raise DataError(f"{name}: found no stereo topics among {_listing(kinds)}, expected two of images whose names "
                        "tell left and right")
    chosen = min(pairs, key=lambda pair: _preference(pair, kinds))
    cameras = {topic.rsplit("/", 1)[0].split("/image", 1)[0] for topic, _ in pairs}
    if len(cameras) > 1:
        choices = "; ".join(f"{one} with {other}" for one, other in sorted(pairs))
        raise DataError(f"{name}: found several pairs of cameras ({choices}), expected one, or to be told which")
    return StereoTopics(*chosen, _info_of(chosen[0], kinds), _info_of(chosen[1], kinds))
