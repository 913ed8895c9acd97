"""Pairs left and right images by their time stamps."""

from dataclasses import dataclass, field
from itertools import zip_longest


@dataclass
class Pairing:
    """The pairs of a recording in order of time, and the number of dropped images by reason."""

    pairs: list[tuple[int, int]] = field(default_factory=list)  #: indices into the lists of left and right stamps
    left_dropped: int = 0  #: left images without a right image within the tolerance
    right_dropped: int = 0  #: right images without a left image within the tolerance
    without_stamp: int = 0  #: left and right images whose stamp is zero
    repeated: int = 0  #: images that repeat an earlier stamp of the same camera
    largest_difference_ns: int = 0  #: between the stamps of a pair
    restarts: list[int] = field(default_factory=list)  #: indices of pairs whose stamps go back behind those before

    def __str__(self) -> str:
        text = f"{len(self.pairs)} pairs"
        if self.restarts:
            text += f" in {len(self.restarts) + 1} segments"
        if self.largest_difference_ns:
            text += f", stamps up to {self.largest_difference_ns / 1e6:.3f} ms apart"
        reasons = [(self.left_dropped, "left images without a right one"),
                   (self.right_dropped, "right images without a left one"),
                   (self.without_stamp, "without a stamp"), (self.repeated, "with a repeated stamp")]
        dropped = ", ".join(f"{count} {reason}" for count, reason in reasons if count)
        return text + (f"; dropped: {dropped}" if dropped else "")


def _in_order(stamps_ns: list[int], pairing: Pairing) -> list[int]:
    """Indices of the usable stamps in order of time. Counts the others in ``pairing``."""
    places, seen = [], set()
    for place, stamp in enumerate(stamps_ns):
        if stamp == 0:
            pairing.without_stamp += 1
        elif stamp in seen:
            pairing.repeated += 1
        else:
            seen.add(stamp)
            places.append(place)
    return sorted(places, key=lambda place: stamps_ns[place])


def _nearest(stamp: int, stamps: list[int], first: int) -> int:
    """Index of the nearest of the ascending stamps from index ``first`` on; the earlier one of two equally near."""
    best = first
    while best + 1 < len(stamps) and abs(stamps[best + 1] - stamp) < abs(stamps[best] - stamp):
        best += 1
    return best


def pair_stamps(left_ns: list[int], right_ns: list[int], tolerance_ns: int) -> Pairing:
    """Pairs stamps [ns] that are mutually nearest and differ by at most ``tolerance_ns``.

    The lists may be in any order. The pairs contain indices into these lists. Stamps that are zero or repeated are
    dropped.
    """
    pairing = Pairing()
    left, right = _in_order(left_ns, pairing), _in_order(right_ns, pairing)
    left_stamps, right_stamps = [left_ns[i] for i in left], [right_ns[i] for i in right]
    at = back = 0
    for i, stamp in enumerate(left_stamps):
        if not right_stamps:
            break
        at = _nearest(stamp, right_stamps, at)
        back = _nearest(right_stamps[at], left_stamps, back)
        difference = abs(right_stamps[at] - stamp)
        if back == i and difference <= tolerance_ns:
            pairing.pairs.append((left[i], right[at]))
            pairing.largest_difference_ns = max(pairing.largest_difference_ns, difference)
    pairing.left_dropped = len(left) - len(pairing.pairs)
    pairing.right_dropped = len(right) - len(pairing.pairs)
    return pairing


def _parts(stamps_ns: list[int]) -> list[range]:
    """The ranges of indices in which stamps do not go back. Stamps that are zero count for nothing."""
    firsts, last = [0], 0
    for i, stamp in enumerate(stamps_ns):
        if 0 < stamp < last:
            firsts.append(i)
        last = stamp or last
    return [range(first, end) for first, end in zip(firsts, [*firsts[1:], len(stamps_ns)])]


def pair_parts(left_ns: list[int], right_ns: list[int], tolerance_ns: int) -> Pairing:
    """As pair_stamps(), for stamps that go back: pairs the first part of both lists, the second part, and so on."""
    whole = Pairing()
    for left, right in zip_longest(_parts(left_ns), _parts(right_ns), fillvalue=range(0)):
        part = pair_stamps([left_ns[i] for i in left], [right_ns[i] for i in right], tolerance_ns)
        if whole.pairs and part.pairs:
            whole.restarts.append(len(whole.pairs))
        whole.pairs += [(left[i], right[j]) for i, j in part.pairs]
        for name in ("left_dropped", "right_dropped", "without_stamp", "repeated"):
            setattr(whole, name, getattr(whole, name) + getattr(part, name))
        whole.largest_difference_ns = max(whole.largest_difference_ns, part.largest_difference_ns)
    return whole
