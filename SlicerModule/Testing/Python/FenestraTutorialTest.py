"""Types the tutorial's examples in Python, and checks what each should have done."""

import os
import unittest

import slicer
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from FenestraTesting import process_events, read_examples, type_example, wait_for

EXAMPLES = read_examples()


def read_png(file):
    reader = vtk.vtkPNGReader()
    reader.SetFileName(file)
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    colors = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    return colors.reshape(height, width, -1)[::-1]  # the upper row first


class FenestraTutorialTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        slicer.mrmlScene.Clear()
        cls.logic = slicer.modules.fenestra.logic()
        assert cls.logic.LoadSample().GetName() == "knee"

    def setUp(self):
        slicer.app.layoutManager().setLayout(slicer.vtkMRMLLayoutNode.SlicerLayoutFourUpView)
        settings = self.logic.GetSettings()
        settings.SetFocus([])
        settings.SetVolumeNode(None)
        settings.SetSegmentationNode(None)
        for name, value in {"samples": "2", "size": "96x64"}.items():
            self.assertTrue(settings.SetFlag(name, value))

    def type(self, heading):
        return type_example(EXAMPLES[heading])

    def test_every_example_is_typed(self):
        source = open(__file__).read()
        self.assertEqual(len(EXAMPLES), 5)
        for heading in EXAMPLES:
            self.assertIn(f'self.type("{heading}")', source)

    def test_image_as_array(self):
        names = self.type("Render an image and get it as a numpy array")
        image = names["image"]
        self.assertEqual(image.shape, (64, 96, 3))
        self.assertGreater(image[16:48, 32:64].mean(), image[:4, :4].mean() + 30.0)
        self.assertEqual(names["render"].GetFlag("focus"), "FemoralCartilage")
        self.assertIsNotNone(names["render"].GetNodeReference("surface"), "the focus was opened")

    def test_opened_view(self):
        names = self.type("Open the view on a segment and look at it")
        view, camera = names["threeDView"], names["camera"]
        center = names["segmentation"].GetSegmentCenterRAS("FemoralCartilage")
        for axis in range(3):
            self.assertAlmostEqual(camera.GetFocalPoint()[axis], center[axis], 3)
        direction = [camera.GetPosition()[axis] - center[axis] for axis in range(3)]
        self.assertGreater(direction[1], 0.99 * vtk.vtkMath.Norm(direction), "from anterior")
        manager = view.displayableManagerByClassName("vtkMRMLFenestraOpeningDisplayableManager")
        view.forceRender()
        self.assertTrue(manager.IsOpened())
        self.assertEqual(list(self.logic.GetSettings().GetFocus()), ["FemoralCartilage"])

        opened = view.grab().toImage()
        self.logic.CloseView()
        self.assertTrue(wait_for(lambda: not manager.IsOpened()))
        view.forceRender()
        self.assertNotEqual(opened, view.grab().toImage())

    def test_photorealistic_view(self):
        file = slicer.app.temporaryPath + "/knee view.png"
        names = self.type("Show the photorealistic view and wait for its image")
        self.assertTrue(names["opening"].HasImage())
        shown = read_png(file)
        self.assertGreater(shown.std(), 10.0)
        self.logic.HidePhotorealistic()
        view = names["threeDView"]
        manager = view.displayableManagerByClassName("vtkMRMLFenestraOpeningDisplayableManager")
        self.assertTrue(wait_for(lambda: not manager.IsImageShown()))
        view.forceRender()
        view.grab().save(file)
        self.assertGreater(abs(read_png(file).astype(float) - shown).mean(), 1.0, "the image replaced the rendering")
        os.remove(file)

    def test_background_render(self):
        self.logic.GetSettings().SetFlag("samples", "64")
        names = self.type("Render in the background, with events for progress and end")
        render = names["render"]
        self.assertTrue(render.IsRendering(), "the call returned before the end")
        fractions = []
        render.AddObserver(render.RenderProgressEvent, lambda node, _: fractions.append(node.GetProgress()))
        self.assertTrue(wait_for(lambda: self.logic.GetShownRender() == render), "the end shows the image")
        self.assertFalse(render.IsRendering())
        self.assertEqual(fractions, sorted(fractions))
        self.assertEqual(fractions[-1], 1.0)

    def test_series(self):
        files = [f"{slicer.app.temporaryPath}/{segment} {view}.png"
                 for segment in ("FemoralCartilage", "Patella") for view in ("anterior", "left")]
        for file in files:
            if os.path.exists(file):
                os.remove(file)
        names = self.type("Save a series of views as PNG files")
        images = [read_png(file) for file in files]
        for i, image in enumerate(images):
            self.assertEqual(image.shape, (64, 96, 3))
            self.assertTrue(all((image != other).any() for other in images[:i]), "each is another image")
        last = slicer.util.arrayFromVolume(names["render"].GetPictureNode())[0]
        self.assertTrue((last == images[-1]).all(), "the file has the colors of the scene")
        self.assertEqual(self.logic.GetSettings().GetFlag("view"), "")
        process_events()
