"""Images of other packages as volumes and segmentations of the library, without copies of their arrays."""

from __future__ import annotations

import importlib
import json
import os
import sys
import tempfile
import warnings
from typing import Any, Dict, Mapping, NamedTuple, Optional

import numpy
from numpy.typing import NDArray

from . import _fenestra


class FenestraWarning(UserWarning):
    """A doubt about a result, such as a guess about the geometry of an input."""


def warn(text: str) -> None:
    """Warns at the line outside this package that led here."""
    frame, level = sys._getframe(1), 2
    while frame.f_back and frame.f_globals.get("__package__") == __package__:
        frame, level = frame.f_back, level + 1
    warnings.warn(text, FenestraWarning, stacklevel=level)


class Grid(NamedTuple):
    """Samples [i, j, k], and the 4x4 matrix from (i, j, k, 1) to RAS mm."""

    array: NDArray[Any]
    affine: NDArray[Any]


def is_path(value: Any) -> bool:
    return isinstance(value, (str, os.PathLike))


def _check_affine(value: Any, argument: str) -> NDArray[Any]:
    affine = numpy.array(value, dtype=float)
    if affine.shape != (4, 4) or not numpy.array_equal(affine[3], [0, 0, 0, 1]):
        raise ValueError(f"{argument}: is no 4x4 matrix with the last row 0, 0, 0, 1")
    return affine


