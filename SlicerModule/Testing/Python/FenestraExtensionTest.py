"""The module as a part of Slicer: sample data, self test, application settings, and the error log."""

import os
import pathlib
import tempfile
import time
import unittest

import qt
import slicer

from FenestraTesting import Log, process_events, wait_for


class FenestraExtensionTest(unittest.TestCase):
    def setUp(self):
        self.logic = slicer.modules.fenestra.logic()
        self.panel = slicer.util.findChild(slicer.app.settingsDialog(), "qSlicerFenestraSettingsPanel")
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.addCleanup(self.reset)

    def reset(self):
        self.logic.HidePhotorealistic()
        self.panel.executable = self.panel.temporaryFolder = ""
        self.panel.device = "auto"
        slicer.util.findChild(self.panel, "ThreadsBox").value = 0

    def load(self):
        """Settings for a small image of the sample."""
        slicer.mrmlScene.Clear()
        volume = self.logic.LoadSample()
        settings = self.logic.GetSettings()
        settings.SetVolumeNode(volume)
        settings.SetSegmentationNode(slicer.util.getNode("knee segments"))
        settings.SetFocus(["FemoralCartilage"])
        for name, value in {"samples": "2", "size": "64x48"}.items():
            settings.SetFlag(name, value)
        return settings

    def choose(self, name, text):
        """Types a text and leaves the field. Returns the text of the label below."""
        edit = slicer.util.findChild(self.panel, f"{name}Edit")
        state = slicer.util.findChild(self.panel, f"{name}StateLabel")
        edit.setText(text)
        edit.editingFinished()
        self.assertTrue(wait_for(lambda: not state.text.startswith("Checking")))
        return state.text

    def write_program(self, name, lines):
        file = pathlib.Path(self.folder.name) / name
        file.write_text("#!/bin/sh\n" + lines + "\n")
        file.chmod(0o755)
        return str(file)

    def test_self_test(self):
        """The code of Slicer's menu."""
        self.assertEqual(list(slicer.modules.fenestraselftest.categories), ["Testing.TestCases"])
        slicer.selfTests["FenestraSelfTest"]()

    def test_sample_data(self):
        slicer.mrmlScene.Clear()
        slicer.util.selectModule("SampleData")
        widget = slicer.modules.SampleDataWidget.parent
        box = slicer.util.findChild(widget, "FenestraCollapsibleGroupBox")
        button = slicer.util.findChild(box, "Synthetic kneePushButton")
        self.assertFalse(button.icon.isNull())
        self.assertTrue(button.visible)
        button.click()
        self.assertEqual(slicer.util.getNode("knee").GetImageData().GetDimensions(), (240, 276, 96))
        self.assertEqual(slicer.util.getNode("knee segments").GetSegmentation().GetNumberOfSegments(), 40)

    def test_settings_reach_the_next_process(self):
        settings = self.load()
        calls = pathlib.Path(self.folder.name) / "calls"
        program = self.write_program("renderer", f'echo "$PWD $*" >>"{calls}"\n'
                                     f'exec "{slicer.modules.fenestracommand.path}" "$@"')
        files = os.path.join(self.folder.name, "temporary files")
        os.mkdir(files)
        self.assertTrue(self.choose("Executable", program).startswith("fenestra "))
        self.assertEqual(self.choose("TemporaryFolder", files), "")
        self.panel.device = "cpu"
        slicer.util.findChild(self.panel, "ThreadsBox").value = 1
        stored = [qt.QSettings().value(f"Fenestra/{key}") for key in ("Executable", "TemporaryFolder", "Device")]
        self.assertEqual(stored, [program, files, "cpu"])
        self.assertEqual(int(qt.QSettings().value("Fenestra/Threads")), 1)
        self.assertIsNotNone(self.logic.Render(settings, True))
        self.assertIsNotNone(self.logic.OpenView(settings, True))
        self.assertIsNotNone(self.logic.ShowPhotorealistic(settings, True))
        check, *rest = calls.read_text().splitlines()
        self.assertTrue(check.endswith(" --version"), check)
        self.assertEqual(len(rest), 3, rest)
        for call in rest:
            self.assertTrue(call.startswith(files + "/fenestra-slicer-"), call)
            self.assertIn(" --threads=1", call)
            self.assertEqual(" --device=cpu" in call, " mesh " not in call)
        slicer.mrmlScene.Clear()

    def test_bad_executables_are_not_used(self):
        endless = self.write_program("endless", "while :; do echo fenestra; sleep 0.01; done")
        other = self.write_program("other", "echo other 1.0")
        failing = self.write_program("failing", "echo fenestra 1.0; exit 1")
        for path in ("/nowhere/fenestra", self.folder.name, "renderer", other, failing, endless):
            start = time.monotonic()
            with Log() as log:
                self.assertTrue(self.choose("Executable", path).startswith("Not used: "), path)
            self.assertLess(time.monotonic() - start, 300.0)
            self.assertEqual(self.panel.executable, "")
            self.assertFalse(qt.QSettings().value("Fenestra/Executable"))
        self.assertIn("endless is not the renderer", "\n".join(log.lines()))
        self.assertTrue(self.choose("TemporaryFolder", "/nowhere").startswith("Not used: "))
        self.assertEqual(self.panel.temporaryFolder, "")

    def test_failures_are_logged(self):
        """Each failure gives no result, soon, and a line in the log."""
        settings = self.load()
        silent = self.write_program("silent", "exit 0")
        opening = "the view is not cut"

        def fail(lines, executable, call):
            self.panel.executable = executable
            with Log() as log:
                self.assertIsNone(call())
            text = "\n".join(log.lines())
            for line in lines:
                self.assertIn(line, text)

        fail(["The renderer is missing"], "/nowhere/fenestra", lambda: self.logic.Render(settings, True))
        fail(["ended without an image"], silent, lambda: self.logic.Render(settings, True))
        fail(["no 3D view shows an image", "no preview: The renderer ended"], silent,
             lambda: self.logic.ShowPhotorealistic(settings, True))
        self.logic.HidePhotorealistic()
        fail(["the sample could not be generated", "was not loaded"], silent, self.logic.LoadSample)
        fail([opening, "could not be started"], "/nowhere/fenestra", lambda: self.logic.OpenView(settings, True))
        settings.SetFlag("clip", "hole")
        fail([opening, "Fenestra: The 3D view is cut only by"], "", lambda: self.logic.OpenView(settings, True))
        settings.SetFlag("clip", "")
        settings.SetFocus(["gone"])
        fail([opening, "gone"], "", lambda: self.logic.OpenView(settings, True))
        self.logic.CloseView()
        fail(["gone"], "", lambda: self.logic.Render(settings, True))
        process_events()
