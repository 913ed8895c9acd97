"""The draws of std::mt19937_64, with which all results so far were sampled."""

import numpy as np

_SIZE, _MIDDLE = 312, 156
_UPPER, _MATRIX = np.uint64(0xFFFFFFFF80000000), np.uint64(0xB5026F5AA96619E9)


def _next(low: np.ndarray, high: np.ndarray, far: np.ndarray) -> np.ndarray:
    mixed = (low & _UPPER) | (high & ~_UPPER)
    return far ^ (mixed >> np.uint64(1)) ^ np.where(mixed & np.uint64(1), _MATRIX, np.uint64(0))


class Draws:
    """A sequence of draws from a seed."""

    def __init__(self, seed: int):
        values = [seed % 2**64]
        for i in range(1, _SIZE):
            values.append((6364136223846793005 * (values[-1] ^ (values[-1] >> 62)) + i) % 2**64)
        self._state, self._unused = np.array(values, np.uint64), np.empty(0, np.uint64)

    def numbers(self, count: int) -> np.ndarray:
        """(count,) uint64."""
        blocks = [self._unused]
        while sum(map(len, blocks)) < count:
            old, new = self._state, np.empty_like(self._state)
            new[:_MIDDLE] = _next(old[:_MIDDLE], old[1:_MIDDLE + 1], old[_MIDDLE:])
            new[_MIDDLE:] = _next(old[_MIDDLE:], np.append(old[_MIDDLE + 1:], new[0]), new[:_MIDDLE])
            self._state, x = new, new.copy()
            for shift, mask in ((-29, 0x5555555555555555), (17, 0x71D67FFFEDA60000), (37, 0xFFF7EEE000000000),
                                (-43, -1)):
                moved = x << np.uint64(shift) if shift > 0 else x >> np.uint64(-shift)
                x ^= moved & np.uint64(mask % 2**64)
            blocks.append(x)
        drawn = np.concatenate(blocks)
        self._unused = drawn[count:]
        return drawn[:count]

    def indices(self, count: int, size: int) -> np.ndarray:
        """(count,): uniform in 0 .. size - 1."""
        return ((self.numbers(count) >> np.uint64(11)).astype(float) * 2.0**-53 * size).astype(int)
