"""Where the base is in the frames odom and map, across restarts and mounts that are found late."""

from dataclasses import dataclass

import numpy

from ..estimates import Estimate, Estimates, moved_covariance, of_base
from ..ros_messages import BODY_FROM_OPTICAL


@dataclass
class Placed(Estimate):
    """The base at the time of one tracked pair, in odom."""

    map_from_odom: numpy.ndarray | None  #: (4, 4) [m]; None: not known


class Place:
    """The base in odom. start: the pose (4, 4) of the base in odom in the first pair and after a reset."""

    def __init__(self, start: numpy.ndarray):
        self._start = start
        self.mount = BODY_FROM_OPTICAL  #: pose (4, 4) of the camera's optical frame in the base's
        self.reset()

    def reset(self) -> None:
        """Begins again at the start; so does the map."""
        self._map_from_odom = numpy.eye(4)
        self._begin(self._start, "")

    def restart(self, why: str) -> None:
        """Goes on at the last pose, which is no measurement of where the next pair is."""
        self._begin(self._pose, why)

    def _begin(self, origin: numpy.ndarray, unknown: str) -> None:
        self._origin, self._pose, self.unknown = origin, origin, unknown
        self._map_before = self._map_from_odom
        self._estimates, self._last = Estimates(self.mount), None

    def set_mount(self, base_from_camera: numpy.ndarray) -> bool:
        """Takes the pose (4, 4) of the camera in the base's frame. True if the base goes on with another one."""
        if numpy.array_equal(base_from_camera, self.mount):
            return False
        self.mount = self._estimates.base_from_camera = base_from_camera
        if self._last is None:
            return False
        moved, _ = of_base(self._last, None, self.mount)
        self._origin = self._pose @ numpy.linalg.inv(moved)
        self.unknown = "the camera's mount came late"
        return True

    def add(self, result, doubt: bool) -> Placed | None:
        """Takes the next result; None if it is lost. doubt: whether images or stamps make its motion doubtful."""
        estimate = self._estimates.add(result, doubt)
        if estimate is None:
            return None
        self._last, self._pose = result.world_from_left, self._origin @ estimate.pose
        covariance = None
        if not self.unknown and estimate.covariance is not None:
            covariance = moved_covariance(estimate.covariance, self._origin[:3, :3], numpy.zeros(3))
        moved = None
        if result.map_from_odometry is not None:
            in_base_axes, _ = of_base(result.map_from_odometry, None, self.mount)
            moved = self._map_before @ self._origin @ in_base_axes @ numpy.linalg.inv(self._origin)
            self._map_from_odom = moved
        return Placed(self._pose, covariance, estimate.twist, moved)
