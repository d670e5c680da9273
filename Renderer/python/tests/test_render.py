"""Rendering: results, progress, stops, threads, processes."""

import gc
import threading

import numpy
import pytest

import fenestra
from conftest import ENDLESS, FEW, make_scene, run_script


def stop_with(action):
    """A progress function that acts once there are samples."""
    return lambda fraction, seconds, noise: action() if noise < float("inf") else None


def test_arrays_are_views_that_keep_the_image_alive(reference):
    shapes = {"rgba": (40, 48, 4), "denoised": (40, 48, 4), "depth": (40, 48), "clip_depth": (40, 48)}
    shapes.update({"normals": (40, 48, 3), "albedo": (40, 48, 3), "error": (40, 48, 3), "sample_counts": (40, 48)})
    for name, shape in shapes.items():
        array = getattr(reference, name)
        assert (array.shape, array.dtype) == (shape, numpy.float32), name
        assert not array.flags.writeable and not array.flags.owndata, name
        assert array.base is reference and array.ctypes.data == getattr(reference, name).ctypes.data, name
    image = make_scene().render(**FEW)
    array = image.rgba
    del image
    gc.collect()
    assert numpy.array_equal(array, reference.rgba)
    assert reference.samples == 2 and reference.complete and (reference.width, reference.height) == (48, 40)
    assert reference.sample_counts.max() == 2 and "seed" in reference.metadata
    plain = make_scene(clip="none").render(denoise=False, **FEW)
    assert plain.denoised is None and plain.clip_depth is None and plain.denoised_noise == float("inf")


def test_device(reference):
    image = make_scene().render(device="gpu", **FEW)
    if image.metadata["target"] == reference.metadata["target"]:  # no GPU
        assert numpy.array_equal(image.rgba, reference.rgba)
    assert image.complete and image.samples == reference.samples
    with pytest.raises(ValueError, match="device"):
        make_scene().render(device="tpu", **FEW)


def test_display_png_and_files(reference, tmp_path):
    pixels = reference.display()
    assert (pixels.shape, pixels.dtype) == ((40, 48, 4), numpy.uint8)
    assert reference.display(exposure=2)[..., :3].mean() > pixels[..., :3].mean()
    assert reference.png() == reference._repr_png_() and reference.png().startswith(b"\x89PNG")
    assert reference.png(scale=True, orientation=True) != reference.png()
    reference.save(tmp_path / "image.png")
    assert (tmp_path / "image.png").read_bytes() == reference.png()
    with pytest.raises(TypeError, match="brightness"):
        reference.display(brightness=1)
    with pytest.raises(fenestra.Error) as caught:
        reference.save(tmp_path / "missing" / "image.png")
    assert caught.value.kind == "output"


def test_a_replaced_scene_equals_a_new_one(scene, reference):
    left = scene.replace(view="left")
    assert numpy.array_equal(left.render(**FEW).rgba, make_scene(view="left").render(**FEW).rgba)
    assert numpy.array_equal(left.replace(view=None).render(**FEW).rgba, reference.rgba)
    with pytest.raises(TypeError, match="affine"):
        scene.replace(affine=numpy.eye(4))


def test_render_options(scene):
    assert scene.render((24, 20), quality="draft").samples == 16
    assert scene.render((24, 20), quality="draft", samples=3).samples == 3
    assert numpy.all(scene.render((24, 20), samples=1, background="transparent").rgba[0, 0] == 0)
    with pytest.raises(ValueError, match="quality"):
        scene.render(quality="best")
    with pytest.raises(TypeError, match="size"):
        scene.render(size=512)


def test_the_turntable_turns_the_camera_about_up(scene, reference):
    frames = list(scene.turntable(4, **FEW))
    assert numpy.array_equal(frames[0].rgba, reference.rgba)
    left, right = (scene.replace(view=view, scale=scene.camera(FEW["size"])["scale"]) for view in ("left", "right"))
    for frame, view in ((1, left), (3, right)):
        depth = view.render(**FEW).depth
        assert numpy.allclose(frames[frame].depth, depth, atol=0.1), frame


def test_camera_choices_and_surface(scene, tmp_path):
    camera = scene.camera(FEW["size"])
    assert scene.replace(**camera).camera(FEW["size"]) == camera
    assert any("ct-anatomy" in choice for choice in scene.choices())
    surface = scene.clip_surface(FEW["size"])
    assert surface.points.shape == (len(surface.depths), 3) and surface.triangles.max() == len(surface.points) - 1
    surface.save(tmp_path / "surface.ply")
    assert (tmp_path / "surface.ply").stat().st_size > 100


def test_warnings_come_once_per_scene(subject):
    array = subject.array.astype(numpy.float32)
    array[0, 0, 0] = numpy.nan
    with pytest.warns(fenestra.FenestraWarning) as caught:
        scene = fenestra.Scene(array, affine=subject.affine, volume_smoothing="off")
        scene.render(**FEW)
        scene.replace(view="left").render(**FEW)
    texts = [str(warning.message) for warning in caught]
    assert len(texts) == len(set(texts)) and any("not a number" in text for text in texts)
    assert {warning.filename for warning in caught} == {__file__}


