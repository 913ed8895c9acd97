"""Which left and right images show the same instant."""

from dataclasses import dataclass, field


@dataclass
class Pairing:
    """The frames of a recording in the order of time, and what found no partner."""

    pairs: list[tuple[int, int]] = field(default_factory=list)  #: places in the lists of left and right stamps
    left_dropped: int = 0  #: left images without a right one within the tolerance
    right_dropped: int = 0  #: right images without a left one
    without_stamp: int = 0  #: images of either side whose stamp is zero
    repeated: int = 0  #: images whose stamp another one of the same side had before
    largest_difference_ns: int = 0  #: of the stamps of a pair

    @property
    def dropped(self) -> int:
        """All images that are no part of a frame."""
        return self.left_dropped + self.right_dropped + self.without_stamp + self.repeated

    def __str__(self) -> str:
        text = f"{len(self.pairs)} pairs"
        if self.largest_difference_ns:
            text += f", stamps up to {self.largest_difference_ns / 1e6:.3f} ms apart"
        reasons = [(self.left_dropped, "left images without a right one"),
                   (self.right_dropped, "right images without a left one"),
                   (self.without_stamp, "without a stamp"), (self.repeated, "whose stamp stood twice")]
        dropped = ", ".join(f"{count} {reason}" for count, reason in reasons if count)
        return text + (f"; dropped: {dropped}" if dropped else "")


def _in_order(stamps_ns: list[int], pairing: Pairing) -> list[int]:
    """Places of the usable stamps in the order of time; counts the others."""
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
    """Place of the nearest of the ascending stamps; looks from ``first`` on, the earlier one of two as near."""
    best = first
    while best + 1 < len(stamps) and abs(stamps[best + 1] - stamp) < abs(stamps[best] - stamp):
        best += 1
    return best


def pair_stamps(left_ns: list[int], right_ns: list[int], tolerance_ns: int) -> Pairing:
    """Pairs stamps [ns] that are at most ``tolerance_ns`` apart and each the nearest one of the other.

    The lists may be in any order, as recorders shuffle them; places in the result are places in these lists. Stamps of
    zero and repeated ones are left out.
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
