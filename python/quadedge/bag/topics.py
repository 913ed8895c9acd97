"""Finds the topics of the two cameras in a recording."""

import argparse
import math
import re
from dataclasses import dataclass

from .. import DataError, UsageError

TOLERANCE_NS = 5_000_000
IMAGES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
CAMERA_INFO = "sensor_msgs/msg/CameraInfo"

# Parts of topic names that distinguish left from right.
_SIDES = (("left", "right"), ("cam0", "cam1"), ("cam_0", "cam_1"), ("camera0", "camera1"), ("camera_0", "camera_1"),
          ("infra1", "infra2"), ("image_0", "image_1"), ("fisheye1", "fisheye2"), ("camera1", "camera2"),
          ("stereo_l", "stereo_r"), ("Infrared_1", "Infrared_2"), ("Fisheye_1", "Fisheye_2"))
_NO_GREY = re.compile(r"depth|disparity|compressedDepth|theora|mask|label")


def milliseconds(text: str) -> float:
    """A time from the command line, from 0 on."""
    value = float(text)
    if not 0 <= value < math.inf:
        raise argparse.ArgumentTypeError(f"found {text}, expected a finite number from 0 on")
    return value


def add_topic_options(parser: argparse.ArgumentParser) -> None:
    """Adds the options that say where the images of both cameras and their calibration are."""
    for name, what in (("left", "image topic of the left camera; by default found by its name"),
                       ("right", "image topic of the right camera"),
                       ("left-info", "camera_info of the left camera; by default the one beside its images"),
                       ("right-info", "camera_info of the right camera")):
        parser.add_argument(f"--{name}", default="", metavar="TOPIC", help=what)
    parser.add_argument("--rectified", action="store_true", default=None,
                        help="the images are rectified: P of camera_info describes them, not K and D")
    parser.add_argument("--calibration", metavar="FILE[,FILE]",
                        help="calibration to use instead of camera_info; one file, or left and right")
    parser.add_argument("--tolerance", type=milliseconds, default=TOLERANCE_NS / 1e6, metavar="MS",
                        help="largest difference between the stamps of a pair [ms]; default: %(default)g")


@dataclass(frozen=True)
class StereoTopics:
    """Names of the topics; those of camera_info are empty if there are none."""

    left: str
    right: str
    left_info: str = ""
    right_info: str = ""

    @property
    def names_rectified(self) -> bool:
        """True if the topics' names say, as those of image_proc, that the images are rectified."""
        return "rect" in "/".join(self.left.split("/")[-2:])


def _partner(topic: str, kinds: dict[str, str]) -> str:
    """The topic of the right camera of the same type; empty if there is none."""
    for left, right in _SIDES:
        other = topic.replace(left, right)
        if other != topic and kinds.get(other) == kinds[topic]:
            return other
    return ""


def _info_of(topic: str, kinds: dict[str, str]) -> str:
    """The camera_info topic beside an image topic or above (``image_raw/compressed``; realsense-viewer's info/)."""
    folder = topic
    while "/" in folder.strip("/"):
        folder = folder.rsplit("/", 1)[0]
        for name in ("/camera_info", "/info/camera_info"):
            if kinds.get(folder + name) == CAMERA_INFO:
                return folder + name
    return ""


def _preference(pair: tuple[str, str], kinds: dict[str, str]) -> tuple:
    """A sort key that prefers pairs with a calibration, then unrectified, uncompressed and grey ones."""
    left = pair[0]
    return (_info_of(left, kinds) == "", "rect" in left, "compressed" in left, "color" in left or "rgb" in left, left)


def _camera(topic: str) -> str:
    """A topic up to the part that names its side; images of one camera differ after it (left/image_rect, left_raw)."""
    ends = [topic.find(left) + len(left) for left, _ in _SIDES if left in topic]
    return topic[:min(ends)]


def _listing(kinds: dict[str, str]) -> str:
    return ", ".join(f"{topic} ({kind})" for topic, kind in sorted(kinds.items())) or "nothing"


def _with_infos(left: str, right: str, given: StereoTopics, kinds: dict[str, str], name: str) -> StereoTopics:
    """Completes a pair of image topics by those of camera_info: the given ones, or those beside the images."""
    for topic in (given.left_info, given.right_info):
        if topic and kinds.get(topic) != CAMERA_INFO:
            raise DataError(f"{name}: found no camera_info topic {topic}, expected one; there are {_listing(kinds)}")
    return StereoTopics(left, right, given.left_info or _info_of(left, kinds),
                        given.right_info or _info_of(right, kinds))


def find_topics(kinds: dict[str, str], name: str, given: StereoTopics = StereoTopics("", "")) -> StereoTopics:
    """Finds the two cameras among the topics of a recording.

    kinds: message type by topic. name: of the recording, for error messages. given: the topics chosen by the user;
    of the images both or neither. Raises DataError if there is no pair of cameras or more than one, UsageError for one
    topic as both.
    """
    left, right = given.left, given.right
    if left and left == right:
        raise UsageError(f"{name}: found {left} as the topic of both cameras, expected two")
    if bool(left) != bool(right):
        raise DataError(f"{name}: found one image topic, expected both, left and right, or neither")
    if left:
        for topic in (left, right):
            if kinds.get(topic) not in IMAGES:
                found = f"the topic {topic} of {kinds[topic]}" if topic in kinds else f"no topic {topic}"
                raise DataError(f"{name}: found {found}, expected an image topic; there are {_listing(kinds)}")
        return _with_infos(left, right, given, kinds, name)
    images = {topic: kind for topic, kind in kinds.items() if kind in IMAGES and not _NO_GREY.search(topic)}
    pairs = [(topic, other) for topic in images if (other := _partner(topic, images))]
    if not pairs:
        raise DataError(f"{name}: found no stereo topics among {_listing(kinds)}, expected two image topics whose "
                        "names distinguish left and right; --left and --right (left=, right=) select others")
    chosen = min(pairs, key=lambda pair: _preference(pair, kinds))
    cameras = {_camera(topic) for topic, _ in pairs}
    if len(cameras) > 1:
        choices = "; ".join(f"{one} with {other}" for one, other in sorted(pairs))
        raise DataError(f"{name}: found several pairs of cameras ({choices}), expected one; choose it with --left and "
                        "--right (left=, right=)")
    return _with_infos(*chosen, given, kinds, name)
