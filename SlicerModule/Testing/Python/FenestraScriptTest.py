"""The module as scripts use it, with a sample knee: an image, wrong arguments, and the view of an image."""

import pathlib
import tempfile
import unittest

import slicer
import vtk

from FenestraTesting import process_events, read_examples, type_example, wait_for


class FenestraScriptTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        slicer.mrmlScene.Clear()
        cls.folder = tempfile.TemporaryDirectory()
        cls.logic = slicer.modules.fenestra.logic()
        cls.logic.LoadSample()
        for name, value in {"samples": "2", "size": "96x64"}.items():
            assert cls.logic.GetSettings().SetFlag(name, value)
        names = type_example(read_examples()["Render an image and get it as a numpy array"])
        cls.settings, cls.render = names["settings"], names["render"]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def errors(self, call):
        """Result of a call, and how many errors it logged."""
        messages = []
        observed = [(node, node.AddObserver("ErrorEvent", lambda *_: messages.append(1)))
                    for node in (self.logic, self.settings)]
        result = call()
        for node, tag in observed:
            node.RemoveObserver(tag)
        return result, len(messages)

    def test_tutorial(self):
        self.assertEqual(self.logic.GetClassName(), "vtkSlicerFenestraLogic")
        self.assertIsNotNone(self.render.GetNodeReference("picture"))
        self.assertEqual(self.render.GetRenderState(), self.render.Ended)
        self.assertEqual((self.render.GetProblem(), self.logic.IsRendering(self.render)), ("", False))

    def test_focus_is_a_text_or_a_list(self):
        for focus, expected in (("FemoralCartilage", ["FemoralCartilage"]), ("Femur,Tibia", ["Femur,Tibia"]),
                                (["Femur"], ["Femur"]), ((), [])):
            self.settings.SetFocus(focus)
            self.assertEqual(list(self.settings.GetFocus()), expected)
        self.settings.SetFocus("FemoralCartilage")
        self.assertTrue(self.logic.HasSurface(self.settings))
        self.assertIn("FemoralCartilage", self.logic.GetSegmentIDs(self.settings))
        self.assertIn("focus", self.settings.GetActiveFlagNames())

    def test_wrong_flags_are_errors(self):
        for name, value in (("nonsense", "1"), ("samples", "many"), ("clip", "Surface")):
            before = self.settings.GetFlag(name)
            self.assertEqual(self.errors(lambda: self.settings.SetFlag(name, value)), (False, 1))
            self.assertEqual(self.settings.GetFlag(name), before)

    def test_no_method_throws(self):
        file = f"{self.folder.name}/file"
        pathlib.Path(file).touch()
        self.assertEqual(self.errors(lambda: self.logic.WriteScene(self.settings, f"{file}/folder")), ("", 1))
        self.assertEqual(list(self.logic.GetFrameFiles("/nonexistent/" + 300 * "x")), [])
        scene = self.logic.WriteScene(self.settings, f"{self.folder.name}/new/folder")
        self.assertTrue(pathlib.Path(scene).exists())
        for missing in ("ReadResult", "Snapshot", "AddResult"):
            self.assertFalse(hasattr(self.logic, missing), missing)

    def test_failed_render_leaves_no_node(self):
        nodes = slicer.mrmlScene.GetNumberOfNodes()
        ended = []

        @vtk.calldata_type(vtk.VTK_OBJECT)
        def observe(logic, event, render):
            render.AddObserver(render.RenderEndEvent, lambda node, _: ended.append(node.GetProblem()))

        tag = self.logic.AddObserver(self.logic.RenderRequestedEvent, observe, 1.0)  # before the session
        self.settings.SetFocus(["gone"])
        self.assertIsNone(self.logic.Render(self.settings, True))
        self.logic.RemoveObserver(tag)
        self.settings.SetFocus(["FemoralCartilage"])
        self.assertEqual(len(ended), 1)
        self.assertIn("gone", ended[0])
        self.assertEqual(slicer.mrmlScene.GetNumberOfNodes(), nodes)

    def test_opened_view(self):
        """A 3D view is cut while it is opened, by the surface of the focus that the settings name."""
        for wait in (False, True):
            self.assertEqual(self.errors(lambda: self.logic.OpenView(None, wait)), (None, 1))
            self.assertEqual(self.errors(lambda: self.logic.OpenSegment(None, "Femur", wait)), (None, 1))
        slicer.app.layoutManager().setLayout(slicer.vtkMRMLLayoutNode.SlicerLayoutOneUp3DView)
        view = slicer.app.layoutManager().threeDWidget(0).threeDView()
        manager = view.displayableManagerByClassName("vtkMRMLFenestraOpeningDisplayableManager")
        self.assertIsNotNone(manager)
        opening = self.logic.OpenView(self.settings)
        self.assertEqual(self.logic.GetOpening(), opening)
        self.assertTrue(wait_for(manager.IsOpened), opening.GetProblem())
        view.forceRender()
        self.assertGreater(manager.GetSeconds(), 0.0)
        self.logic.CloseView()
        self.assertTrue(wait_for(lambda: not manager.IsOpened()))
        self.assertFalse(opening.GetVisible())

    def test_photorealistic_view(self):
        """A 3D view shows an image of its camera while that rests, at the depth of the anatomy."""
        self.assertEqual(self.errors(lambda: self.logic.ShowPhotorealistic(None)), (None, 1))
        slicer.app.layoutManager().setLayout(slicer.vtkMRMLLayoutNode.SlicerLayoutOneUp3DView)
        view = slicer.app.layoutManager().threeDWidget(0).threeDView()
        manager = view.displayableManagerByClassName("vtkMRMLFenestraOpeningDisplayableManager")
        process_events()
        opening = self.logic.ShowPhotorealistic(self.settings)
        renderer = view.renderWindow().GetRenderers().GetFirstRenderer()
        cells, depths = vtk.vtkCellPicker(), vtk.vtkWorldPointPicker()

        def pick():
            """False while the view still gets its size, after which there is another image."""
            view.forceRender()
            width, height = renderer.GetSize()
            depths.Pick(width // 2, height // 2, 0, renderer)
            return manager.IsImageShown() and cells.Pick(width // 2, height // 2, 0, renderer)

        self.assertTrue(wait_for(pick))
        apart = vtk.vtkMath.Distance2BetweenPoints(cells.GetPickPosition(), depths.GetPickPosition()) ** 0.5
        self.assertLess(apart, 2.0, (cells.GetPickPosition(), depths.GetPickPosition()))
        renderer.GetActiveCamera().Azimuth(30)
        self.assertFalse(manager.IsImageShown())
        self.assertTrue(wait_for(manager.IsImageShown))
        self.settings.SetFlag("exposure", "1")
        self.assertTrue(wait_for(manager.IsImageShown))
        self.settings.SetFlag("exposure", "")
        self.logic.HidePhotorealistic()
        self.assertTrue(wait_for(lambda: not manager.IsImageShown()))
        self.assertFalse(opening.HasImage())

    def test_click_in_the_image_takes_the_slices_there(self):
        self.logic.ShowResult(self.render)
        process_events()
        size = self.render.GetNodeReference("picture").GetImageData().GetDimensions()
        column, row, expected = size[0] // 2, size[1] // 2, [0.0, 0.0, 0.0]
        self.assertTrue(self.logic.GetImagePoint(self.render, column, row, expected))
        for outside in ((-1, 0), (size[0], 0), (float("nan"), 0)):
            self.assertFalse(self.logic.GetImagePoint(self.render, *outside, [0.0, 0.0, 0.0]))
        self.assertFalse(self.logic.GetImagePoint(None, column, row, [0.0, 0.0, 0.0]))
        view = slicer.mrmlScene.GetSingletonNode("Fenestra", "vtkMRMLSliceNode")
        to_view, to_ras = vtk.vtkMatrix4x4(), vtk.vtkMatrix4x4()
        vtk.vtkMatrix4x4.Invert(view.GetXYToRAS(), to_view)
        self.render.GetNodeReference("picture").GetIJKToRASMatrix(to_ras)
        x, y, _, _ = to_view.MultiplyPoint(to_ras.MultiplyPoint((column, row, 0, 1)))
        plane = [view.GetSliceToRAS().GetElement(axis, 3) for axis in range(3)]
        interactor = slicer.app.layoutManager().sliceWidget("Fenestra").sliceView().interactor()
        click, move = ("LeftButtonPressEvent", "LeftButtonReleaseEvent"), ("MouseMoveEvent",)
        for events, shift in ((click, 0), (move, 1)):
            for name in ("Red", "Green", "Yellow"):
                slicer.mrmlScene.GetNodeByID("vtkMRMLSliceNode" + name).SetSliceOffset(-1000.0)
            interactor.SetEventInformation(round(x), round(y), 0, shift)
            for event in events:
                interactor.InvokeEvent(event)
            for name, axis in (("Red", 2), ("Green", 1), ("Yellow", 0)):
                offset = slicer.mrmlScene.GetNodeByID("vtkMRMLSliceNode" + name).GetSliceOffset()
                self.assertAlmostEqual(offset, expected[axis], delta=3.0)  # a pixel of the small image
            crosshair = slicer.mrmlScene.GetFirstNodeByClass("vtkMRMLCrosshairNode").GetCrosshairRAS()
            self.assertLess(vtk.vtkMath.Distance2BetweenPoints(crosshair, expected) ** 0.5, 5.0)
        interactor.SetEventInformation(0, 0, 0, 1)  # beside the image: nothing is there
        interactor.InvokeEvent("MouseMoveEvent")
        crosshair = slicer.mrmlScene.GetFirstNodeByClass("vtkMRMLCrosshairNode").GetCrosshairRAS()
        self.assertLess(vtk.vtkMath.Distance2BetweenPoints(crosshair, expected) ** 0.5, 5.0)
        self.assertEqual([view.GetSliceToRAS().GetElement(axis, 3) for axis in range(3)], plane)

    def test_shown_image_is_complete(self):
        """One call shows the image's plane, completely and beside a 3D view of the same width."""
        slicer.app.layoutManager().setLayout(slicer.vtkMRMLLayoutNode.SlicerLayoutFourUpView)
        self.logic.ShowResult(self.render)
        picture = self.render.GetNodeReference("picture")
        for _ in range(2):
            view = slicer.mrmlScene.GetSingletonNode("Fenestra", "vtkMRMLSliceNode")
            to_view = vtk.vtkMatrix4x4()
            vtk.vtkMatrix4x4.Invert(view.GetXYToRAS(), to_view)
            to_ras = vtk.vtkMatrix4x4()
            picture.GetIJKToRASMatrix(to_ras)
            size = picture.GetImageData().GetDimensions()
            x0, y0, z0, _ = to_view.MultiplyPoint(to_ras.MultiplyPoint((0, 0, 0, 1)))
            x1, y1, z1, _ = to_view.MultiplyPoint(to_ras.MultiplyPoint((size[0] - 1, size[1] - 1, 0, 1)))
            width, height, _ = view.GetDimensions()
            self.assertAlmostEqual(z0, 0.0, 3)
            self.assertAlmostEqual(z1, 0.0, 3)
            self.assertTrue(0 <= x0 < x1 <= width and 0 <= y1 < y0 <= height, (x0, x1, y0, y1, width, height))
            self.assertGreater(max((x1 - x0) / width, (y0 - y1) / height), 0.8)
            process_events()
        self.assertEqual(self.logic.GetShownRender(), self.render)
        widgets = slicer.app.layoutManager()
        image, anatomy = widgets.sliceWidget("Fenestra").width, widgets.threeDWidget(0).width
        self.assertLess(abs(image - anatomy), 0.05 * image, (image, anatomy))
        self.logic.ShowLayoutBefore()
        self.assertEqual(widgets.layout, slicer.vtkMRMLLayoutNode.SlicerLayoutFourUpView)
