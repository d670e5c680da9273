"""Runs the tutorial's Python lines."""

import pathlib
import re
import tempfile
import unittest

import slicer


class FenestraScriptTest(unittest.TestCase):
    def test_tutorial(self):
        self.assertEqual(slicer.modules.fenestra.logic().GetClassName(), "vtkSlicerFenestraLogic")
        tutorial = pathlib.Path(__file__).parents[2] / "Tutorial.md"
        lines = re.search(r"```python\n(.*?)```", tutorial.read_text(), re.DOTALL).group(1)
        with tempfile.TemporaryDirectory() as folder:
            command = pathlib.Path(slicer.modules.fenestracommand.path)
            slicer.util.launchConsoleProcess([str(command), "phantom", "knee", "--output", folder]).wait()
            slicer.util.loadScene(f"{folder}/knee.mrml")
            slicer.modules.fenestra.logic().GetSettings().SetFlag("samples", "4")
            names = {"slicer": slicer, "getNode": slicer.util.getNode}
            exec(lines, names)
            self.assertIsNotNone(names["render"].GetNodeReference("picture"))