def test_progress(scene):
    calls = []
    image = scene.render((200, 200), samples=32, progress=lambda *values: calls.append(values))
    assert image.complete and calls == sorted(calls) and calls[0][0] == 0.0 and calls[-1][0] <= 1.0


def test_the_bar_ends_at_100_percent_unless_the_render_was_stopped(capsys):
    pytest.importorskip("tqdm")
    assert make_scene().render((24, 20), samples=1, progress=True).complete
    assert "100%" in capsys.readouterr().err
    code = "threading.Timer(1, lambda: os.kill(os.getpid(), signal.SIGINT)).start()\nsys.stderr = sys.stdout\n"
    attempt = "try: scene.render(**ENDLESS, progress=True)\nexcept KeyboardInterrupt: pass\n"  # before the first sample
    shown = run_script("import threading\n" + code + attempt)
    assert "render:" in shown and "100%" not in shown


def test_a_stop_returns_the_samples_so_far(scene):
    calls = []
    image = scene.render(**ENDLESS, progress=stop_with(lambda: calls.append(1) or False))
    assert not image.complete and 0 < image.samples < 10**9 and len(calls) == 1
    with pytest.raises(fenestra.Error) as caught:
        make_scene().render((800, 800), progress=lambda *values: False)
    assert caught.value.code == "stopped"
    assert len(list(scene.turntable(4, **ENDLESS, progress=stop_with(lambda: False)))) == 1


def test_an_exception_of_the_callback_ends_the_render(scene):
    with pytest.raises(ZeroDivisionError):
        scene.render(**ENDLESS, progress=stop_with(lambda: 1 / 0))
    assert scene.render(**FEW).complete


def test_ctrl_c_keeps_the_samples():
    print_image = "print(image.complete, 0 < image.samples < 10**9)"
    interrupt = "interrupt = lambda *values: os.kill(os.getpid(), signal.SIGINT)\n"
    in_callback = "image = scene.render(**ENDLESS, progress=lambda f, s, noise: interrupt() if noise < 1e9 else None)\n"
    assert run_script(interrupt + in_callback + print_image) == "False True\n"
    # Without a callback: the other thread waits until there surely are samples, which a few lines show.
    from_thread = (
        "import threading\n"
        "threading.Timer(2, interrupt).start()\n"
        "try: image = scene.render(**ENDLESS, progress=False); " + print_image + "\n"
        "except KeyboardInterrupt: print('False True')\n"
    )
    assert run_script(interrupt + from_thread) == "False True\n"


def test_ctrl_c_without_samples_or_in_a_turntable_raises():
    interrupt = "interrupt = lambda *values: signal.raise_signal(signal.SIGINT)\n"
    attempt = "try: {}\nexcept KeyboardInterrupt: print('interrupted')\n"
    first = attempt.format("scene.render((800, 800), progress=interrupt)")
    frames = attempt.format("list(scene.turntable(4, **ENDLESS, progress=lambda f, s, noise: interrupt() if noise < 1e9 else None))")
    assert run_script(interrupt + first + frames) == "interrupted\n" * 2


def test_scenes_in_threads_give_the_same_images(reference):
    left = make_scene(view="left").render(**FEW)
    results = {}

    def work(name, scene):
        results[name] = [scene.render(**FEW).rgba for _ in range(5)]

    shared = make_scene()
    scenes = {"own": make_scene(), "shared": shared, "shared too": shared, "left": shared.replace(view="left")}
    threads = [threading.Thread(target=work, args=item) for item in scenes.items()]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert set(results) == set(scenes)
    for name, images in results.items():
        for image in images:
            assert numpy.array_equal(image, (left if name == "left" else reference).rgba), name


def test_scenes_are_freed():
    growth = run_script(
        """
import gc, resource
def resident():
    gc.collect()
    return int(open("/proc/self/statm").read().split()[1]) * resource.getpagesize()
def use():
    volume = numpy.zeros((32, 32, 32), numpy.int16)
    volume[8:16, 8:16, 8:16] = 100
    fenestra.Scene((volume, numpy.eye(4)), volume_smoothing="off", transfer="ct-anatomy").render((4, 4), samples=1, progress=False)
for _ in range(40): use()
before = resident()
for _ in range(200): use()
print(resident() - before)
"""
    )
    assert int(growth) < 4e6  # the volumes have 13e6 bytes


BUSY = """
import threading
started = threading.Event()
def work():
    while True:
        scene.render((48, 40), samples={samples}, progress=lambda *values: started.set())
        started.set()
threading.Thread(target=work, daemon=True).start()
started.wait()
"""


@pytest.mark.parametrize("start", ["scene.render(**FEW)\n", BUSY.format(samples=10**9)])
def test_a_forked_child_does_not_hang(start):
    code = """
child = os.fork()
if child == 0:
    try: scene.render(**FEW); print("rendered", flush=True)
    except fenestra.Error as error: print("error", flush=True)
    sys.exit()
assert os.waitpid(child, 0)[1] == 0
"""
    assert run_script(start + code) == "error\n"


@pytest.mark.parametrize("samples", [2, 10**9])
def test_the_interpreter_ends_while_a_thread_renders(samples):
    assert run_script(BUSY.format(samples=samples)) == ""
