"""Results to look at in rerun's viewer: ``pip install quadedge[view]``.

    viewer = quadedge.view.Viewer(save="flight.rrd")     # or web=True, or neither: a window
    for frame in dataset:
        result = odometry.track(frame.stamp_ns, frame.left, frame.right)
        viewer.log(odometry, result, frame.left, frame.right)

``python -m quadedge.view RESULTS`` shows what ``quadedge run`` has left.
"""

from .results import show_results
from .viewer import Viewer

__all__ = ["Viewer", "show_results"]