def _nibabel_affine(image: Any, argument: str) -> NDArray[Any]:
    """The image's affine, in mm, with a warning if it is a guess."""
    affine = _check_affine(image.affine, argument)
    header = image.header
    if not hasattr(header, "get_sform"):  # not NIfTI
        return affine
    sform, qform = header.get_sform(coded=True)[0], header.get_qform(coded=True)[0]
    if sform is None and qform is None:
        warn(f"{argument}: has no qform or sform; nibabel's guess of its axes and origin is used")
    elif sform is not None and qform is not None:
        corners = numpy.array([[i, j, k, 1] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
        corners[:, :3] *= numpy.subtract(image.shape[:3], 1)
        apart = numpy.linalg.norm(corners @ (sform - qform).T, axis=1).max()
        if apart > 0.5 * min(header.get_zooms()[:3]):
            warn(f"{argument}: qform and sform place its corners up to {apart:.3g} apart; the sform is used")
    millimeters = {"meter": 1000.0, "micron": 0.001}.get(header.get_xyzt_units()[0], 1.0)
    affine[:3] *= millimeters
    return affine


def _from_nibabel(image: Any, argument: str, frame: Optional[int]) -> Grid:
    if image.affine is None:
        raise ValueError(f"{argument}: the image has no affine")
    array = numpy.asarray(image.dataobj)
    if array.ndim == 4:
        frames = array.shape[3]
        if frame is None and frames > 1:
            warn(f"{argument}: has {frames} frames, of which the first is used; frame=N chooses another")
        if not 0 <= (frame or 0) < frames:
            raise ValueError(f"frame: {frame} is not from 0 to {frames - 1}")
        array = array[..., frame or 0]
    return Grid(array, _nibabel_affine(image, argument))


def _from_itk(image: Any, argument: str) -> Grid:
    """ITK has LPS coordinates, and arrays [k, j, i]."""
    axes = len(image.GetSpacing())
    if axes != 3:
        raise ValueError(f"{argument}: the image has {axes} axes, not 3")
    package = importlib.import_module(type(image).__module__.partition(".")[0])
    if hasattr(package, "GetArrayViewFromImage"):
        array, direction = package.GetArrayViewFromImage(image), image.GetDirection()
    else:
        package = importlib.import_module("itk")
        array, direction = package.array_view_from_image(image), package.array_from_matrix(image.GetDirection())
    affine = numpy.eye(4)
    affine[:3, :3] = numpy.reshape(direction, (3, 3)) * numpy.array(image.GetSpacing())
    affine[:3, 3] = image.GetOrigin()
    return Grid(numpy.asarray(array).T, numpy.diag([-1.0, -1.0, 1.0, 1.0]) @ affine)


def _to_grid(image: Any, argument: str, affine: Any = None, frame: Optional[int] = None) -> Grid:
    """`affine`: of a bare array."""
    if isinstance(image, tuple) and len(image) == 2:
        return Grid(numpy.asarray(image[0]), _check_affine(image[1], argument))
    if isinstance(image, numpy.ndarray):
        if affine is None:
            raise ValueError(f"affine: is missing; {argument} is an array, which needs one")
        return Grid(numpy.asarray(image), _check_affine(affine, "affine"))
    if hasattr(image, "dataobj") and hasattr(image, "affine"):
        return _from_nibabel(image, argument, frame)
    if hasattr(image, "GetDirection") and hasattr(image, "GetOrigin"):
        return _from_itk(image, argument)
    raise TypeError(f"{argument}: {type(image).__name__} is no path, no array and no image of nibabel, SimpleITK or ITK")


def to_volume(image: Any, affine: Any, reading: Dict[str, Any], description: Dict[str, Any]) -> _fenestra.Volume:
    if is_path(image):
        return _fenestra.read_volume(os.fsencode(image), reading)
    grid = _to_grid(image, "input", affine, reading["frame"])
    if affine is not None and not isinstance(image, numpy.ndarray):
        raise ValueError("affine: the input has an affine of its own")
    return _fenestra.Volume(grid.array, grid.affine, description)


def to_names(labels: Any) -> Dict[int, str]:
    """Names by label value, of a dict or of a table."""
    if labels is None:
        return {}
    if is_path(labels):
        return _fenestra.read_label_names(os.fsencode(labels))
    if not isinstance(labels, Mapping):
        raise TypeError("labels: is no dict, no path and no name of a table, but " + type(labels).__name__)
    try:
        return {int(value): str(name) for value, name in labels.items()}
    except (TypeError, ValueError):
        raise ValueError("labels: its keys must be label values, as in {5: 'liver'}") from None


def read_segmentation(path: Any, labels: Any, volume: _fenestra.Volume) -> _fenestra.Segmentation:
    """A dict of names becomes a table in a temporary file, as the library reads it."""
    if labels is None or is_path(labels):
        return _fenestra.read_segmentation(os.fsencode(path), None if labels is None else os.fsencode(labels), volume)
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(to_names(labels), file)
        file.flush()
        return _fenestra.read_segmentation(os.fsencode(path), os.fsencode(file.name), volume)


def to_segmentation(value: Any, labels: Any, volume: _fenestra.Volume) -> _fenestra.Segmentation:
    """`labels`: names by label value, or as fenestra.Scene takes them for a file."""
    if is_path(value):
        return read_segmentation(value, labels, volume)
    if isinstance(value, Mapping):
        masks = {str(name): _segment_grid(mask, f"segmentation[{name!r}]", volume) for name, mask in value.items()}
        if not masks:
            raise ValueError("segmentation: has no mask")
        first_name, first = next(iter(masks.items()))
        for name, mask in masks.items():
            if mask.array.shape != first.array.shape or not numpy.allclose(mask.affine, first.affine, 0, 1e-6):
                raise ValueError(f"segmentation[{name!r}]: has another grid than segmentation[{first_name!r}]")
        return _fenestra.Segmentation([(name, mask.array) for name, mask in masks.items()], first.affine)
    grid = _segment_grid(value, "segmentation", volume)
    return _fenestra.Segmentation(grid.array, grid.affine, to_names(labels))


def _segment_grid(image: Any, argument: str, volume: _fenestra.Volume) -> Grid:
    """A bare array has the grid of the volume."""
    if isinstance(image, numpy.ndarray) and image.shape != volume.shape:
        raise ValueError(f"{argument}: its shape {image.shape} is not {volume.shape}, that of the volume")
    return _to_grid(image, argument, volume.affine)
