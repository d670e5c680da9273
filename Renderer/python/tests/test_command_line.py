"""The command line program: the same bits, `python3 -m fenestra`, fenestra.batch."""

import os
import signal
import subprocess
import sys

import numpy
import pytest

import fenestra
from conftest import run_script

OPTIONS = ["--volume-smoothing=off", "--transfer=ct-anatomy", "--size=48x40", "--samples=2", "--quiet"]


def run(*words, **options):
    return subprocess.run([sys.executable, "-m", "fenestra", *map(str, words)], capture_output=True, text=True, **options)


def read_nrrd(path, shape):
    header, _, samples = path.read_bytes().partition(b"\n\n")
    assert b"type: float" in header and b"encoding: raw" in header
    return numpy.frombuffer(samples, "<f4").reshape(shape)


def test_images_equal_those_of_the_program(files, reference, tmp_path):
    words = [files.volume, "-s", files.labels, "--labels", files.names, "--focus=liver", *OPTIONS]
    assert run(*words, "-o", tmp_path / "image.nrrd").returncode == 0
    assert numpy.array_equal(read_nrrd(tmp_path / "image.nrrd", (40, 48, 4)), reference.rgba)
    assert numpy.array_equal(read_nrrd(tmp_path / "image-Z.nrrd", (40, 48)), reference.depth)
    assert run(*words, "-o", tmp_path / "image.png").returncode == 0
    reference.save(tmp_path / "own.png")
    pixels, own = ((tmp_path / name).read_bytes().partition(b"IDAT")[2] for name in ("image.png", "own.png"))
    assert pixels == own


def test_presets_choose_as_the_program_does(files, scene, tmp_path):
    words = [files.volume, "-s", files.labels, "--labels", files.names, "--preset=auto", "--view=left", *OPTIONS]
    assert run(*words, "-o", tmp_path / "image.nrrd").returncode == 0
    image = scene.replace(focus=None, preset="auto", view="left").render((48, 40), samples=2)
    assert image.metadata["preset"] == "liver"
    assert numpy.array_equal(read_nrrd(tmp_path / "image.nrrd", (40, 48, 4)), image.rgba)


def test_the_module_runs_the_program():
    assert fenestra.__version__ in run("--version").stdout
    assert run("missing.nii").returncode == 3


@pytest.fixture
def table(files, tmp_path):
    rows = [f"{name},{file},{name}" for name, file in (("left", files.volume), ("bad", "none.nii"), ("right", files.volume))]
    (tmp_path / "cases.csv").write_text("\n".join(["name,input,view", *rows]).replace(",bad", ",left") + "\n")
    return tmp_path / "cases.csv"


def test_batch_returns_results_as_rows_end_and_resumes(table):
    options = {"size": (24, 20), "samples": 2, "volume_smoothing": "off", "transfer": "ct-anatomy", "quality": None}
    rows = fenestra.batch(table, **options)
    first = next(rows)
    assert first.name == "left" and first.error is None and first.seconds > 0
    assert first.image == table.parent / "cases/left/left.png" and first.image.exists()
    assert first.statistics["samplesPerPixel"]["mean"] <= 2
    rows.close()
    written = first.image.stat().st_mtime_ns
    rows = list(fenestra.batch(table, **options))
    assert [row.name for row in rows] == ["left", "bad", "right"]
    assert [row.error is None for row in rows] == [True, False, True] and "none.nii" in rows[1].error
    assert rows[0].seconds == pytest.approx(first.seconds, rel=1e-2) and first.image.stat().st_mtime_ns == written
    assert rows[2].statistics != first.statistics


def test_batch_accepts_rows(files, tmp_path, monkeypatch):
    monkeypatch.chdir(files.folder)
    options = {"size": (24, 20), "samples": 2, "volume_smoothing": "off", "quality": None}
    cases = [
        {"name": "a", "input": files.volume.name, "clip_softness": 0.0, "focus": ["liver", 2], "segmentation": files.labels.name},
        {"name": "b", "input": files.volume, "view": "left", "focus": None, "segmentation": float("nan")},
    ]
    cases[0]["labels"] = files.names
    rows = list(fenestra.batch(cases, tmp_path / "results", **options))
    assert [(row.name, row.error) for row in rows] == [("a", None), ("b", None)]
    assert rows[0].image == tmp_path / "results/a/a.png" and rows[0].statistics["focusVoxels"] > 0
    again = list(fenestra.batch(cases, tmp_path / "results", **options))
    assert [row.seconds for row in again] == pytest.approx([row.seconds for row in rows], rel=1e-2)  # not rendered again
    with pytest.raises(ValueError, match="output"):
        next(fenestra.batch(cases))


def test_batch_raises_errors_of_the_table(tmp_path):
    (tmp_path / "cases.csv").write_text("name,inputs\na,b\n")
    for table, kind in ((tmp_path / "cases.csv", "input"), (tmp_path / "none.csv", "input")):
        with pytest.raises(fenestra.Error, match=table.name) as caught:
            list(fenestra.batch(table))
        assert caught.value.kind == kind
    with pytest.raises(fenestra.Error, match="workers") as caught:
        list(fenestra.batch(tmp_path / "cases.csv", workers=-1))
    assert caught.value.kind == "request"


def test_batch_writes_options_as_the_command_line():
    from fenestra._batch import _arguments

    assert _arguments("size", (24, 20)) == ["--size=24x20"]
    assert _arguments("focus", ["a,b", 5]) == ["--focus=a\\,b,5"]
    assert _arguments("plane", ((1, 2, 3), (0, 0, 1.5))) == ["--plane=1,2,3,0,0,1.5"]
    assert _arguments("material", ["a: color=#fff", "b: clip=no"]) == ["--material=a: color=#fff", "--material=b: clip=no"]
    assert _arguments("clip_softness", 0.0) == ["--clip-softness=0.0"]
    assert _arguments("restart", True) == ["--restart"] and _arguments("restart", False) == _arguments("view", None) == []
