"""Photorealistic images of medical volumes with an unobstructed view of the segments of interest.

    import fenestra
    scene = fenestra.Scene("ct.nii.gz", segmentation="organs.nii.gz", focus=["liver"], view="auto")
    image = scene.render(size=(1024, 1024), quality="normal")
    image.save("liver.png")

World coordinates are RAS, millimeters, as in nibabel; array[i, j, k] is the sample at affine @ (i, j, k, 1).
"""

import atexit
import os
import sys
from pathlib import Path

try:
    from . import _fenestra
except ImportError as error:
    _built = ", ".join(path.name for path in Path(__file__).parent.glob("_fenestra.*.so")) or "nothing"
    raise ImportError(f"{error}; this is Python {sys.version.split()[0]}, and the package has {_built}") from error
from ._batch import BatchRow, batch
from ._fenestra import ClipSurface, Error, Image
from ._inputs import FenestraWarning
from ._scene import Scene

__all__ = ["BatchRow", "ClipSurface", "Error", "FenestraWarning", "Image", "Scene", "batch"]
__version__: str = _fenestra.version

for _class in (ClipSurface, Image):
    _class.__module__ = "fenestra"

# Threads that are still rendering must not return to an interpreter that has ended.
atexit.register(_fenestra.end_all)
os.register_at_fork(after_in_child=_fenestra.forget_all)
