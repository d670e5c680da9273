"""A synthetic subject: a ball in a ball, in anisotropic voxels with an affine that is exact in float32."""

import os
import struct
import subprocess
import sys
import zlib
from types import SimpleNamespace

import numpy
import pytest

import fenestra

# Options for which the command line, which smooths volumes for display, and the package agree.
OPTIONS = {"focus": ["liver"], "volume_smoothing": "off", "transfer": "ct-anatomy"}
FEW = {"size": (48, 40), "samples": 2, "progress": False}
ENDLESS = {"size": (48, 40), "samples": 10**9}


def pytest_configure(config):
    config.addinivalue_line("filterwarnings", "ignore::fenestra.FenestraWarning")


def make_subject():
    i, j, k = numpy.indices((20, 24, 28))
    distance = (i - 9) ** 2 + (j - 11) ** 2 + (k - 13) ** 2
    array = numpy.select([distance < 16, distance < 81], [100, 40], -1000) + (i * 7 + j * 5 + k * 3) % 11
    return SimpleNamespace(
        array=array.astype(numpy.int16),
        labels=numpy.select([distance < 16, distance < 81], [1, 2], 0).astype(numpy.uint8),
        affine=numpy.array([[-1.5, 0, 0, 12], [0, 1.25, 0, -40], [0, 0, 2, 7], [0, 0, 0, 1.0]]),
        names={1: "liver", 2: "body"},
    )


def make_scene(**options):
    subject = make_subject()
    return fenestra.Scene(
        subject.array, affine=subject.affine, segmentation=subject.labels, labels=subject.names, **{**OPTIONS, **options}
    )


@pytest.fixture(scope="session")
def subject():
    return make_subject()


@pytest.fixture
def scene():
    return make_scene()


@pytest.fixture(scope="session")
def reference():
    return make_scene().render(**FEW)


@pytest.fixture(scope="session")
def files(subject, tmp_path_factory):
    """The subject as files of NIfTI."""
    nibabel = pytest.importorskip("nibabel")
    folder = tmp_path_factory.mktemp("subject")
    nibabel.save(nibabel.Nifti1Image(subject.array, subject.affine), folder / "ct.nii")
    nibabel.save(nibabel.Nifti1Image(subject.labels, subject.affine), folder / "organs.nii.gz")
    (folder / "names.csv").write_text("value,name\n1,liver\n2,body\n")
    return SimpleNamespace(
        folder=folder, volume=folder / "ct.nii", labels=folder / "organs.nii.gz", names=folder / "names.csv"
    )


def write_slices(folder, array):
    """A folder of 8-bit .png files, one per slice k, row j, column i."""
    folder.mkdir()
    for k in range(array.shape[2]):
        rows = b"".join(b"\0" + array[:, j, k].astype(numpy.uint8).tobytes() for j in range(array.shape[1]))
        header = struct.pack(">IIBBBBB", *array.shape[:2], 8, 0, 0, 0, 0)
        chunks = [(b"IHDR", header), (b"IDAT", zlib.compress(rows)), (b"IEND", b"")]
        parts = (struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks)
        (folder / f"{k:03}.png").write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(parts))


def run_script(code):
    """Runs `code`, after the subject's scene is made, in an interpreter of its own; returns what it printed. It must
    succeed and print no error."""
    start = (
        "import os, signal, sys\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)  # which a shell in the background ignores\n"
        f"sys.path.insert(0, {os.path.dirname(__file__)!r})\n"
        "from conftest import *\n"
        "scene = make_scene()\n"
    )
    result = subprocess.run([sys.executable, "-W", "ignore", "-c", start + code], capture_output=True, text=True, timeout=300)
    assert (result.returncode, result.stderr) == (0, "")
    return result.stdout
