#!/usr/bin/env python3
"""Tests scripts/long_run.py: its measurements of a process, and when it finds a run level.

test_long_run.py SCRIPTS [UNITTEST OPTION...]
"""

import contextlib
import io
import os
import sys
import unittest
from pathlib import Path

sys.path.insert(0, sys.argv[1])
import long_run  # noqa: E402


def judged(frames=1100, memory=lambda frame: 200, cost=lambda frame: 0.05):
    """The verdict on a run with this memory [MB] and processor time [s] by frame."""
    time, samples = 3, []
    for frame in range(frames + 1):
        time += cost(frame)
        samples.append((frame, memory(frame), time))
    with contextlib.redirect_stdout(io.StringIO()) as text:
        level = long_run.report(samples, [50.0] * frames)
    return level, text.getvalue()


class LongRun(unittest.TestCase):
    def test_a_level_run_is_level(self):
        level, text = judged(memory=lambda frame: 150 + 50 * min(1, frame / 90) + 4 * frame / 1000)
        self.assertTrue(level)
        self.assertIn("memory +4.0 MB", text)
        self.assertRegex(text, r"time per frame [+-]0\.0 %")

    def test_growth_of_memory_is_detected(self):
        self.assertFalse(judged(memory=lambda frame: 200 + 6 * frame / 1000)[0])
        self.assertFalse(judged(memory=lambda frame: 206 if frame == 700 else 200)[0])

    def test_growth_of_the_time_per_frame_is_detected(self):
        self.assertFalse(judged(cost=lambda frame: 0.05 * (1 + 0.3 * frame / 1000))[0])
        self.assertTrue(judged(cost=lambda frame: 0.05 * (1 + 0.1 * frame / 1000))[0])

    def test_too_few_frames_give_no_verdict(self):
        with self.assertRaises(SystemExit):
            judged(frames=250)

    def test_a_process_is_measured_and_its_end_detected(self):
        memory, seconds = long_run.memory_and_time(os.getpid())
        self.assertGreater(memory, 1)
        self.assertGreaterEqual(seconds, 0)
        self.assertIsNone(long_run.memory_and_time(2**30))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
