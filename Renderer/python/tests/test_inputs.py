"""Inputs: the same image, bit for bit, whatever the package and the layout in memory."""

import os
import shutil
import sys
import tracemalloc
import types

import numpy
import pytest

import fenestra
from conftest import FEW, OPTIONS, write_slices


def render(volume, **keywords):
    return fenestra.Scene(volume, **{**OPTIONS, **keywords}).render(**FEW)


def expect_equal(image, reference):
    assert numpy.array_equal(image.rgba, reference.rgba)
    assert numpy.array_equal(image.depth, reference.depth)


class ItkImage:
    """Stands for an image of SimpleITK or ITK: LPS, array [k, j, i]."""

    def __init__(self, array, affine):
        self.array = numpy.ascontiguousarray(array.T)
        lps = numpy.diag([-1, -1, 1, 1]) @ affine
        self.spacing = tuple(numpy.linalg.norm(lps[:3, :3], axis=0))
        self.direction = lps[:3, :3] / self.spacing
        self.origin = tuple(lps[:3, 3])

    def GetSpacing(self):
        return self.spacing

    def GetOrigin(self):
        return self.origin

    def GetDirection(self):
        return self.direction if type(self).__module__ == "itk.itkImagePython" else tuple(self.direction.ravel())


@pytest.fixture(params=["SimpleITK.SimpleITK", "itk.itkImagePython"])
def itk_class(request, monkeypatch):
    package = types.ModuleType(request.param.partition(".")[0])
    if package.__name__ == "SimpleITK":
        package.GetArrayViewFromImage = lambda image: image.array
    else:
        package.array_view_from_image = lambda image: image.array
        package.array_from_matrix = numpy.asarray
    monkeypatch.setitem(sys.modules, package.__name__, package)
    return type("Image", (ItkImage,), {"__module__": request.param})


def test_itk_images_have_lps_axes_and_reversed_arrays(itk_class, subject, reference):
    volume, labels = itk_class(subject.array, subject.affine), itk_class(subject.labels, subject.affine)
    expect_equal(render(volume, segmentation=labels, labels=subject.names), reference)


def test_nibabel_images_and_paths_give_the_same_image(files, subject, reference):
    nibabel = pytest.importorskip("nibabel")
    volume, labels = nibabel.load(files.volume), nibabel.load(files.labels)
    expect_equal(render(volume, segmentation=labels, labels=subject.names), reference)
    expect_equal(render(files.volume, segmentation=labels, labels=subject.names), reference)
    expect_equal(render(volume, segmentation=str(files.labels), labels=files.names), reference)
    expect_equal(render(str(files.volume), segmentation=files.labels, labels=files.names), reference)


def test_nibabel_frames_and_units(subject, reference):
    nibabel = pytest.importorskip("nibabel")
    frames = numpy.stack([subject.array * 0, subject.array], axis=3)
    image = nibabel.Nifti1Image(frames, numpy.diag([1e-3, 1e-3, 1e-3, 1]) @ subject.affine)
    image.header.set_xyzt_units("meter")
    segments = {"segmentation": (subject.labels, subject.affine), "labels": subject.names}
    second = render(image, frame=1, **segments)
    assert numpy.allclose(second.depth, reference.depth, rtol=1e-4, equal_nan=True)
    with pytest.warns(fenestra.FenestraWarning, match="frames"):
        fenestra.Scene(image)
    with pytest.raises(ValueError, match="frame"):
        fenestra.Scene(image, frame=2)


def test_nibabel_geometry_that_is_a_guess_gives_a_warning(subject):
    nibabel = pytest.importorskip("nibabel")
    image = nibabel.Nifti1Image(subject.array, subject.affine)
    image.set_sform(None, 0)
    with pytest.warns(fenestra.FenestraWarning, match="sform"):
        fenestra.Scene(image)
    image = nibabel.Nifti1Image(subject.array, subject.affine)
    image.set_qform(numpy.diag([2, 1, 1, 1]) @ subject.affine, 1)
    with pytest.warns(fenestra.FenestraWarning, match="qform"):
        fenestra.Scene(image)


def test_types_and_layouts_give_the_same_image(subject, reference):
    flipped = subject.affine.copy()
    flipped[:, 3] = subject.affine @ (19, 0, 0, 1)
    flipped[:, 0] *= -1
    layouts = {
        "float64": (subject.array.astype(float), subject.affine),
        "big-endian": (subject.array.astype(">i2"), subject.affine),
        "big-endian float32": (subject.array.astype(">f4"), subject.affine),
        "Fortran": (numpy.asfortranarray(subject.array.astype(numpy.int64)), subject.affine),
        "part": (numpy.pad(subject.array, 3)[3:-3, 3:-3, 3:-3], subject.affine),
        "negative strides": (subject.array[::-1], flipped),
    }
    for name, (array, affine) in layouts.items():
        labels = (subject.labels.astype(array.dtype), subject.affine)
        image = render(array, affine=affine, segmentation=labels, labels=subject.names)
        if affine is subject.affine:
            assert numpy.array_equal(image.rgba, reference.rgba), name
        else:  # the voxels' order differs, and with it roundings
            assert numpy.allclose(image.depth, reference.depth, atol=0.1), name


def test_files_that_the_reader_program_reads(subject, tmp_path):
    write_slices(tmp_path / "slices", subject.labels * 50)
    with pytest.warns(fenestra.FenestraWarning, match="slices"):  # no format of pictures states axes
        camera = fenestra.Scene(tmp_path / "slices", spacing=(1.5, 1.25, 2)).camera()
        fenestra.Scene(tmp_path / "slices", spacing=(1.5, 1.25, 2)).render(**FEW)
    assert camera["target"][0] != 0


