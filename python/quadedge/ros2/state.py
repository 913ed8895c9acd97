"""What /diagnostics says of the odometry."""

import time

import numpy

from ..ros_messages import diagnostics_message

_GOOD, _WARNING, _ERROR = range(3)
_KEPT_S = 10.0  # for so long a warning keeps the level at WARN; its text stays among the values


class State:
    """Conditions of the last second, and what has happened since the start."""

    def __init__(self):
        self.restarts = 0
        self._restart = ""
        self._warnings: dict[str, str] = {}  # text by kind
        self._recent: dict[str, float] = {}  # texts that keep the level, and when they came
        self._status, self._reason, self._is_lost = "waiting", "", False
        self._refused = ""
        self._unknown_since: tuple[int, str] | None = None  # stamp and reason
        self._ambiguous = ""
        self._latencies_ms: list[float] = []

    def take(self, result, doubt: str, latency_ms: float) -> None:
        """Takes a pair that was tracked or lost. doubt: why its motion is doubtful although it is tracked; or empty."""
        now = time.monotonic()
        self._latencies_ms.append(latency_ms)
        self._status, self._is_lost, self._reason = result.status, not result.is_tracked, result.message
        for warning in result.warnings:
            self._warnings[str(warning.kind)] = warning.text
            self._recent[warning.text] = now
        if result.is_tracked and doubt:
            self._status, self._reason, self._ambiguous = "ambiguous", doubt, doubt
        if self._is_lost:
            self._recent[f"lost: {result.message}"] = now - _KEPT_S + 1

    def refuse(self, why: str) -> None:
        """Takes a pair that could not be tracked."""
        self._refused = why

    def restart(self, why: str) -> None:
        """The odometry starts again."""
        self.restarts += 1
        self._restart = why
        self._recent[f"started again: {why}"] = time.monotonic()

    def place(self, stamp_ns: int, unknown: str) -> None:
        """Whether the place in the frame odom is measured. unknown: why it is not; or empty."""
        if not unknown:
            self._unknown_since = None
        elif self._unknown_since is None:
            self._unknown_since = stamp_ns, unknown

    def message(self, stamp_ns: int, silent: list[str], faults: list[str], values: dict[str, object]):
        """The message of the last second. silent: why no pairs come; faults: other faults that last."""
        now, times, self._latencies_ms = time.monotonic(), self._latencies_ms, []
        self._recent = {text: since for text, since in self._recent.items() if now - since < _KEPT_S}
        errors = silent or [text for text in (self._refused, self._reason if self._is_lost else "") if text]
        warnings = [*faults, *([self._ambiguous] if self._ambiguous else []), *self._recent]
        status = "no images" if silent else self._status
        level = _ERROR if errors else _WARNING if warnings or status == "waiting" else _GOOD
        place = "measured" if self._unknown_since is None else (
            f"not measured since {self._unknown_since[0] / 1e9:.3f} s: {self._unknown_since[1]}")
        rows = {"status": status, "reason": "; ".join(errors) or self._reason,
                "warnings": "; ".join(f"{kind}: {text}" for kind, text in self._warnings.items()),
                "place in odom": place, "restarts": self.restarts, "last restart": self._restart,
                "latency of the pair [ms]": f"{numpy.median(times):.1f}" if times else "",
                "largest latency [ms]": f"{max(times):.1f}" if times else "", **values}
        self._refused = self._ambiguous = ""
        return diagnostics_message(stamp_ns, "quadedge: stereo odometry", level,
                                   "; ".join(errors or warnings) or status, rows)
