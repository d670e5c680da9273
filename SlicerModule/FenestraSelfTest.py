"""Fenestra's part in Slicer's Python modules: the sample knee in Sample Data, and a self test."""

import slicer
from slicer.ScriptedLoadableModule import (ScriptedLoadableModule, ScriptedLoadableModuleTest,
                                           ScriptedLoadableModuleWidget)


class FenestraSelfTest(ScriptedLoadableModule):
    """In Slicer's menu of modules below Testing, which the developer mode shows, and in Self Tests."""

    def __init__(self, parent):
        ScriptedLoadableModule.__init__(self, parent)
        parent.title = "Fenestra self test"
        parent.categories = ["Testing.TestCases"]
        parent.dependencies = ["Fenestra"]
        parent.contributors = ["The Fenestra authors"]
        parent.helpText = ("Generates the sample knee, opens the view on its cartilage, renders an image, and checks "
                           "it. <b>Reload and Test</b> closes the scene.")
        slicer.app.connect("startupCompleted()", self.registerSample)

    def registerSample(self):
        try:
            import SampleData
        except ImportError:  # a Slicer without this module
            return
        SampleData.SampleDataLogic.registerCustomSampleDataSource(
            category="Fenestra", sampleName="Synthetic knee", uris="", fileNames="knee.mrml",
            thumbnailFileName=self.resourcePath("Icons/preset-knee-cartilage.png"), customDownloader=loadSample)


class FenestraSelfTestWidget(ScriptedLoadableModuleWidget):
    """Only the button Reload and Test of its base class."""

    def setup(self):
        ScriptedLoadableModuleWidget.setup(self)
        self.layout.addStretch(1)


def loadSample(source=None):
    """Generates the sample instead of a download, and returns the loaded volume in a list."""
    slicer.util.showStatusMessage("Generating the synthetic knee...")
    with slicer.util.tryWithErrorDisplay("The sample could not be generated.", waitCursor=True):
        volume = slicer.modules.fenestra.logic().LoadSample()
        if not volume:
            raise RuntimeError("The error log has the reason.")
    slicer.util.showStatusMessage("The synthetic knee is loaded.", 3000)
    return [volume]


class FenestraSelfTestTest(ScriptedLoadableModuleTest):
    def runTest(self):
        self.test_sample_view_and_image()

    def test_sample_view_and_image(self):
        slicer.mrmlScene.Clear()
        slicer.app.layoutManager().setLayout(slicer.vtkMRMLLayoutNode.SlicerLayoutFourUpView)
        logic = slicer.modules.fenestra.logic()
        self.delayDisplay("Generate and load the sample knee")
        volume = logic.LoadSample()
        self.assertIsNotNone(volume, "the error log has the reason")
        segmentation = slicer.mrmlScene.GetFirstNodeByClass("vtkMRMLSegmentationNode")

        self.delayDisplay("Open the view on the cartilage")
        self.assertIsNotNone(logic.OpenSegment(segmentation, "FemoralCartilage", True), "the view is not opened")
        view = slicer.app.layoutManager().threeDWidget(0).threeDView()
        view.forceRender()
        manager = view.displayableManagerByClassName("vtkMRMLFenestraOpeningDisplayableManager")
        self.assertTrue(manager.IsOpened())
        self.delayDisplay("The view is opened")
        logic.CloseView()

        self.delayDisplay("Render an image")
        settings = logic.GetSettings()
        for name, value in {"size": "96x72", "samples": "8", "view": "anterior"}.items():
            self.assertTrue(settings.SetFlag(name, value))
        render = logic.Render(settings, True)
        self.assertIsNotNone(render, "the error log has the reason")
        image = slicer.util.arrayFromVolume(render.GetPictureNode())[0].astype(float)
        self.assertEqual(image.shape, (72, 96, 3))
        background, knee = image[:4, :4].mean(), image[24:48, 32:64].mean()
        self.assertGreater(knee, background + 30.0, "the knee is brighter than the background")
        logic.ShowResult(render)
        self.delayDisplay("Test passed")
