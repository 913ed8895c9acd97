"""Shows results in rerun's viewer. Needs rerun-sdk (the extra ``view``).

    viewer = quadedge.view.Viewer(save="flight.rrd")     # or web=True; without either, a window opens
    for frame in dataset:
        result = odometry.track(frame.stamp_ns, frame.left, frame.right)
        viewer.log(odometry, result, frame.left, frame.right)

``python -m quadedge.view RESULTS`` shows the results of ``quadedge run``.
"""

from .results import Run
from .viewer import Viewer

__all__ = ["Run", "Viewer"]
