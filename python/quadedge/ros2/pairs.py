"""Pairs left and right images as they arrive."""

from collections.abc import Callable
from dataclasses import dataclass, field

from ..bag.pairing import pair_stamps
from ..ros_messages import stamp_ns

LEFT, RIGHT = 0, 1
_JUMP_NS = 500_000_000  # a stamp that is older than the last one by more is of another clock, not late
_MOST_WAITING = 10  # images of one camera
_LATE_IN_A_ROW = 3  # that many ascending stamps that come too late are of a clock that was set back a little


@dataclass
class Counts:
    """Numbers of images and pairs since the start."""

    images: list[int] = field(default_factory=lambda: [0, 0])  #: left and right images that arrived
    tracked: int = 0  #: pairs that have a pose
    ambiguous: int = 0  #: of these, pairs whose motion is ambiguous
    lost: int = 0  #: pairs without a pose
    behind: int = 0  #: pairs that were left out for a newer one
    alone: list[int] = field(default_factory=lambda: [0, 0])  #: left and right images without a partner
    late: int = 0  #: images with the stamp of the last pair, or an earlier one
    without_stamp: int = 0  #: images whose stamp is zero
    refused: int = 0  #: pairs that could not be tracked: encodings, sizes

    def by_name(self) -> dict[str, int]:
        return {"left images": self.images[LEFT], "right images": self.images[RIGHT], "pairs tracked": self.tracked,
                "pairs tracked, ambiguous": self.ambiguous, "pairs lost": self.lost,
                "pairs dropped for a newer one": self.behind, "left images alone": self.alone[LEFT],
                "right images alone": self.alone[RIGHT], "images late or repeated": self.late,
                "images without a stamp": self.without_stamp, "pairs refused": self.refused}


class PairQueue:
    """The images that wait for their partners, at most ten of each camera. tolerance_ns: as for pair_stamps()."""

    def __init__(self, tolerance_ns: int):
        self._tolerance_ns = tolerance_ns
        self._waiting: tuple[dict, dict] = ({}, {})  # message by stamp
        self._newest = [0, 0]  # stamp that arrived last
        self._given = [0, 0]  # stamps of the pair that was given last
        self._late: tuple[list, list] = ([], [])  # ascending stamps that came too late, one after the other
        self.counts = Counts()
        self.clock_is_doubtful = False  #: whether images have come too late since the pair before the one given last
        self._has_late = False

    def add(self, side: int, message) -> int:
        """Takes an image. Returns by how many nanoseconds the clock of the cameras has gone back, mostly 0."""
        stamp, newest, other = stamp_ns(message), self._newest[side], self._newest[1 - side]
        self.counts.images[side] += 1
        if stamp == 0:
            self.counts.without_stamp += 1
            return 0
        back = 0
        is_late = stamp <= self._given[side] or stamp in self._waiting[side]
        if self._goes_back(side, stamp, is_late):
            if abs(stamp - other) > abs(newest - other):  # otherwise this camera follows the other
                back = newest - min([stamp, *self._late[side]])
            for camera in (LEFT, RIGHT):
                self._leave_out(camera, [one for one in self._waiting[camera] if one > (stamp + newest) / 2])
            self._given, newest = [0, 0], 0
            self._late[side].clear()
        elif is_late:
            self.counts.late += 1
            self._has_late |= stamp < newest
            return 0
        self._newest[side] = max(stamp, newest)
        self._waiting[side][stamp] = message
        if len(self._waiting[side]) > _MOST_WAITING:
            self._leave_out(side, [min(self._waiting[side])])
        return back

    def _goes_back(self, side: int, stamp: int, is_late: bool) -> bool:
        """Whether the clock was set back: by much, or by so little that several images in a row come too late."""
        late, newest = self._late[side], self._newest[side]
        if stamp < newest - _JUMP_NS:
            return True
        if not is_late or stamp >= newest:
            late.clear()
            return False
        if late and stamp <= late[-1]:
            late.clear()
        late.append(stamp)
        return len(late) == _LATE_IN_A_ROW

    def apart_ns(self) -> int | None:
        """How far the stamps of the two cameras' waiting images are apart at least; None if one has none."""
        return min((abs(left - right) for left in self._waiting[LEFT] for right in self._waiting[RIGHT]), default=None)

    def _leave_out(self, side: int, stamps: list[int]) -> None:
        for stamp in stamps:
            del self._waiting[side][stamp]
        self.counts.alone[side] += len(stamps)

    def newest(self, ready: Callable[[list, bool], int] | None = None) -> tuple | None:
        """The newest pair of messages, left and right, and drops all that are older; None without a pair. ready: as
        Masks.ready(), where pairs wait for masks.
        """
        stamps = [list(waiting) for waiting in self._waiting]
        pairs = [(stamps[LEFT][i], stamps[RIGHT][j]) for i, j in pair_stamps(*stamps, self._tolerance_ns).pairs]
        if ready:
            pairs = pairs[:ready(pairs, _MOST_WAITING in map(len, stamps))]
        if not pairs:
            return None
        self.clock_is_doubtful, self._has_late = self._has_late, False
        self._given = list(pairs[-1])
        self.counts.behind += len(pairs) - 1
        messages = tuple(waiting[stamp] for waiting, stamp in zip(self._waiting, self._given))
        for side, waiting in enumerate(self._waiting):
            passed = [stamp for stamp in waiting if stamp <= self._given[side]]
            self._leave_out(side, passed)
            self.counts.alone[side] -= len(pairs)
        return messages