def test_masks_by_name(subject, scene, reference):
    masks = {"liver": subject.labels == 1, "body": (subject.labels == 2, subject.affine)}
    expect_equal(render(subject.array, affine=subject.affine, segmentation=masks), reference)


def test_a_mask_that_repeats_one_sample(subject):
    masks = numpy.broadcast_to(numpy.True_, subject.array.shape), numpy.ones(subject.array.shape, bool)
    one, all_of_it = (render(subject.array, affine=subject.affine, segmentation={"liver": mask}) for mask in masks)
    expect_equal(one, all_of_it)


def test_arrays_are_not_copied_by_numpy(itk_class):
    array = numpy.zeros((60, 60, 60), ">f8")
    image = itk_class(array, numpy.eye(4))
    tracemalloc.start()
    try:
        fenestra.Scene(array[::-1, :, ::-1], affine=numpy.eye(4), segmentation={"all": array == 0})
        fenestra.Scene(image)
        allocated = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert allocated < 1.5 * array.size  # bytes; the mask is one per voxel


@pytest.mark.parametrize(
    "error, argument, keywords",
    [
        (ValueError, "affine", {"affine": None}),
        (ValueError, "affine", {"affine": numpy.eye(3)}),
        (ValueError, "affine", {"affine": numpy.ones((4, 4))}),
        (fenestra.Error, "volume", {"affine": numpy.diag([1, 1, 0, 1])}),
        (ValueError, "input", {"input": numpy.zeros((3, 3))}),
        (ValueError, "input", {"input": numpy.zeros((3, 0, 3))}),
        (TypeError, "input", {"input": numpy.zeros((3, 3, 3), complex)}),
        (TypeError, "input", {"input": numpy.zeros((3, 3, 3), "f2")}),
        (TypeError, "input", {"input": [[[1]]]}),
        (ValueError, "affine", {"input": (numpy.zeros((3, 3, 3)), numpy.eye(4))}),
        (ValueError, "segmentation", {"segmentation": numpy.zeros((3, 3, 3), int)}),
        (TypeError, "segmentation", {"segmentation": 3}),
        (ValueError, "segmentation", {"segmentation": {}}),
        (ValueError, "segmentation", {"segmentation": {"liver": numpy.zeros((3, 3, 3), bool)}}),
        (TypeError, "segmentation", {"segmentation": {"liver": numpy.zeros((20, 24, 28), complex)}}),
        (fenestra.Error, "segmentation", {"segmentation": numpy.full((20, 24, 28), 0.5)}),
        (TypeError, "labels", {"labels": 3}),
        (fenestra.Error, "totalsegmentator", {"labels": "totalsegmentator"}),
        (ValueError, "labels", {"labels": {"liver": 1}}),
        (ValueError, "volume", {"volume": "1"}),
        (ValueError, "modality", {"modality": "CT"}),
        (TypeError, "view", {"view": 3}),
        (ValueError, "clip", {"clip": "surfaces"}),
        (TypeError, "clip_softness", {"clip_softness": "soft"}),
        (TypeError, "plane", {"plane": (1, 2, 3)}),
        (ValueError, "volume_smoothing", {"volume_smoothing": "on"}),
        (TypeError, "environment", {"environment": (1, 2)}),
        (TypeError, "colour", {"colour": 1}),
        (fenestra.Error, "lung", {"focus": "lung"}),
        (fenestra.Error, "view", {"view": "liver"}),
        (fenestra.Error, "density", {"density_scale": float("nan")}),
    ],
)
def test_errors_name_the_argument(subject, error, argument, keywords):
    values = {
        "input": subject.array, "affine": subject.affine, "segmentation": subject.labels, "labels": subject.names, **keywords
    }
    with pytest.raises(error, match=argument):
        fenestra.Scene(values.pop("input"), **{**OPTIONS, **values}).camera()


def test_names_of_labels(files, subject, reference):
    for labels in (subject.names, files.names):  # a dict or a table, of a file or of an array
        for segmentation in (files.labels, subject.labels):
            scene = fenestra.Scene(files.volume, segmentation=segmentation, labels=labels, **OPTIONS)
            assert scene.segments == subject.names
            expect_equal(scene.render(**FEW), reference)
    with pytest.raises(ValueError, match="^labels: .*5: 'liver'"):
        fenestra.Scene(files.volume, segmentation=files.labels, labels={"liver": 1})
    assert "focus=['liver']" in repr(scene) and "ct.nii" in repr(scene)


def test_segments_at_another_place_give_a_warning(subject):
    moved = subject.affine.copy()
    moved[2, 3] += 4
    with pytest.warns(fenestra.FenestraWarning, match="apart"):
        fenestra.Scene(
            subject.array, affine=subject.affine, segmentation=(subject.labels, moved), labels=subject.names, **OPTIONS
        ).render(**FEW)


def test_errors_of_files(files):
    with pytest.raises(fenestra.Error, match="none.nii") as caught:
        fenestra.Scene(files.folder / "none.nii").camera()
    assert (caught.value.kind, caught.value.code) == ("input", "missing-file")
    assert str(caught.value) == f"{caught.value.subject}: {caught.value.detail}"
    unnamed = os.fsdecode(os.fsencode(files.folder) + b"/\xe9.nii")  # no UTF-8
    shutil.copy(files.volume, unnamed)
    assert fenestra.Scene(unnamed).camera() == fenestra.Scene(files.volume).camera()
    with pytest.raises(fenestra.Error, match="none.nii"):
        fenestra.Scene(unnamed + "none.nii").camera()
    for keywords in ({"affine": numpy.eye(4)}, {"modality": "ct"}, {"labels": {1: "liver"}}):
        with pytest.raises((TypeError, ValueError), match=next(iter(keywords))):
            fenestra.Scene(files.volume, **keywords)
