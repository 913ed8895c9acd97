"""A Session releases its device whatever happens to its results."""

import argparse

import numpy as np
import pytest

import quadedge
from quadedge.session import Session


def test_a_session_that_cannot_finish_releases_the_device(tmp_path, monkeypatch):
    rig = quadedge.synthetic(frames=2, width=96, height=64)
    options = argparse.Namespace(output=None, force=False, device="reference", preset="fast", config=None, loops=False)
    session = Session(rig, options, print)
    session.begin_files(str(tmp_path / "out"), "room")
    black = np.zeros((64, 96), np.uint8)
    session.track(0, black, black)
    (tmp_path / "out/report.json").mkdir()  # where a file should be written
    with pytest.raises(quadedge.DataError):
        session.close()
    with pytest.raises(quadedge.UsageError, match="closed"):
        session.odometry.track(1, black, black)
