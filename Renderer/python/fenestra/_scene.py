"""fenestra.Scene."""

from __future__ import annotations

import os
from typing import Any, Dict, Iterator, List, Mapping, Optional, Tuple

import numpy

from . import _fenestra, _inputs, _progress

_READING = ("volume", "frame", "spacing")
_DESCRIPTION = ("name", "modality", "contrast_agent")


class Scene:
    """A volume with its segments, view, clip and appearance. Immutable; several threads may use one scene.

    input: path of a volume, a DICOM folder or a Slicer scene (.mrml, .mrb); an image of nibabel, SimpleITK or ITK; an
        array [i, j, k] of integers, bool, float32 or float64 with `affine`, or a pair (array, affine)
    affine: 4x4 matrix from (i, j, k, 1) to RAS mm, of an array
    segmentation: path; label map (0: background) as `input`; or masks by name, {"liver": mask}. An array without affine
        has the grid of the volume. Of a Slicer scene also a segmentation by name or id
    labels: names by label value, {1: "liver"}; or a table: a file, totalsegmentator1, totalsegmentator2 or freesurfer.
        By default names in or beside the file of the segmentation. Versions 1 and 2 of TotalSegmentator number organs
        differently: of the wrong one, another organ is shown
    name, modality ("ct", "mr", "ultrasound" or "pet"), contrast_agent: description of a volume in memory. Samples of CT
        are Hounsfield units
    volume: of several in a file, a node of a scene by name or id, or a series of a folder by number
    frame: of several, from 0
    spacing: (x, y, z) mm, of a file that states none

    The other keywords are the options of the command line (`python3 -m fenestra --help all`), with _ for -. None has
    the default that is described there. Lengths are mm, positions RAS, colors linear Rec. 709.

    preset: of an organ, such as "liver", a file, or "auto": the one that suits the names of the segments. Supplies the
        focus and other options that are None
    focus: segments to show unobstructed: one, or a list, of names or label values
    margin: grows the focus: one number, or one per segment
    view: "anterior", "posterior", "left", "right", "superior", "inferior", or "auto": shows most of the focus
    projection: "orthographic" or "perspective"
    clip: "auto", "none", "plane", "cutaway", "surface", "hole" or "ghost"
    clip_boundary: "exact" or "spline"
    hole: "box", "cylinder" or "sphere"
    plane: ((x, y, z), (nx, ny, nz)), a point and a normal
    gradient: "sobel" or "central"
    table: of the scanner, "auto", "keep" or "remove"
    materials: "none", "library", "contrast" or a path
    volume_smoothing: "auto", "off", or the standard deviation of the noise
    transfer, lights: a name, a path, JSON, or a dict that is written as JSON
    environment: a gray, (r, g, b), or the path of an .exr image

    Raises fenestra.Error, or ValueError and TypeError, which name the argument. Warnings are of the category
    fenestra.FenestraWarning. What takes long is computed on first use, and so files are read; names of segments are
    checked now.
    """

    def __init__(
        self,
        input: Any,
        /,
        *,
        affine: Any = None,
        segmentation: Any = None,
        labels: Any = None,
        name: Optional[str] = None,
        modality: Optional[str] = None,
        contrast_agent: Optional[bool] = None,
        volume: Optional[str] = None,
        frame: Optional[int] = None,
        spacing: Any = None,
        preset: Any = None,
        focus: Any = None,
        margin: Any = None,
        label_smoothing: Optional[float] = None,
        view: Optional[str] = None,
        position: Any = None,
        target: Any = None,
        up: Any = None,
        projection: Optional[str] = None,
        scale: Optional[float] = None,
        angle: Optional[float] = None,
        clip: Optional[str] = None,
        clip_boundary: Optional[str] = None,
        control_points: Optional[int] = None,
        spline_smoothing: Optional[float] = None,
        plane: Any = None,
        hole: Optional[str] = None,
        hole_margin: Optional[float] = None,
        ghost: Optional[float] = None,
        clip_offset: Optional[float] = None,
        clip_softness: Optional[float] = None,
        transfer: Any = None,
        transfer_shift: Optional[float] = None,
        density_scale: Optional[float] = None,
        gradient: Optional[str] = None,
        volume_smoothing: Any = None,
        table: Optional[str] = None,
        materials: Any = None,
        material: Any = None,
        lights: Any = None,
        environment: Any = None,
        context_density: Optional[float] = None,
        context_saturation: Optional[float] = None,
    ) -> None:
        keywords = dict(locals())
        for known in ("self", "input", "affine", "segmentation", "labels"):
            del keywords[known]
        reading = {key: keywords.pop(key) for key in _READING}
        description = {key: keywords.pop(key) for key in _DESCRIPTION}
        self._options: Dict[str, Any] = keywords
        self._warned: set[str] = set()
        is_file = _inputs.is_path(input)
        for key, value in (description if is_file else {"volume": volume, "spacing": spacing}).items():
            if value is not None:
                raise ValueError(f"{key}: is for {'an input in memory' if is_file else 'files'}")
        if is_file and affine is not None:
            raise ValueError("affine: is for an array")
        self._name = os.fspath(input) if is_file else name or type(input).__name__
        if segmentation is None and isinstance(labels, Mapping):
            raise ValueError("labels: are for a segmentation, which is missing")
        if is_file and not isinstance(labels, Mapping) and (segmentation is None or _inputs.is_path(segmentation)):
            segments_path = None if segmentation is None else os.fsencode(segmentation)
            self._scene = _fenestra.read_scene(
                os.fsencode(input), segments_path, None if labels is None else os.fsencode(labels), keywords, reading
            )
            return
        body = _inputs.to_volume(input, affine, reading, description)
        segments = None if segmentation is None else _inputs.to_segmentation(segmentation, labels, body)
        self._scene = _fenestra.Scene(body, segments, keywords)
        self._warn(body.warnings() + (segments.warnings() if segments else []))

    def replace(self, **options: Any) -> Scene:
        """The scene with other options: keywords of Scene() from `preset` on; None restores a default. Shares all that
        does not differ, so that only what changes is computed again."""
        changed = object.__new__(Scene)
        changed._options = {**self._options, **options}
        changed._scene = self._scene.with_options(changed._options)
        changed._warned = self._warned
        changed._name = self._name
        return changed

    def render(
        self,
        size: Tuple[int, int] = (512, 512),
        *,
        quality: Optional[str] = None,
        samples: Optional[int] = None,
        seconds: Optional[float] = None,
        noise: Optional[float] = None,
        denoise: bool = True,
        bounces: Optional[int] = None,
        seed: int = 0,
        threads: int = 0,
        device: str = "cpu",
        background: Any = None,
        progress: _progress.Progress = None,
    ) -> _fenestra.Image:
        """Renders an image of `size` (width, height) in pixels.

        quality: "draft", "normal", "high" or "final": stands for the limits samples, seconds and noise, any of which
            replaces it. By default 64 samples
        samples: limit of the mean number per pixel
        seconds: limit of the time
        noise: limit of the noise, of the denoised image if there is one, such as 0.03
        denoise: adds image.denoised
        bounces: limit of the scatterings per path, by default none
        seed: the same seed gives the same image, bit for bit, whatever the number of threads
        threads: 0: all cores
        device: "cpu", or "gpu": renders on a GPU where there is one for the scene, else on the CPU. The image's
            metadata state the "target"
        background: "dark", "gray", "gradient", "transparent", "environment", a number for gray, or (r, g, b). By default
            that of a Slicer scene, else dark
        progress: True: a bar (tqdm); None: a bar in a terminal or notebook; or a function of (fraction, seconds,
            noise), called several times per second; if it returns False, the render stops

        Ctrl-C stops the render too. A stopped render returns the image of the samples so far, with image.complete
        False; without any it raises KeyboardInterrupt, or fenestra.Error with the code "stopped". Raises fenestra.Error,
        and what `progress` raises.
        """
        options = {key: value for key, value in locals().items() if key not in ("self", "progress")}
        return self._render(options, progress, keeps_interrupted=True)

    def _render(self, options: Dict[str, Any], progress: _progress.Progress, keeps_interrupted: bool) -> _fenestra.Image:
        with _progress.callback(progress) as on_progress:
            image = _fenestra.render(self._scene, options, on_progress, keeps_interrupted)
            if on_progress and on_progress is not progress and image.complete:
                on_progress(1.0, 0.0, float("inf"))  # the bar's last state
        self._warn(self._scene.warnings(image.width, image.height))
        return image

    def turntable(self, frames: int = 36, *, degrees: float = 360.0, **options: Any) -> Iterator[_fenestra.Image]:
        """Images of the scene as the camera turns around its target, about `up`: frame n by n / frames of `degrees`.
        The options are those of render(). Ctrl-C raises KeyboardInterrupt; after a frame that was stopped otherwise,
        the turntable ends."""
        progress = options.pop("progress", None)
        camera = self.camera(options.get("size", (512, 512)))
        target, axis = numpy.array(camera["target"]), numpy.array(camera["up"])
        axis /= numpy.linalg.norm(axis)
        arm = numpy.subtract(camera["position"], target)
        along = axis * (axis @ arm)
        for frame in range(frames):
            turn = numpy.radians(degrees * frame / frames)
            turned = along + (arm - along) * numpy.cos(turn) + numpy.cross(axis, arm) * numpy.sin(turn)
            scene = self.replace(**{**camera, "view": None, "position": tuple(target + turned)})
            image = scene._render(options, progress, keeps_interrupted=False)
            yield image
            if not image.complete:
                return

    @property
    def segments(self) -> Dict[int, str]:
        """Names of the segments by label value: what `focus` chooses from. Raises fenestra.Error."""
        return dict(self._scene.segments())

    def __repr__(self) -> str:
        given = ", ".join(f"{key}={value!r}" for key, value in self._options.items() if value is not None)
        return f"<fenestra.Scene {self._name}{': ' if given else ''}{given}>"

    def camera(self, size: Tuple[int, int] = (512, 512)) -> Dict[str, Any]:
        """Camera of an image of this size, as keywords of replace(): projection; position, target and up in RAS mm; scale
        (half the height in mm) or angle (vertical, degrees). Raises fenestra.Error."""
        return self._scene.camera(*size)

    def choices(self, size: Tuple[int, int] = (512, 512)) -> List[str]:
        """What was chosen for an image of this size, like "transfer function: ct-anatomy (by modality)". Raises
        fenestra.Error."""
        return self._scene.choices(*size)

    def clip_surface(self, size: Tuple[int, int] = (512, 512)) -> _fenestra.ClipSurface:
        """The clipping surface for an image of this size. Raises fenestra.Error if the clip is no surface."""
        return self._scene.clip_surface(*size)

    def _warn(self, texts: List[str]) -> None:
        for text in texts:
            if text not in self._warned:
                self._warned.add(text)
                _inputs.warn(text)
