"""Locates pairs in a saved map beside the odometry."""

import argparse
import threading
from collections.abc import Callable
from dataclasses import dataclass

import numpy

from .. import Error, Map
from ..estimates import of_base


@dataclass
class Located:
    """Where a pair was taken, in the frame of the map."""

    stamp_ns: int
    map_from_base: numpy.ndarray  #: (4, 4) [m]
    covariance: numpy.ndarray  #: (6, 6) of it [m, rad], along the axes of the map
    map_from_odom: numpy.ndarray  #: (4, 4) [m]


class Localisation:
    """Searches the newest pair in the map, in a thread of its own, because a search may take longer than a frame.

    The axes of the map are those of the base in its first pair. say: called with a sentence for the user.
    """

    def __init__(self, options: argparse.Namespace, say: Callable):
        self._options, self._say = options, say
        self._changed = threading.Condition()
        self._pair, self._found, self._state = None, [], "no pair yet"
        self._tried = self._located = 0
        self._ends, self._loads = False, True
        self._rig, self._answers = None, []
        self._age = 0  # of the frame odom: results of a search that began in another are of no use
        self._thread: threading.Thread | None = None

    def offer(self, rig, result, images: list, odom_from_base: numpy.ndarray, mount: numpy.ndarray) -> None:
        """Gives the newest pair with its pose; one that waits still is dropped. images: left, right, their masks."""
        with self._changed:
            self._pair = self._age, result.stamp_ns, images, odom_from_base, mount
            self._rig = rig
            self._changed.notify()
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="localisation")
            self._thread.start()

    def forget(self) -> None:
        """What waits, is searched, and was found, is of no use: the frame odom has changed."""
        with self._changed:
            self._pair, self._found = None, []
            self._age += 1

    def take(self) -> list[Located]:
        """What was found since the last call."""
        with self._changed:
            found, self._found = self._found, []
        return found

    def load(self) -> tuple[bool, str]:
        """Has the file of the map read again before the next search."""
        with self._changed:
            self._loads = True
        return True, f"{self._options.map} is read before the next search"

    def values(self) -> dict[str, object]:
        """For /diagnostics."""
        return {"pairs searched in the map": self._tried, "pairs located": self._located, "map": self._state}

    def close(self) -> None:
        """Ends the thread after the search in progress."""
        with self._changed:
            self._ends = True
            self._changed.notify()
        if self._thread:
            self._thread.join()

    def _run(self) -> None:
        places = None
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._ends or self._pair)
                if self._ends:
                    return
                pair, self._pair, rig = self._pair, None, self._rig
                loads, self._loads = self._loads or places is None, False
            try:
                if loads:
                    options = self._options
                    places = Map.load(options.map, rig, options.device, options.preset, options.config, follow=True)
                    self._say(f"map {options.map}: {len(places)} keyframes")
                self._search(places, *pair)
            except Error as error:
                self._state, places = str(error), None
                self._say(f"warning: {error}; pairs are not located until the map is loaded again")
                with self._changed:
                    self._changed.wait_for(lambda: self._ends or self._loads)

    def _search(self, places, age: int, stamp_ns: int, images: list, odom_from_base: numpy.ndarray,
                mount: numpy.ndarray) -> None:
        left, right, *masks = images
        found = places.localise(left, right, stamp_ns, *masks)
        self._tried += 1
        self._state = found.message or found.status
        if found.map_from_left is None:
            return
        self._located += 1
        map_from_base, covariance = of_base(found.map_from_left, found.covariance, mount)
        with self._changed:
            if age == self._age:
                self._found.append(Located(stamp_ns, map_from_base, covariance,
                                           map_from_base @ numpy.linalg.inv(odom_from_base)))
