"""Pairs left and right images as they arrive."""

from dataclasses import dataclass, field

from ..bag.pairing import pair_stamps
from ..ros_messages import stamp_ns

LEFT, RIGHT = 0, 1
_JUMP_NS = 500_000_000  # a stamp that is older than the last one by more is of another clock, not late
_MOST_WAITING = 10  # images of one camera


@dataclass
class Counts:
    """Numbers of images and pairs since the start."""

    images: list[int] = field(default_factory=lambda: [0, 0])  #: left and right images that arrived
    pairs: int = 0  #: pairs that were tracked
    behind: int = 0  #: pairs that were left out for a newer one
    alone: list[int] = field(default_factory=lambda: [0, 0])  #: left and right images without a partner
    late: int = 0  #: images with the stamp of the last pair, or an earlier one
    without_stamp: int = 0  #: images whose stamp is zero
    refused: int = 0  #: pairs that could not be tracked: encodings, sizes

    def by_name(self) -> dict[str, int]:
        return {"left images": self.images[LEFT], "right images": self.images[RIGHT], "pairs tracked": self.pairs,
                "pairs dropped for a newer one": self.behind, "left images alone": self.alone[LEFT],
                "right images alone": self.alone[RIGHT], "images late or repeated": self.late,
                "images without a stamp": self.without_stamp, "pairs refused": self.refused}

    @property
    def dropped(self) -> int:
        """Number of pairs and images that were not tracked."""
        return self.behind + sum(self.alone) + self.late + self.without_stamp + self.refused


class PairQueue:
    """The images that wait for their partners, at most ten of each camera. tolerance_ns: as for pair_stamps()."""

    def __init__(self, tolerance_ns: int):
        self._tolerance_ns = tolerance_ns
        self._waiting: tuple[dict, dict] = ({}, {})  # message by stamp
        self._newest = [0, 0]  # stamp that arrived last
        self._given = [0, 0]  # stamps of the pair that was given last
        self.counts = Counts()

    def add(self, side: int, message) -> int:
        """Takes an image. Returns by how many nanoseconds the clock of the cameras has gone back, mostly 0."""
        stamp, newest, other = stamp_ns(message), self._newest[side], self._newest[1 - side]
        self.counts.images[side] += 1
        if stamp == 0:
            self.counts.without_stamp += 1
            return 0
        back = 0
        if stamp < newest - _JUMP_NS:
            if abs(stamp - other) > _JUMP_NS:  # otherwise this camera follows the other, whose stamps have gone back
                back = newest - stamp
            for camera in (LEFT, RIGHT):
                self._leave_out(camera, [one for one in self._waiting[camera] if one > stamp + _JUMP_NS])
            self._given = [0, 0]
            newest = 0
        elif stamp <= self._given[side] or stamp in self._waiting[side]:
            self.counts.late += 1
            return 0
        self._newest[side] = max(stamp, newest)
        self._waiting[side][stamp] = message
        if len(self._waiting[side]) > _MOST_WAITING:
            self._leave_out(side, [min(self._waiting[side])])
        return back

    def _leave_out(self, side: int, stamps: list[int]) -> None:
        for stamp in stamps:
            del self._waiting[side][stamp]
        self.counts.alone[side] += len(stamps)

    def newest(self) -> tuple | None:
        """The newest pair of messages, left and right, and drops all that are older; None without a pair."""
        stamps = [list(waiting) for waiting in self._waiting]
        pairs = pair_stamps(*stamps, self._tolerance_ns).pairs
        if not pairs:
            return None
        self._given = [stamps[side][place] for side, place in enumerate(pairs[-1])]
        self.counts.behind += len(pairs) - 1
        messages = tuple(waiting[stamp] for waiting, stamp in zip(self._waiting, self._given))
        for side, waiting in enumerate(self._waiting):
            passed = [stamp for stamp in waiting if stamp <= self._given[side]]
            self._leave_out(side, passed)
            self.counts.alone[side] -= len(pairs)
        return messages
